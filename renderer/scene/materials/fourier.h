// Reads and represents materials that are tabulated in files.
#pragma once

#include <memory>
#include <string>

#include "renderer/bsdf/fourier_lobe.h"
#include "renderer/scene/materials/material_inputs.h"

namespace lull {

// Reads the .bsdf files of layered materials.
//
// Reads version 1 of the format, as layerlab writes it and pbrt-v3 reads it: one basis, without
// textures and extrapolation, one channel or three. Throws Error with the path if it is anything
// else, cut short, or holds impossible numbers.
FourierTable LoadFourierTable(const std::string& path);

// Represents a layered or measured material, tabulated in a file.
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
