// Generates camera rays: pbrt-v3's perspective and orthographic cameras, with pinhole or thin lens,
// its environment camera, pbrt-v4's of equal areas, and its realistic one, with real lens systems.
#pragma once

#include "renderer/base/variant.h"
#include "renderer/input/description.h"
#include "renderer/scene/cameras/film_settings.h"
#include "renderer/scene/cameras/lens_system.h"
#include "renderer/scene/geometry/animated_transform.h"
#include "renderer/scene/interaction.h"

namespace lull {

// Where and when a path starts.
struct CameraSample {
    Vec2f film;                      // pixels
    Vec2f lens = Vec2f(0.5f, 0.5f);  // in [0, 1)^2, chooses the point on the lens
    float time = 0;                  // from 0, where the shutter opens, to 1
    bool isRight = false;            // of the right eye of a pair
};

enum class Projection { Perspective, Orthographic, Environment, EqualArea, Realistic };

struct Camera {
    Projection projection = Projection::Perspective;
    Mat4d worldFromCamera = Mat4d::Identity();
    // Maps the image [0, width] x [0, height] in pixels to the plane z = 1 of camera space
    // (perspective), z = 0 (orthographic), to the angles phi and theta (environment), or to the
    // unit square (equal area).
    Vec2f planeOrigin = Vec2f::Zero(), planePerPixel = Vec2f::Zero();
    float lensRadius = 0, focalDistance = 1e6f;
    // Nothing is seen nearer or farther along the axis (of perspective and orthographic cameras).
    float clipStart = 0, clipEnd = kInfinity;

    // The rotation and position of worldFromCamera in float, for the ray loop.
    Mat3f rotation = Mat3f::Identity();
    Vec3f position = Vec3f::Zero();

    // The distance between samples, in pixels, for texture filtering: 1 / sqrt(samples per pixel)
    // as the scene asks for them, as in pbrt-v3, even if the stopping rule takes more or fewer.
    float sampleSpacing = 1;

    // Of a moving camera; rotation and position are then the identity's, and worldFromCamera is the
    // transform at the opening of the shutter.
    std::optional<AnimatedTransform> motion;

    std::optional<LensSystem> lenses;  // of realistic cameras
    Vec2f perPixel = Vec2f::Zero();    // theirs: the share of the film

    bool HasLens() const { return lensRadius > 0 || lenses; }
    bool Clips() const { return clipStart > 0 || clipEnd < kInfinity; }

    // Returns the ray of a sample; direction unit. The radiance that it finds counts *weight times,
    // which is 1 but for realistic cameras, and 0 where nothing passes their lenses.
    Ray GenerateRay(const CameraSample& sample, float* weight) const {
        *weight = 1;
        if (projection == Projection::Perspective && !motion) [[likely]]
            return GeneratePerspectiveRay(sample.film, sample.lens);
        return GenerateRareRay(sample, weight);
    }
    Ray GenerateRay(const CameraSample& sample) const {
        float weight;
        return GenerateRay(sample, &weight);
    }

    // Returns the ray of the sample, offset by one pixel along an axis (0 or 1); `ray` is its own
    // ray. For realistic cameras it is extrapolated from a 20th of a pixel, as pbrt-v3 does it;
    // nothing where no light passes there.
    std::optional<Ray> NextRay(const Ray& ray, CameraSample, int axis) const;

  private:
    Ray GeneratePerspectiveRay(const Vec2f& film, const Vec2f& lens) const;
    Ray GenerateOtherRay(const Vec2f& film, const Vec2f& lens) const;
    // Returns a ray of camera space in the world, from where it begins to where it ends to see.
    Ray Clip(const Vec3f& origin, const Vec3f& direction) const;
    // Of all but perspective cameras at rest: apart, so that these do not pay for it.
    Ray GenerateRareRay(const CameraSample&, float* weight) const;
};

// Pairs of pictures for two eyes, apart along the camera's x.

enum class Eye { Middle, Left, Right };
template <>
struct EnumNames<Eye> {
    static constexpr std::pair<Eye, const char*> all[] = {
        {Eye::Middle, "middle"}, {Eye::Left, "left"}, {Eye::Right, "right"}};
};

// lull's own parameters of cameras.
struct Stereo {
    float distance = 0;     // of the eyes, in the camera's units; 0: there is one eye
    float convergence = 0;  // distance where both see the same; 0: nowhere, their axes are parallel
    Eye alone = Eye::Middle;  // the only eye that is rendered; Middle: both are

    bool IsPair() const { return distance > 0 && alone == Eye::Middle; }
};

// Reads "eyedistance", "convergence" and "eye". Throws Error for values below 0, and for cameras
// that are neither perspective nor in the middle of a window.
Stereo ReadStereo(const Entity& camera);

// Returns the camera of an eye: its position moved along x, and the window it is seen through moved
// back, so that both windows are the same at the distance of convergence (off-axis).
Camera CameraOfEye(const Camera&, const Stereo&, Eye);

// Reads Camera "perspective", "orthographic", "environment", "equalarea" or "realistic", whose exit
// pupils are
// found with `threads` threads (0: all). Throws Error for other cameras, a field of view outside
// (0, 180), a transform that cannot be inverted, or lenses as LoadLens and LensSystem say.
Camera MakeCamera(const Description&, const FilmSettings&, Warnings&, int threads = 0);

// Bounds how far from the world's origin rays begin or are aimed at; may be infinite.
double Farthest(const Camera&, const FilmSettings&);

// Returns the transforms that EXR headers carry: worldToCamera and worldToNDC (pbrt's). The latter
// is nothing if no matrix projects as the camera does.
Mat4d WorldToCamera(const Camera&);
std::optional<Mat4d> WorldToNdc(const Camera&, const FilmSettings&);

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

// Returns how such a camera sees p, `lens` and `time` as in CameraSample; nothing if it is behind.
std::optional<CameraView> ViewOf(const Camera&, const Vec3f& p, const Vec2f& lens, float time);

// Returns the pixels per sr about the direction d of a ray of such a camera.
float PixelsPerSolidAngle(const Camera&, const Vec3f& d, float time);

// Fills in dpdx, dpdy, duvdx and duvdy of a hit of the sample's camera ray, from where the rays one
// pixel to the right and below meet the tangent plane (Igehy 1999; pbrt 3rd ed., 10.1). Samples lie
// Camera::sampleSpacing apart.
void ComputeFootprint(const Camera&, const CameraSample&, SurfaceInteraction* hit);

}  // namespace lull
