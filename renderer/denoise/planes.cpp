#include "renderer/denoise/planes.h"

#include <tbb/task_arena.h>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

template <typename Use>
void ForEachRows(const Planes& image, const Use& use) {
    constexpr int kRows = 32;
    constexpr size_t kLarge = size_t(1) << 17;
    if (image.Area() < kLarge) return use(0, image.height);
    // As in ForEachTile(), a thread that waits here takes up no other task of a render.
    tbb::this_task_arena::isolate([&] {
        ForEachIndex((image.height + kRows - 1) / kRows,
                     [&](int i) { use(i * kRows, std::min(image.height, (i + 1) * kRows)); });
    });
}

int CountAround(int i, int size, int radius) {
    return std::min(size, i + radius + 1) - std::max(0, i - radius);
}

void FilterColumns(int radius, bool asMean, Planes* image) {
    const size_t width = size_t(image->width);
    const int height = image->height;
    std::vector<float> source;
    for (int c = 0; c < image->count; ++c) {
        source.assign(image->Plane(c), image->Plane(c) + image->Area());
        ForEachRows(*image, [&](int y0, int y1) {
            for (int y = y0; y < y1; ++y) {
                float* to = image->Row(c, y);
                const int first = std::max(0, y - radius), count = CountAround(y, height, radius);
                std::fill_n(to, width, 0.f);
                for (int v = first; v < first + count; ++v) {
                    const float* row = &source[size_t(v) * width];
                    for (size_t x = 0; x < width; ++x) to[x] += row[x];
                }
                const float norm = asMean ? 1 / float(count) : 1;
                for (size_t x = 0; x < width; ++x) to[x] *= norm;
            }
        });
    }
}

void FilterRows(int radius, bool asMean, Planes* image) {
    const size_t width = size_t(image->width), reach = size_t(radius);
    std::vector<float> norms(width, 1);
    if (asMean)
        for (int x = 0; x < image->width; ++x)
            norms[size_t(x)] = 1 / float(CountAround(x, image->width, radius));
    ForEachRows(*image, [&](int y0, int y1) {
        std::vector<float> row(width + 2 * reach);
        for (int c = 0; c < image->count; ++c)
            for (int y = y0; y < y1; ++y) {
                float* to = image->Row(c, y);
                std::copy_n(to, width, row.begin() + ptrdiff_t(reach));
                std::fill_n(to, width, 0.f);
                for (size_t k = 0; k <= 2 * reach; ++k)
                    for (size_t x = 0; x < width; ++x) to[x] += row[x + k];
                for (size_t x = 0; x < width; ++x) to[x] *= norms[x];
            }
    });
}

Planes Filter(Planes image, int radius, bool asMean) {
    FilterRows(radius, asMean, &image);
    FilterColumns(radius, asMean, &image);
    return image;
}

}  // namespace

std::vector<float> Interleaved(const Planes& image) {
    std::vector<float> values(image.values.size());
    for (int c = 0; c < image.count; ++c)
        for (size_t i = 0; i < image.Area(); ++i)
            values[i * size_t(image.count) + size_t(c)] = image.Plane(c)[i];
    return values;
}

Planes VarianceOf(const Planes& a, const Planes& b) {
    Planes result = a;
    for (size_t i = 0; i < result.values.size(); ++i) {
        const float difference = a.values[i] - b.values[i];
        result.values[i] = difference * difference / 2;
    }
    return result;
}

Planes BoxMean(Planes image, int radius) { return Filter(std::move(image), radius, true); }
Planes BoxSum(Planes image, int radius) { return Filter(std::move(image), radius, false); }

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
