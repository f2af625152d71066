#include "stopping/signals/noise_character.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stopping/signals/entropy_drop.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

struct Chroma {
    float a, b;
};

// Returns a* and b* of displayed linear R, G and B (Rec. 709 primaries, white D65).
Chroma ChromaOf(float r, float g, float b) {
    const auto f = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16 / 116.f; };
    const float x = f((0.412453f * r + 0.357580f * g + 0.180423f * b) / 0.950456f);
    const float y = f(0.212671f * r + 0.715160f * g + 0.072169f * b);
    const float z = f((0.019334f * r + 0.119193f * g + 0.950227f * b) / 1.088754f);
    return {500 * (x - y), 200 * (y - z)};
}

// Collects sums over the pixels of a sub-block.
struct CharacterSums {
    int count = 0, saturated = 0;
    double squaredChroma = 0;
    double product = 0, squares = 0;  // of neighbours' noise: x y, and (x^2 + y^2) / 2

    void AddPixel(const BlockView& view, size_t i) {
        float a[3], b[3];  // displayed, of the halves
        bool white = true;
        for (size_t c = 0; c < 3; ++c) {
            const float all = view.mean[3 * i + c], half = view.halfMean[3 * i + c];
            a[c] = Displayed(half);
            b[c] = Displayed(2 * all - half);
            white = white && all >= 1;
        }
        const Chroma of = ChromaOf(a[0], a[1], a[2]), other = ChromaOf(b[0], b[1], b[2]);
        const double da = (of.a - other.a) / 2, db = (of.b - other.b) / 2;
        ++count;
        saturated += white;
        squaredChroma += da * da + db * db;
    }

    void AddNeighbours(double x, double y) {
        product += x * y;
        squares += (x * x + y * y) / 2;
    }
};

std::array<float, kNoiseQuantiles.size()> VisibleQuantiles(const LightnessNoise& noise,
                                                           double flare) {
    std::vector<float> visible(noise.noise.size());
    for (size_t i = 0; i < visible.size(); ++i)
        visible[i] = std::abs(MaskedNoise(noise.noise[i], noise.texture[i])) *
                     float(FlareFactor(noise.lightness[i], flare));
    std::array<float, kNoiseQuantiles.size()> quantiles;
    for (size_t q = 0; q < quantiles.size(); ++q) {
        const auto at =
            visible.begin() + ptrdiff_t(kNoiseQuantiles[q] * double(visible.size() - 1));
        std::nth_element(visible.begin(), at, visible.end());
        quantiles[q] = *at;
    }
    return quantiles;
}

}  // namespace

NoiseCharacter DescribeNoise(const BlockView& view, const LightnessNoise& noise, int subBlocks,
                             double flare) {
    CheckView(view, ViewNeed::MeanAndHalf);
    const int side = int(std::lround(std::sqrt(std::max(0, subBlocks))));
    if (side < 1 || side * side != subBlocks || view.width < side || view.height < side)
        throw std::invalid_argument("a block cannot be cut into that many sub-blocks");
    NoiseCharacter result;
    const std::vector<int> xs = SplitEvenly(view.width, side), ys = SplitEvenly(view.height, side);
    for (size_t v = 0; v + 1 < ys.size(); ++v)
        for (size_t u = 0; u + 1 < xs.size(); ++u) {
            CharacterSums sums;
            for (int y = ys[v]; y < ys[v + 1]; ++y)
                for (int x = xs[u]; x < xs[u + 1]; ++x) {
                    const size_t i = size_t(y) * size_t(view.width) + size_t(x);
                    sums.AddPixel(view, i);
                    if (x + 1 < xs[u + 1]) sums.AddNeighbours(noise.noise[i], noise.noise[i + 1]);
                    if (y + 1 < ys[v + 1])
                        sums.AddNeighbours(noise.noise[i], noise.noise[i + size_t(view.width)]);
                }
            result.saturated.push_back(float(sums.saturated) / float(sums.count));
            result.chromaNoise.push_back(float(std::sqrt(sums.squaredChroma / sums.count)));
            result.correlation.push_back(
                sums.squares > 0 ? float(std::clamp(sums.product / sums.squares, -1.0, 1.0)) : 0);
        }
    result.quantiles = VisibleQuantiles(noise, flare);
    return result;
}

}  // namespace lull
