#include "renderer/denoise/denoise.h"

#include <cmath>
#include <numbers>
#include <span>

#include "renderer/denoise/visible_error.h"

namespace lull {

namespace {

constexpr int kDirections = 12;
constexpr int kLineReach = 5;                                                // pixels
constexpr int kBarReach = 2, kBoxRadius = 1, kBoxSide = 2 * kBoxRadius + 1;  // in boxes, and pixels
constexpr int kKernelReach = kBarReach * kBoxSide;
static_assert(kKernelReach >= kLineReach);
constexpr int kMiddleReach = 2;  // pixels of a line, not less than of other kernels
constexpr int kAroundReach = 3;
// Distance up to which pixels contribute to the sums around one.
constexpr int kResidualReach = kKernelReach + kBoxRadius + kAroundReach;
static_assert(kResidualReach == kStructureReach);
constexpr int kRestoreRounds = 3;
// Standard deviations from which on a mean is structure, and is so for certain.
constexpr float kPossible = 4.5f, kCertain = 5.5f;
constexpr float kHeaviest = 1e4f;        // of a mean among others
constexpr float kLeastDeviation = 0.1f;  // in lightness, of a pixel: less is not seen
// The variance of normal noise over the square of its mean distance from 0.
constexpr float kVarianceOfMean = std::numbers::pi_v<float> / 2;

struct Offset {
    int x, y;
};

struct Kernel {
    std::vector<Offset> sums;    // of pixels or, if it is wide, of the boxes around them
    std::vector<Offset> middle;  // the pixels that get the mean
    bool isWide = false;

