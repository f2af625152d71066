#include "renderer/scene/lights/studio.h"

#include "renderer/base/math.h"

namespace lull {
namespace {

// A square soft box: where it hangs, in degrees, to the right of the camera and above the horizon,
// half its width, and how bright it is.
struct SoftBox {
    float azimuth, elevation, halfWidth, radiance;
};
constexpr SoftBox kBoxes[] = {
    {-45, 45, 22, 4},    // the key light
    {60, 15, 25, 1.5f},  // fills its shadows
    {160, 55, 15, 3},    // draws the outline from behind
};

float SmoothStep(float x) {
    x = std::clamp(x, 0.f, 1.f);
    return x * x * (3 - 2 * x);
}

Vec3f Direction(float azimuth, float elevation) {
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
}

float RadianceOf(const SoftBox& box, const Vec3f& w) {
    constexpr float kDegree = kPi / 180, kEdge = 0.2f;  // of half the width
    const float a = box.azimuth * kDegree, e = box.elevation * kDegree;
    const Vec3f center = Direction(a, e), right(-std::sin(a), std::cos(a), 0);
    const float ahead = w.dot(center);
    if (ahead <= 0) return 0;
    const float scale = 1 / (ahead * std::tan(box.halfWidth * kDegree));
    const float x = std::abs(w.dot(right)) * scale,
                y = std::abs(w.dot(center.cross(right))) * scale;
    return box.radiance * SmoothStep((1 - std::max(x, y)) / kEdge);
}

}  // namespace

Image MakeStudio() {
    constexpr int kWidth = 256, kHeight = 128;
    std::vector<float> texels;
    texels.reserve(size_t(kWidth) * kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float elevation = (0.5f - (float(y) + 0.5f) / kHeight) * kPi;
            const Vec3f w = Direction(2 * kPi * (float(x) + 0.5f) / kWidth, elevation);
            float radiance = 0.12f + 0.33f * SmoothStep(0.5f + 0.5f * w.z());
            for (const SoftBox& box : kBoxes) radiance += RadianceOf(box, w);
            texels.push_back(radiance);
        }
    return {kWidth, kHeight, 1, std::move(texels)};
}

}  // namespace lull
