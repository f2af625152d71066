// Scatters discs over the unit squares of a mapping, at most one per square.
#pragma once

#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/noise.h"

namespace lull {

template <typename T>
struct Dots {
    Mapping2D mapping;
    TextureHandle<T> inDot, aroundDots;
};

// Returns whether the point lies in a disc of radius 0.35, placed by noise within its square.
inline bool IsInDot(const Vec2f& st) {
    constexpr float kRadius = 0.35f, kMaxShift = 0.5f - kRadius;
    const float s = std::floor(st.x() + 0.5f), t = std::floor(st.y() + 0.5f);
    const auto noise = [](float x, float y) { return Noise(Vec3f(x, y, 0.5f)); };
    if (!(noise(s + 0.5f, t + 0.5f) > 0)) return false;
    const Vec2f center(s + kMaxShift * noise(s + 1.5f, t + 2.8f),
                       t + kMaxShift * noise(s + 4.5f, t + 9.8f));
    return (st - center).squaredNorm() < Sqr(kRadius);
}

template <typename T>
T Evaluate(const Dots<T>& dots, const TextureTable& table, const TextureContext& c) {
    return table.Evaluate(IsInDot(Map(dots.mapping, c)) ? dots.inDot : dots.aroundDots, c);
}

template <typename T>
SurfaceNeeds Needs(const Dots<T>& dots, const TextureTable& table) {
    return Needs(dots.mapping) | table.Needs(dots.inDot) | table.Needs(dots.aroundDots);
}

// pbrt-v3 passes "inside" and "outside" in the wrong order, so that the dots show "outside". Scenes
// made for pbrt-v3 rely on it, so it is kept.
template <typename T>
Made<T, Dots<T>> MakeDots(const TextureInput& input) {
    const TextureHandle<T> inside = GetTexture<T>(input, "inside", 1);
    const TextureHandle<T> outside = GetTexture<T>(input, "outside", 0);
    return Dots<T>{MakeMapping2D(input), outside, inside};
}

}  // namespace lull
