// Turns materials at a hit point into Bsdfs. The kinds are in the other files of this folder.
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

}  // namespace lull
