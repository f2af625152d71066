// Finds where light that has gone into a translucent solid comes out again.
#pragma once

#include <optional>

#include "renderer/bsdf/subsurface.h"
#include "renderer/scene/scene.h"

namespace lull {

struct SubsurfaceExit {
    SurfaceInteraction hit;
    int shape;
    Rgb weight;  // of the path from there, scattered by the BSDF of an exit
};

// Chooses a point of the same material near `hit`, whose BSDF `bsdf` has let the path in, as the
// profile spreads light, by probe rays along the three axes of its frame (King, Kulla, Conty,
// Fajardo 2013; pbrt 3rd ed., 15.4.1). Returns nothing where none is found or no light goes.
std::optional<SubsurfaceExit> SampleSubsurface(const Scene& scene, Sampler& sampler,
                                               const SurfaceInteraction& hit, const Bsdf& bsdf,
                                               const SubsurfaceProfile& profile, float time);

// Returns how light leaves at such a point: into the outside by Fresnel's law, as if it came from
// everywhere. Its wo is hit.ns.
Bsdf ExitBsdf(const SubsurfaceExit& exit, float eta);

}  // namespace lull
