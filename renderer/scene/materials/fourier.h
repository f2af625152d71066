// Represents a layered or measured material, tabulated in a file.
#pragma once

#include <memory>

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Fourier {
    std::shared_ptr<const FourierTable> table;
    std::string problem;  // why there is no table

    explicit Fourier(const MaterialReader& in);

    // Returns why the file could not be read, "" if it was.
    std::string Problem(const MaterialReader&) const { return problem; }
    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
