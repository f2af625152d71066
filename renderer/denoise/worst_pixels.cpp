#include "renderer/denoise/worst_pixels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lull {

namespace {

constexpr size_t kPixelsPerWorst = 5000;

}  // namespace

std::vector<size_t> WorstPixels(const VisibleDifference& difference,
                                std::span<const float> lightness) {
    std::vector<float> seen = VisibleMap(difference);
    for (size_t i = 0; i < seen.size(); ++i) seen[i] *= std::abs(lightness[i]);
    std::vector<size_t> pixels(seen.size());
    std::iota(pixels.begin(), pixels.end(), size_t(0));
    const auto end = pixels.begin() + std::ptrdiff_t(seen.size() / kPixelsPerWorst);
    std::ranges::partial_sort(pixels, end, [&](size_t i, size_t j) {
        return seen[i] > seen[j] || (seen[i] == seen[j] && i < j);
    });
    pixels.erase(end, pixels.end());
    return pixels;
}

}  // namespace lull