    int Count() const { return int(sums.size()) * (isWide ? kBoxSide * kBoxSide : 1); }
};

std::vector<Offset> Box(int radius, int step) {
    std::vector<Offset> box;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) box.push_back({x * step, y * step});
    return box;
}

std::vector<Offset> Line(int direction, int reach, int step) {
    const double angle = direction * std::numbers::pi / kDirections, c = std::cos(angle),
                 s = std::sin(angle), length = std::max(std::abs(c), std::abs(s));
    std::vector<Offset> line;
    for (int t = -reach * step; t <= reach * step; t += step)
        line.push_back({int(std::lround(t * c / length)), int(std::lround(t * s / length))});
    return line;
}

// Lines of 11 pixels, bars of 3 x 15, and squares of 3 and 9 pixels a side.
std::vector<Kernel> AllKernels() {
    const std::vector<Offset> pixel = {{0, 0}}, box = Box(kBoxRadius, 1);
    std::vector<Kernel> kernels = {{pixel, pixel, true}, {Box(1, kBoxSide), box, true}};
    for (int i = 0; i < kDirections; ++i) {
        kernels.push_back({Line(i, kLineReach, 1), Line(i, kMiddleReach, 1), false});
        kernels.push_back({Line(i, kBarReach, kBoxSide), box, true});
    }
    return kernels;
}

struct Residual {
    enum Channel {
        kValue,
        kVariance,    // if it is noise
        kDifference,  // half of that of the halves, squared
        kAround,      // the variance by the mean distance of the halves around, if noise is normal
        kTails,       // and that by the mean of its squares
        kChannels
    };
    Cutout pixels, boxes;  // with zeros beyond the border of the picture
};

void MeasureResidual(const Halves& noisy, const Planes& variance, const Halves& picture, int y,
                     int row, Planes* to) {
    for (int x = 0; x < variance.width; ++x) {
        const size_t i = size_t(y) * size_t(variance.width) + size_t(x);
        const float a = LuminanceOf(noisy.a, i), b = LuminanceOf(noisy.b, i);
        const float made = (LuminanceOf(picture.a, i) + LuminanceOf(picture.b, i)) / 2;
        const float slope = DisplayedLightness(made).slope;
        Rgb deviations;
        for (int c = 0; c < kColours; ++c) deviations[c] = std::sqrt(variance.Plane(c)[i]);
        const auto bounded = [](float v) { return std::clamp(v, -1e9f, 1e9f); };
        const float difference = bounded(slope * std::abs(a - b) / 2);
        to->Row(Residual::kValue, row)[x] = bounded(slope * ((a + b) / 2 - made));
        to->Row(Residual::kVariance, row)[x] =
            Sqr(bounded(slope * Luminance(deviations))) / 2 + Sqr(kLeastDeviation);
        to->Row(Residual::kDifference, row)[x] = Sqr(difference);
        to->Row(Residual::kTails, row)[x] = Sqr(difference);
        to->Row(Residual::kAround, row)[x] = difference;
    }
}

void BlurChannel(Residual::Channel channel, Planes* image) {
    Planes blurred(image->width, image->height, 1);
    std::copy_n(image->Plane(channel), image->Area(), blurred.values.data());
    blurred = BoxMean(std::move(blurred), kAroundReach);
    std::copy_n(blurred.values.data(), image->Area(), image->Plane(channel));
}

Cutout WithMargin(const Planes& image, int first, int y0, int y1) {
    Cutout cutout(ImageTile{0, y0, image.width, y1}.Grown(kKernelReach), image.count);
    const int begin = std::max(first, y0 - kKernelReach);
    const int end = std::min(first + image.height, y1 + kKernelReach);
    for (int c = 0; c < image.count; ++c)
        for (int y = begin; y < end; ++y)
            std::copy_n(image.Row(c, y - first), image.width, cutout.At(c, 0, y));
    return cutout;
}

Residual ResidualOf(const Halves& noisy, const Planes& variance, const Halves& picture, int y0,
                    int y1) {
    const int first = std::max(0, y0 - kResidualReach),
              end = std::min(variance.height, y1 + kResidualReach);
    Planes pixels(variance.width, end - first, Residual::kChannels);
    ForEachIndex(end - first, [&](int row) {
        MeasureResidual(noisy, variance, picture, first + row, row, &pixels);
    });
    BlurChannel(Residual::kAround, &pixels);
    BlurChannel(Residual::kTails, &pixels);
    for (size_t i = 0; i < pixels.Area(); ++i)
        pixels.Plane(Residual::kAround)[i] =
            kVarianceOfMean * Sqr(pixels.Plane(Residual::kAround)[i]);
    Cutout ofPixels = WithMargin(pixels, first, y0, y1);
    return {std::move(ofPixels), WithMargin(BoxSum(std::move(pixels), kBoxRadius), first, y0, y1)};
}

// Structure around a pixel: the mean of the residual over a kernel, the share of it that counts,
// and its weight among others, the squared number of standard deviations.
struct Found {
    int x, y;
    size_t kernel;
    float mean, share, weight;
};

struct KernelSum {
    Lanes value, squared;
};

KernelSum SumOver(const Residual& residual, const Kernel& kernel, int x, int y) {
    const Cutout& from = kernel.isWide ? residual.boxes : residual.pixels;
    Lanes value = Lanes::Zero(), variance = value, difference = value, around = value;
    for (const auto [dx, dy] : kernel.sums) {
        value += LanesIn(from.At(Residual::kValue, x + dx, y + dy));
        variance += LanesIn(from.At(Residual::kVariance, x + dx, y + dy));
        difference += LanesIn(from.At(Residual::kDifference, x + dx, y + dy));
        around +=
            LanesIn(from.At(kernel.isWide ? Residual::kTails : Residual::kAround, x + dx, y + dy));
    }
    return {value, value.square() / variance.max(difference).max(around).max(1e-30f)};
}

// Appends the structure found in the pixels [x, x + kLanes) of a row, those below `end`.
void FindAt(const Residual& residual, const std::vector<Kernel>& kernels, int x, int y, int end,
            std::vector<Found>* found) {
    KernelSum best{Lanes::Zero(), Lanes::Constant(Sqr(kPossible))};
    Eigen::Array<int, kLanes, 1> kernelOfBest = Eigen::Array<int, kLanes, 1>::Constant(-1);
    for (size_t k = 0; k < kernels.size(); ++k) {
        const KernelSum sum = SumOver(residual, kernels[k], x, y);
        const auto isBetter = (sum.squared > best.squared).eval();
        if (!isBetter.any()) continue;
        kernelOfBest = isBetter.select(int(k), kernelOfBest);
        best.value = isBetter.select(sum.value, best.value);
        best.squared = isBetter.select(sum.squared, best.squared);
    }
    for (int i = 0; i < std::min(kLanes, end - x); ++i) {
        if (kernelOfBest[i] < 0) continue;
        const size_t k = size_t(kernelOfBest[i]);
        const float share = (std::sqrt(best.squared[i]) - kPossible) / (kCertain - kPossible);
        found->push_back({x + i, y, k, best.value[i] / float(kernels[k].Count()),
                          std::min(share, 1.f), std::min(best.squared[i], kHeaviest)});
    }
}

std::vector<std::vector<Found>> Find(const Halves& noisy, const Planes& variance,
                                     const Halves& picture, const std::vector<Kernel>& kernels) {
    const int width = variance.width, height = variance.height;
    std::vector<std::vector<Found>> rows{size_t(height)};
    for (int y0 = 0; y0 < height; y0 += BandRows(height)) {
        const int y1 = std::min(height, y0 + BandRows(height));
        const Residual residual = ResidualOf(noisy, variance, picture, y0, y1);
        ForEachIndex(y1 - y0, [&](int row) {
            const int y = y0 + row;
            for (int x = 0; x < width; x += kLanes)
                FindAt(residual, kernels, x, y, width, &rows[size_t(y)]);
        });
    }
    return rows;
}

bool IsWithin(const Planes& image, int x, int y) {
    return x >= 0 && y >= 0 && x < image.width && y < image.height;
}

// Calls use(x, y) for the pixels of the image that a kernel around (x, y) sums.
template <typename Use>
void ForEachPixel(const Kernel& kernel, const Planes& image, int x, int y, const Use& use) {
    const int radius = kernel.isWide ? kBoxRadius : 0;
    for (const auto [dx, dy] : kernel.sums)
        for (int v = y + dy - radius; v <= y + dy + radius; ++v)
            for (int u = x + dx - radius; u <= x + dx + radius; ++u)
                if (IsWithin(image, u, v)) use(u, v);
}

Rgb MeanResidual(const Planes& noisy, const Planes& picture, const Kernel& kernel, int x, int y) {
    Rgb sum = Rgb::Zero();
    ForEachPixel(kernel, noisy, x, y, [&](int u, int v) {
        for (int c = 0; c < kColours; ++c) sum[c] += noisy.Row(c, v)[u] - picture.Row(c, v)[u];
    });
    return sum / float(kernel.Count());
}

// Adds to each pixel of the rows [y0, y1) the weighted mean of all that is found around it. `means`
// are those of `all`, which begins with the first that matters to these rows.
void AddToRows(std::span<const Found> all, std::span<const Rgb> means,
               const std::vector<Kernel>& kernels, int y0, int y1, Planes* picture) {
    const int width = picture->width;
    Planes change(width, y1 - y0, kColours), weight(width, y1 - y0, 1);
    for (size_t i = 0; i < all.size() && all[i].y < y1 + kMiddleReach; ++i)
        for (const auto [dx, dy] : kernels[all[i].kernel].middle) {
            const int x = all[i].x + dx, y = all[i].y + dy;
            if (x < 0 || x >= width || y < y0 || y >= y1) continue;
            weight.Row(0, y - y0)[x] += all[i].weight;
            for (int c = 0; c < kColours; ++c)
                change.Row(c, y - y0)[x] += all[i].weight * means[i][c];
        }
    for (int c = 0; c < kColours; ++c) {
        float* to = picture->Row(c, y0);
        for (size_t i = 0; i < weight.Area(); ++i)
            if (weight.values[i] > 0) to[i] += change.Plane(c)[i] / weight.values[i];
    }
}

// Adds to each pixel of a half the weighted mean of all that kernels in whose middle it is find.
void AddFound(const std::vector<Found>& all, const std::vector<Kernel>& kernels,
              const Planes& noisy, Planes* picture) {
    std::vector<Rgb> means(all.size());
    constexpr size_t kAtOnce = 64;
    ForEachIndex(int((all.size() + kAtOnce - 1) / kAtOnce), [&](int part) {
        const size_t first = size_t(part) * kAtOnce;
        for (size_t i = first; i < std::min(first + kAtOnce, all.size()); ++i) {
            const Found& f = all[i];
            means[i] = f.share * MeanResidual(noisy, *picture, kernels[f.kernel], f.x, f.y);
        }
    });
    const int rows = BandRows(noisy.height);
    for (int y0 = 0; y0 < noisy.height; y0 += rows) {
        const auto first = std::ranges::lower_bound(all, y0 - kMiddleReach, {}, &Found::y);
        const size_t skipped = size_t(first - all.begin());
        AddToRows({first, all.end()}, std::span(means).subspan(skipped), kernels, y0,
                  std::min(noisy.height, y0 + rows), picture);
    }
    ClampToSamples(noisy, picture);
}

}  // namespace

void RestoreStructure(const Halves& noisy, const Planes& variance, Halves* picture) {
    const std::vector<Kernel> kernels = AllKernels();
    tbb::this_task_arena::isolate([&] {
        for (int round = 0; round < kRestoreRounds; ++round) {
            std::vector<Found> all;
            for (auto& row : Find(noisy, variance, *picture, kernels)) {
                all.insert(all.end(), row.begin(), row.end());
                row = {};
            }
            if (all.empty()) return;
            for (const auto half : {&Halves::a, &Halves::b})
                AddFound(all, kernels, noisy.*half, &(picture->*half));
        }
    });
}

Planes StructureLeft(const Halves& noisy, const Planes& variance, const Halves& picture) {
    Planes left(variance.width, variance.height, 1);
    tbb::this_task_arena::isolate([&] {
        for (const auto& row : Find(noisy, variance, picture, AllKernels()))
            for (const Found& f : row) left.Row(0, f.y)[f.x] = std::sqrt(f.share) * f.mean;
    });
    return left;
}

}  // namespace lull
