#include "renderer/denoise/fireflies.h"

#include <cmath>

namespace lull {

namespace {

constexpr int kScaleRadius = 4;        // pixels, over which differences are measured
constexpr int kSpreadRadius = 20;      // of each of two box filters, one after the other
constexpr int kRounds = 2;             // as fireflies hide each other
constexpr float kMostReturned = 0.5f;  // of a pixel's brightness, by one firefly

// The extremes of the luminance of a pixel and its eight neighbours.
struct Around {
    Planes least, most;
};

Around LuminancesAround(const Planes& image) {
    Planes y(image.width, image.height, 1);
    for (size_t i = 0; i < y.Area(); ++i) y.values[i] = LuminanceOf(image, i);
    Around around{y, y};
    for (int row = 0; row < y.height; ++row)
        for (int x = 0; x < y.width; ++x)
            for (int r = std::max(0, row - 1); r < std::min(y.height, row + 2); ++r)
                for (int q = std::max(0, x - 1); q < std::min(y.width, x + 2); ++q) {
                    const float value = y.Row(0, r)[q];
                    float &least = around.least.Row(0, row)[x], &most = around.most.Row(0, row)[x];
                    least = std::min(least, value);
                    most = std::max(most, value);
                }
    return around;
}

// Scales pixel i of `half` down to the luminance `limit` if it is brighter.
void Limit(size_t i, float limit, Planes* half, std::vector<Firefly>* taken) {
    const float y = LuminanceOf(*half, i);
    if (!(y > limit)) return;
    Firefly firefly{i, {}};
    for (int c = 0; c < kColours; ++c) {
        float& value = half->Plane(c)[i];
        const float less = value * (limit / y);
        firefly.excess[c] = (value - less) / 2;  // of the mean of two
        value = less;
    }
    taken->push_back(firefly);
}

}  // namespace

std::vector<Firefly> TakeFireflies(float limit, Halves* halves) {
    Planes &a = halves->a, &b = halves->b;
    std::vector<Firefly> taken;
    Planes distance(a.width, a.height, 1);
    const Planes counts = BoxSum(Planes(a.width, a.height, 1, 1), kScaleRadius);
    for (int round = 0; round < kRounds; ++round) {
        for (size_t i = 0; i < a.Area(); ++i)
            distance.values[i] = std::abs(LuminanceOf(a, i) - LuminanceOf(b, i));
        const Planes around = BoxSum(distance, kScaleRadius);
        const Around ofA = LuminancesAround(a), ofB = LuminancesAround(b);
        for (size_t i = 0; i < a.Area(); ++i) {
            // The mean of |x| is sqrt(2 / pi) standard deviations; without the pixel itself.
            const float others = std::max(0.f, around.values[i] - distance.values[i]) /
                                 std::max(1.f, counts.values[i] - 1);
            const float reach = limit * 1.2533f * others;
            const float ya = LuminanceOf(a, i), yb = LuminanceOf(b, i);
            // A lamp or glint of a pixel is bright in both halves, and may differ by as much.
            const float agreed = std::max(
                0.f, std::min(ya, yb) - std::min(ofA.least.values[i], ofB.least.values[i]));
            Limit(i, std::max(yb + reach + agreed, ofB.most.values[i]), &a, &taken);
            Limit(i, std::max(ya + reach + agreed, ofA.most.values[i]), &b, &taken);
        }
    }
    return taken;
}

Planes GiveBack(const std::vector<Firefly>& fireflies, Planes* picture) {
    Planes deviation(picture->width, picture->height, 1);
    if (fireflies.empty()) return deviation;
    Planes share(picture->width, picture->height, 1);
    for (size_t i = 0; i < share.Area(); ++i)
        share.values[i] = std::clamp(LuminanceOf(*picture, i), 1e-4f, 1.f);
    const auto spread = [](Planes image) {
        return BoxSum(BoxSum(std::move(image), kSpreadRadius), kSpreadRadius);
    };
    // The energy of a pixel is divided among its neighbours in proportion to brightness. The
    // squares of its parts are at most these times the largest weight of the spread.
    constexpr float kLargestWeight = Sqr(2 * kSpreadRadius + 1.f);
    const Planes around = spread(share);
    Planes given(share.width, share.height, kColours), squares(share.width, share.height, 1);
    for (const Firefly& f : fireflies) {
        // More of one would not be given anyway, and its square would be beyond floats.
        constexpr float kMost = 1e9f;
        const Rgb whole = f.excess / around.values[f.pixel];
        const Rgb part = whole * std::min(1.f, kMost / std::max(Luminance(whole), 1.f));
        for (int c = 0; c < kColours; ++c) given.Plane(c)[f.pixel] += part[c];
        squares.values[f.pixel] += Sqr(Luminance(part));
    }
    given = spread(std::move(given));
    squares = spread(std::move(squares));
    for (size_t i = 0; i < share.Area(); ++i) {
        const float y = LuminanceOf(given, i), variance = kLargestWeight * squares.values[i];
        if (!(y > 0) || !(variance > 0)) continue;
        const float count = Sqr(y) / variance;  // of fireflies, of equal size
        const float kept = std::min(1.f, kMostReturned * count / y) * share.values[i];
        for (int c = 0; c < kColours; ++c) picture->Plane(c)[i] += given.Plane(c)[i] * kept;
        deviation.values[i] =
            std::min(std::sqrt(variance) * share.values[i], LuminanceOf(*picture, i));
    }
    return deviation;
}

}  // namespace lull
