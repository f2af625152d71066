#include "renderer/denoise/fireflies.h"

#include <cmath>

namespace lull {

namespace {

constexpr int kScaleRadius = 4;    // pixels, over which differences are measured
constexpr int kSpreadRadius = 20;  // of each of two box filters, one after the other
constexpr int kRounds = 2;         // as fireflies hide each other

// Returns the largest luminance of each pixel and its eight neighbours.
Planes MostAround(const Planes& image) {
    Planes y(image.width, image.height, 1), most = y;
    for (size_t i = 0; i < y.Area(); ++i) y.values[i] = LuminanceOf(image, i);
    for (int row = 0; row < y.height; ++row)
        for (int x = 0; x < y.width; ++x) {
            float value = 0;
            for (int r = std::max(0, row - 1); r < std::min(y.height, row + 2); ++r)
                for (int q = std::max(0, x - 1); q < std::min(y.width, x + 2); ++q)
                    value = std::max(value, y.Row(0, r)[q]);
            most.Row(0, row)[x] = value;
        }
    return most;
}

// Scales pixel i of `half` down to the luminance `limit` if it is brighter.
void Limit(Planes* half, size_t i, float limit) {
    const float y = LuminanceOf(*half, i);
    if (!(y > limit)) return;
    for (int c = 0; c < kColours; ++c) half->Plane(c)[i] *= limit / y;
}

}  // namespace

CalmedHalves TakeFireflies(const Planes& a, const Planes& b, float limit) {
    CalmedHalves result{a, b, Planes(a.width, a.height, kColours)};
    Planes distance(a.width, a.height, 1);
    const Planes counts = BoxSum(Planes(a.width, a.height, 1, 1), kScaleRadius);
    for (int round = 0; round < kRounds; ++round) {
        for (size_t i = 0; i < a.Area(); ++i)
            distance.values[i] = std::abs(LuminanceOf(result.a, i) - LuminanceOf(result.b, i));
        const Planes around = BoxSum(distance, kScaleRadius);
        const Planes mostA = MostAround(result.a), mostB = MostAround(result.b);
        for (size_t i = 0; i < a.Area(); ++i) {
            // The mean of |x| is sqrt(2 / pi) standard deviations; without the pixel itself.
            const float others = std::max(0.f, around.values[i] - distance.values[i]) /
                                 std::max(1.f, counts.values[i] - 1);
            const float reach = limit * 1.2533f * others;
            const float ya = LuminanceOf(result.a, i), yb = LuminanceOf(result.b, i);
            Limit(&result.a, i, std::max(yb + reach, mostB.values[i]));
            Limit(&result.b, i, std::max(ya + reach, mostA.values[i]));
        }
    }
    for (size_t i = 0; i < a.values.size(); ++i)
        result.excess.values[i] =
            (a.values[i] - result.a.values[i] + b.values[i] - result.b.values[i]) / 2;
    return result;
}

void GiveBack(const Planes& excess, Planes* picture) {
    Planes share(excess.width, excess.height, 1);
    for (size_t i = 0; i < share.Area(); ++i)
        share.values[i] = std::clamp(LuminanceOf(*picture, i), 1e-4f, 1.f);
    const auto spread = [](const Planes& image) {
        return BoxSum(BoxSum(image, kSpreadRadius), kSpreadRadius);
    };
    // Each pixel's excess is divided among its neighbours by their share of the brightness around.
    const Planes around = spread(share);
    Planes scaled = excess;
    for (int c = 0; c < kColours; ++c)
        for (size_t i = 0; i < share.Area(); ++i) scaled.Plane(c)[i] /= around.values[i];
    scaled = spread(scaled);
    for (int c = 0; c < kColours; ++c)
        for (size_t i = 0; i < share.Area(); ++i)
            picture->Plane(c)[i] += scaled.Plane(c)[i] * share.values[i];
}

}  // namespace lull
