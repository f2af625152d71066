#include "renderer/denoise/patch_weights.h"

namespace lull {

namespace {

// The variance of a difference is limited to so many times the smaller of both, plus that of noise
// of this share of the darker value. Without a limit, the large variance of a lamp of a pixel would
// make it similar to all of its neighbours.
constexpr float kMostNoise = 30, kLeastNoise = 0.1f;

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
      radius(options.radius),
      patchRadius(options.patchRadius),
      imageHeight(guide.image.height),
      // Row y is compared with those below it; rows above have been compared with it already.
      area{tile.x0 - margin - radius, tile.y0 - margin, tile.x1 + margin + radius,
           tile.y1 + margin + radius},
      image(area.Grown(radius + patchRadius), guide.image),
      variance(area.Grown(radius + patchRadius), guide.variance),
      stride(size_t(area.x1 - area.x0 + 2 * kLanes)),
      beyond(stride, kBeyond),
      distanceRows(radius + 1),
      sumRows(2 * patchRadius + 1),
      distances(size_t(halfCount * distanceRows) * stride),
      sums(size_t(halfCount * sumRows) * stride),
      differences(stride + size_t(2 * patchRadius + kLanes)),
      nextSums(area.y0 - patchRadius),
      nextDistances(area.y0) {
    const int first = std::max(area.x0, 0), end = std::min(area.x1, guide.image.width);
    std::fill(beyond.begin() + (first - area.x0), beyond.begin() + (end - area.x0), 0.f);
}

void PatchWeights::MoveTo(int y) {
    row = y;
    nextDistances = std::max(nextDistances, y);
    nextSums = std::max(nextSums, nextDistances - patchRadius);
    for (; nextDistances <= y + radius; ++nextDistances) {
        for (; nextSums <= nextDistances + patchRadius; ++nextSums) AddRow(nextSums);
        MeasureRow(nextDistances);
    }
}

// Adds up the differences of row y along the rows of patches.
void PatchWeights::AddRow(int y) {
    const int length = area.x1 - area.x0 + kLanes;
    for (int o = 0; o < halfCount; ++o) {
        const auto [dx, dy] = offsets[size_t(o)];
        for (int i = 0; i < length + 2 * patchRadius; i += kLanes) {
            const int x = area.x0 - patchRadius + i;
            Lanes sum = Lanes::Zero();
            for (int c = 0; c < image.Count(); ++c) {
                const LanesIn u(image.At(c, x, y)), other(image.At(c, x + dx, y + dy));
                const LanesIn v(variance.At(c, x, y)), also(variance.At(c, x + dx, y + dy));
                const Lanes least = v.min(also) + (kLeastNoise * u.min(other)).square();
                const Lanes both = (v + also).min(kMostNoise * least);
                sum += ((u - other).square() - both) / (both + 1e-10f);
            }
            Store(sum, &differences[size_t(i)]);
        }
        float* to = &sums[RingRow(o, y + patchRadius, sumRows)];
        for (int i = 0; i < length; i += kLanes) {
            Lanes sum = Lanes::Zero();
            for (int k = 0; k < sumRows; ++k) sum += LanesIn(&differences[size_t(i + k)]);
            Store(sum, to + i);
        }
    }
}

// Makes the distances of row y from the sums of AddRow() over the rows of its patches.
void PatchWeights::MeasureRow(int y) {
    const int length = area.x1 - area.x0 + kLanes;
    const float norm = 1.f / float(sumRows * sumRows * image.Count());
    for (int o = 0; o < halfCount; ++o) {
        const float* from = &sums[size_t(o * sumRows) * stride];
        float* to = &distances[RingRow(o, y, distanceRows)];
        for (int i = 0; i < length; i += kLanes) {
            Lanes sum = Lanes::Zero();
            for (int k = 0; k < sumRows; ++k) sum += LanesIn(from + size_t(k) * stride + size_t(i));
            Store((sum * norm).max(0.f), to + i);
        }
    }
}

}  // namespace lull
