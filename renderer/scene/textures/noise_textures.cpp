#include "renderer/scene/textures/noise_textures.h"

namespace lull {

namespace {

// pbrt-v3's spline has nine control colours and six segments, but only the first five colours
// are ever used (see Evaluate).
constexpr float kColors[5][3] = {
    {0.58f, 0.58f, 0.60f}, {0.58f, 0.58f, 0.60f}, {0.58f, 0.58f, 0.60f},
    {0.50f, 0.50f, 0.50f}, {0.60f, 0.59f, 0.58f},
};
constexpr int kSegments = 6;

}  // namespace

Rgb Evaluate(const Marble& marble, const TextureTable&, const TextureContext& c) {
    const Vec3f p = Map(marble.mapping, c) * marble.scale;
    const float angle =
        p.y() + marble.variation *
                    FractionalBrownianMotion(p, Sqr(marble.scale) * Spacing2(marble.mapping, c),
                                             marble.roughness, marble.octaves);
    float t = (0.5f + 0.5f * std::sin(angle)) * kSegments;
    if (!(t >= 0)) t = 0;  // NaN of an infinite coordinate

    // pbrt-v3 limits the segment to the first two instead of to the last, so that t runs up to 5
    // on the second and the cubic is extrapolated: to 40 and more. Materials made for pbrt-v3
    // show it, so it is kept.
    const int first = std::min(1, int(t));
    t -= float(first);

    // Evaluates the Bezier segment by its Bernstein form.
    const float s = 1 - t;
    const float weights[4] = {s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
    Rgb color = Rgb::Zero();
    for (int i = 0; i < 4; ++i) color += weights[i] * Rgb::Map(kColors[first + i]);
    return 1.5f * color;
}

}  // namespace lull
