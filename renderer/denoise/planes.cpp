#include "renderer/denoise/planes.h"

#include <tbb/task_arena.h>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

// Calls use(y0, y1) for some rows after the other, those of a large image on all threads.
template <typename Use>
void ForEachRows(const Planes& image, const Use& use) {
    constexpr int kRows = 32;
    constexpr size_t kLarge = size_t(1) << 17;
    if (image.Area() < kLarge) return use(0, image.height);
    // As in patch_weights.h, a thread that waits here takes up no other task of a render.
    tbb::this_task_arena::isolate([&] {
        ForEachIndex((image.height + kRows - 1) / kRows,
                     [&](int i) { use(i * kRows, std::min(image.height, (i + 1) * kRows)); });
    });
}

// Returns how many of the places up to `radius` before and after place i there are.
int CountAround(int i, int size, int radius) {
    return std::min(size, i + radius + 1) - std::max(0, i - radius);
}

// Replaces each row by the sum of those up to `radius` above and below, or by their mean.
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

}  // namespace lull
