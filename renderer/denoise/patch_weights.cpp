#include "renderer/denoise/patch_weights.h"

namespace lull {

namespace {

std::vector<PatchWeights::Offset> WindowOffsets(int radius) {
    std::vector<PatchWeights::Offset> offsets;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) offsets.push_back({x, y});
    return offsets;
}

}  // namespace

PatchWeights::PatchWeights(const PatchGuide& guide, const ImageTile& tile, int margin,
                           const PatchOptions& options)
    : offsets(WindowOffsets(options.radius)),
      halfCount(int(offsets.size()) / 2),
      distances(tile.Grown(margin + options.radius), halfCount),
      inside(distances.Area(), 1) {
    const ImageTile& area = inside.Area();
    for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x)
            *inside.At(0, x, y) =
                x >= 0 && x < guide.image.width && y >= 0 && y < guide.image.height ? 1.f : 0.f;

    const ImageTile around = area.Grown(options.radius + options.patchRadius);
    const Cutout image(around, guide.image), variance(around, guide.variance);
    for (int o = 0; o < halfCount; ++o) Measure(image, variance, options.patchRadius, o);
}

void PatchWeights::Measure(const Cutout& guide, const Cutout& variance, int patchRadius, int o) {
    const auto [dx, dy] = offsets[size_t(o)];
    const ImageTile& area = distances.Area();
    const int side = 2 * patchRadius + 1;
    const int length = area.x1 - area.x0 + kLanes;  // of the rows that are wanted
    const int longer = length + 2 * patchRadius;
    const size_t stride = size_t(longer + kLanes);
    const float norm = 1.f / float(side * side * guide.Count());
    // The last rows of differences, and their sum.
    std::vector<float> rows(size_t(side) * stride), sums(stride);
    for (int step = 0; step < area.y1 - area.y0 + 2 * patchRadius; ++step) {
        const int y = area.y0 - patchRadius + step;
        float* row = &rows[size_t(step % side) * stride];
        for (int i = 0; i < longer; i += kLanes) {
            const int x = area.x0 - patchRadius + i;
            Lanes sum = Lanes::Zero();
            for (int c = 0; c < guide.Count(); ++c) {
                const LanesIn u(guide.At(c, x, y)), other(guide.At(c, x + dx, y + dy));
                const LanesIn v(variance.At(c, x, y)), also(variance.At(c, x + dx, y + dy));
                const Lanes both = v + also;
                sum += ((u - other).square() - both) / (both + 1e-10f);
            }
            Store(sum, row + i);
        }
        if (step < 2 * patchRadius) continue;
        for (int i = 0; i < longer; i += kLanes) {
            Lanes sum = Lanes::Zero();
            for (int r = 0; r < side; ++r)
                sum += LanesIn(rows.data() + size_t(r) * stride + size_t(i));
            Store(sum, sums.data() + i);
        }
        for (int i = 0; i < length; i += kLanes) {
            Lanes sum = Lanes::Zero();
            for (int r = 0; r < side; ++r) sum += LanesIn(sums.data() + i + r);
            Store((sum * norm).max(0.f), distances.At(o, area.x0 + i, y - patchRadius));
        }
    }
}

}  // namespace lull
