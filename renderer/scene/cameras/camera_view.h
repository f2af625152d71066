// Finds where a camera sees a point: the counterpart of Camera::GenerateRay() for paths that come
// from lights.
#pragma once

#include "renderer/scene/cameras/camera.h"
#include "renderer/scene/interaction.h"

namespace lull {

// How a point is seen.
struct CameraView {
    Vec2f film;           // pixels, of the whole image and beyond
    Vec3f lens;           // the point on the lens
    float perSolidAngle;  // pixels per sr about the direction to the point, as seen from there
};

// Returns whether a camera's view of points can be computed: perspective cameras, with thin lenses
// or none, that move or not, and see what is near and far.
inline bool SeesPoints(const Camera& camera) {
    return camera.projection == Projection::Perspective && !camera.Clips();
}

// Returns how such a camera sees the point p, `lens` and `time` as in CameraSample; nothing if it
// is behind.
std::optional<CameraView> ViewOf(const Camera&, const Vec3f& p, const Vec2f& lens, float time);

// Returns the pixels per sr about the direction d of a ray of such a camera.
float PixelsPerSolidAngle(const Camera&, const Vec3f& d, float time);

// Computes how far apart the samples of neighbouring pixels lie on a surface.

// Fills in dpdx, dpdy, duvdx and duvdy of a hit of the sample's camera ray, from where the rays one
// pixel to the right and below meet the tangent plane (Igehy 1999; pbrt 3rd ed., 10.1). Samples lie
// Camera::sampleSpacing apart.
void ComputeFootprint(const Camera&, const CameraSample&, SurfaceInteraction* hit);

}  // namespace lull
