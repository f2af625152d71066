#include "renderer/denoise/sample_range.h"

namespace lull {

namespace {

constexpr int kReachOfLeast = 2, kReachOfMost = 7;  // pixels

// Returns the extremes, by `pick`, of the pixels of a tile and those up to `reach` beside, above
// and below them. Beyond the border there is nothing.
template <typename Pick>
Planes Extremes(const Planes& image, const ImageTile& tile, int reach, const Pick& pick) {
    const int width = tile.x1 - tile.x0, height = tile.y1 - tile.y0;
    const int above = std::max(0, tile.y0 - reach), below = std::min(image.height, tile.y1 + reach);
    Planes rows(width, below - above, image.count), result(width, height, image.count);
    for (int c = 0; c < image.count; ++c) {
        for (int y = 0; y < rows.height; ++y) {
            const float* from = image.Row(c, above + y);
            float* to = rows.Row(c, y);
            std::copy_n(from + tile.x0, width, to);
            for (int d = -reach; d <= reach; ++d) {
                const int first = std::max(0, -tile.x0 - d);
                const int end = std::min(width, image.width - tile.x0 - d);
                for (int x = first; x < end; ++x) to[x] = pick(to[x], from[tile.x0 + x + d]);
            }
        }
        for (int y = 0; y < height; ++y) {
            float* to = result.Row(c, y);
            std::copy_n(rows.Row(c, tile.y0 + y - above), width, to);
            const int end = std::min(below, tile.y0 + y + reach + 1) - above;
            for (int v = std::max(above, tile.y0 + y - reach) - above; v < end; ++v)
                for (int x = 0; x < width; ++x) to[x] = pick(to[x], rows.Row(c, v)[x]);
        }
    }
    return result;
}

}  // namespace

void SampleRange::Clamp(Planes* picture) const {
    for (size_t i = 0; i < picture->values.size(); ++i)
        picture->values[i] =
            std::min(std::max(picture->values[i], least.values[i]), most.values[i]);
}

SampleRange RangeOfSamples(const Planes& noisy, const ImageTile& tile) {
    return {Extremes(noisy, tile, kReachOfLeast, [](float a, float b) { return std::min(a, b); }),
            Extremes(noisy, tile, kReachOfMost, [](float a, float b) { return std::max(a, b); })};
}

void ClampToSamples(const Planes& noisy, Planes* picture) {
    ForEachTile(noisy.width, noisy.height, [&](const ImageTile& tile) {
        Planes part = Crop(*picture, tile);
        RangeOfSamples(noisy, tile).Clamp(&part);
        Paste(part, {0, 0, part.width, part.height}, tile.x0, tile.y0, picture);
    });
}

}  // namespace lull
