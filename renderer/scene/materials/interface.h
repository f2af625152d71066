// Represents no surface, only the boundary of two media: "none". Paths go straight through.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Interface {
    static constexpr const char* kName = "none";

    explicit Interface(const MaterialReader&) {}

    void AddLobes(const MaterialInputs&, Bsdf*) const {}

    template <typename F>
    void VisitTextures(F&&) const {}
    int MaxLobes() const { return 0; }
};

}  // namespace lull
