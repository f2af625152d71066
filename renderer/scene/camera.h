// Generates camera rays: pbrt-v3's perspective camera, with pinhole or thin lens.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/film_settings.h"

namespace lull {

struct Camera {
    Mat4d worldFromCamera = Mat4d::Identity();
    // Maps the image [0, width] x [0, height] in pixels to the plane z = 1 of camera space.
    Vec2f planeOrigin = Vec2f::Zero(), planePerPixel = Vec2f::Zero();
    float lensRadius = 0, focalDistance = 1e6f;

    // The rotation and position of worldFromCamera in float, for the ray loop.
    Mat3f rotation = Mat3f::Identity();
    Vec3f position = Vec3f::Zero();

    // How far samples lie apart, in pixels, for texture filtering: 1 / sqrt(samples per pixel) that
    // the scene asks for, as in pbrt-v3, even if the stopping rule takes more or fewer.
    float sampleSpacing = 1;

    // Returns the ray through `film` (pixels) and the lens point that u chooses; direction unit.
    Ray GenerateRay(const Vec2f& film, const Vec2f& lens) const;
};

// Reads Camera "perspective". Throws Error for other cameras, a field of view outside (0, 180) or
// a transform that cannot be inverted.
Camera MakeCamera(const Description&, const FilmSettings&, Warnings&);

// Returns the transforms that EXR headers carry: worldToCamera and worldToNDC (pbrt's).
Mat4d WorldToCamera(const Camera&);
Mat4d WorldToNdc(const Camera&, const FilmSettings&);

}  // namespace lull
