// Panes: smooth thin sheets (glTF's transmission without a volume), which light goes straight
// through. To a path, being let through is no vertex: shadow rays pass panes with the same share,
// so that light behind them is weighted by the last vertex before, and no bounce is counted.
#pragma once

#include "renderer/transport/path_vertex.h"

namespace lull {

// Returns the share of light that gets straight through the surface where `ray` has found it, to
// where the ray comes from; black where it is no pane. `hit` receives the point.
Rgb ShareThrough(const Scene&, const Ray& ray, const Hit& found, float time,
                 SurfaceInteraction* hit);

// Does what ShareAlong() does in a scene that has panes.
Rgb ShareThroughPanes(const Scene&, const Ray& ray, float time);

// Returns the share of light that gets along the ray, from its end to its origin.
inline Rgb ShareAlong(const Scene& scene, const Ray& ray, float time) {
    if (scene.hasPanes) [[unlikely]]
        return ShareThroughPanes(scene, ray, time);
    return scene.accelerator.Occluded(ray, time) ? Rgb(Rgb::Zero()) : Rgb(Rgb::Ones());
}

// Decides at random whether a path that comes to a surface with kLetsThrough goes straight on, for
// sure where nothing else may happen (`mustGo`) and it can. Updates the throughput; where the path
// stays, the BSDF lets no light straight through any more.
bool GoesThroughPane(const Vec3f& wo, bool mustGo, Sampler&, Bsdf*, Rgb* beta);

}  // namespace lull
