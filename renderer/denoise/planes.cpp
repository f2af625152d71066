#include "renderer/denoise/planes.h"

namespace lull {

namespace {

// Replaces each row by the sum of those up to `radius` above and below, or by their mean. Sums are
// double, so that what a bright value adds goes again without a trace.
void FilterColumns(int radius, bool asMean, Planes* image) {
    const size_t width = size_t(image->width);
    const int height = image->height;
    std::vector<double> sums(width);
    std::vector<float> source;
    for (int c = 0; c < image->count; ++c) {
        source.assign(image->Plane(c), image->Plane(c) + image->Area());
        std::fill(sums.begin(), sums.end(), 0.0);
        const auto add = [&](int y, double sign) {
            const float* row = &source[size_t(y) * width];
            for (size_t x = 0; x < width; ++x) sums[x] += sign * double(row[x]);
        };
        int first = 0, end = 0;
        for (int y = 0; y < height; ++y) {
            for (; end < std::min(height, y + radius + 1); ++end) add(end, 1);
            for (; first < y - radius; ++first) add(first, -1);
            const double norm = asMean ? 1.0 / (end - first) : 1.0;
            float* to = image->Row(c, y);
            for (size_t x = 0; x < width; ++x) to[x] = float(sums[x] * norm);
        }
    }
}

void FilterRows(int radius, bool asMean, Planes* image) {
    const int width = image->width;
    std::vector<float> row;
    for (int c = 0; c < image->count; ++c)
        for (int y = 0; y < image->height; ++y) {
            float* to = image->Row(c, y);
            row.assign(to, to + width);
            double sum = 0;
            int first = 0, end = 0;
            for (int x = 0; x < width; ++x) {
                for (; end < std::min(width, x + radius + 1); ++end)
                    sum += double(row[size_t(end)]);
                for (; first < x - radius; ++first) sum -= double(row[size_t(first)]);
                to[x] = float(asMean ? sum / (end - first) : sum);
            }
        }
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
