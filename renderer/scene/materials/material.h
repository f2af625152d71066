// Turns materials at a hit point into Bsdfs. Each kind has a file in materials/.
#pragma once

#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "renderer/scene/interaction.h"
#include "renderer/scene/materials/material_inputs.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

struct Material;  // variant of all kinds, in material.cpp
class SubsurfaceProfile;

// Owns the materials of a scene, one for each of Description::materials. Immutable once made.
class MaterialTable {
  public:
    // pbrt-v3's default matte replaces unsupported materials. Errors are kept in the warnings.
    // `textures` must outlive the table.
    MaterialTable(const Description&, const TextureTable& textures, Warnings&);
    MaterialTable();
    ~MaterialTable();
    MaterialTable(MaterialTable&&) noexcept;
    MaterialTable& operator=(MaterialTable&&) noexcept;

    SurfaceNeeds Needs(int material) const;

    // Evaluates textures and bump map and makes the lobes. Bump mapping turns hit.ns, which stays
    // on the side of hit.n, as pbrt-v3's Material::Bump does.
    Bsdf MakeBsdf(const TextureTable& textures, SurfaceInteraction* hit) const;

    // Evaluates how transmitted light spreads below the surface of a material that has
    // kScattersBelow. Returns nothing if it continues unscattered.
    std::optional<SubsurfaceProfile> Profile(const TextureTable& textures,
                                             const SurfaceInteraction& hit) const;

  private:
    std::vector<Material> materials;
};

// Represents a weighted sum of two other materials.

struct Mix {
    SpectrumTexture amount;             // of the first; the second gets 1 - amount
    std::optional<FloatTexture> share;  // the amount where it is a number, as in pbrt-v4
    std::array<int, 2> operands;        // into the table, before this one

    explicit Mix(const MaterialReader& in);

    // A material can only be named after it was made, so there are no cycles.
    std::string Problem(const MaterialReader& in) const;

    MaterialTraits Traits(const MaterialReader& in) const;
    // pbrt-v3 shades a mix in the frame of the first material, so its tilt counts.
    SurfaceTilt Tilt(const MaterialReader& in) const { return TiltOfOperand(operands[0], in.made); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
