// Generates camera rays: pbrt-v3's perspective and orthographic cameras, with pinhole or thin lens,
// and its environment camera.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/animated_transform.h"
#include "renderer/scene/film_settings.h"

namespace lull {

enum class Projection { Perspective, Orthographic, Environment };

struct Camera {
    Projection projection = Projection::Perspective;
    Mat4d worldFromCamera = Mat4d::Identity();
    // Maps the image [0, width] x [0, height] in pixels to the plane z = 1 of camera space
    // (perspective), z = 0 (orthographic), or to the angles phi and theta (environment).
    Vec2f planeOrigin = Vec2f::Zero(), planePerPixel = Vec2f::Zero();
    float lensRadius = 0, focalDistance = 1e6f;

    // The rotation and position of worldFromCamera in float, for the ray loop.
    Mat3f rotation = Mat3f::Identity();
    Vec3f position = Vec3f::Zero();

    // How far samples lie apart, in pixels, for texture filtering: 1 / sqrt(samples per pixel) that
    // the scene asks for, as in pbrt-v3, even if the stopping rule takes more or fewer.
    float sampleSpacing = 1;

    // Of a camera that moves; rotation and position are then those of no transform at all, and
    // worldFromCamera that of the time when the shutter opens.
    std::optional<AnimatedTransform> motion;

    // Returns the ray through `film` (pixels) and the lens point that u chooses, at `time` from 0
    // where the shutter opens to 1; direction unit.
    Ray GenerateRay(const Vec2f& film, const Vec2f& lens, float time = 0) const {
        const Ray ray = projection == Projection::Perspective ? GeneratePerspectiveRay(film, lens)
                                                              : GenerateOtherRay(film, lens);
        return motion ? Move(ray, time) : ray;
    }

  private:
    Ray GeneratePerspectiveRay(const Vec2f& film, const Vec2f& lens) const;
    Ray GenerateOtherRay(const Vec2f& film, const Vec2f& lens) const;
    Ray Move(const Ray& ray, float time) const;
};

// Reads Camera "perspective", "orthographic" or "environment". Throws Error for other cameras, a
// field of view outside (0, 180) or a transform that cannot be inverted.
Camera MakeCamera(const Description&, const FilmSettings&, Warnings&);

// Returns the transforms that EXR headers carry: worldToCamera and worldToNDC (pbrt's). The latter
// is nothing where no matrix projects as the camera does.
Mat4d WorldToCamera(const Camera&);
std::optional<Mat4d> WorldToNdc(const Camera&, const FilmSettings&);

}  // namespace lull
