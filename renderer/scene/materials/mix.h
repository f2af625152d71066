// Represents a weighted sum of two other materials.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Mix {
    static constexpr const char* kName = "mix";

    SpectrumTexture amount;       // of the first; the second gets 1 - amount
    std::array<int, 2> operands;  // into the table, before this one

    explicit Mix(const MaterialReader& in);

    // Returns what is wrong with the operands, "" if both exist. A material can only be named after
    // it was made, so there are no cycles.
    std::string Problem(const MaterialReader& in) const;

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(amount);
    }
};

}  // namespace lull
