#include "renderer/lab/metrics/ssim.h"

#include <limits>

#include "renderer/vision/convolution.h"

namespace lull {

namespace {

// Returns the luma less half of its range: variances are differences of large numbers, which
// lose the less the smaller these are.
std::vector<float> CentredLuma(std::span<const uint8_t> srgb) {
    std::vector<float> luma;
    luma.reserve(srgb.size() / 3);
    for (size_t i = 0; i < srgb.size(); i += 3)
        luma.push_back(float(0.299 * srgb[i] + 0.587 * srgb[i + 1] + 0.114 * srgb[i + 2] - 127.5));
    return luma;
}

std::vector<float> Product(const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<float> product(a.size());
    for (size_t i = 0; i < a.size(); ++i) product[i] = a[i] * b[i];
    return product;
}

}  // namespace

std::vector<float> SsimMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height) {
    constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    const std::vector<double> window = GaussianKernel(1.5, kSsimRadius);
    const auto filter = [&](const std::vector<float>& values) {
        return Convolve(values, width, height, window, window);
    };
    const std::vector<float> x = CentredLuma(image), y = CentredLuma(reference);
    const std::vector<float> meanX = filter(x), meanY = filter(y);
    const std::vector<float> xx = filter(Product(x, x)), yy = filter(Product(y, y)),
                             xy = filter(Product(x, y));

    std::vector<float> map(x.size(), std::numeric_limits<float>::quiet_NaN());
    for (int row = kSsimRadius; row < height - kSsimRadius; ++row)
        for (int column = kSsimRadius; column < width - kSsimRadius; ++column) {
            const size_t i = size_t(row) * width + column;
            const double mx = meanX[i], my = meanY[i];
            const double varianceX = xx[i] - mx * mx, varianceY = yy[i] - my * my;
            const double covariance = xy[i] - mx * my;
            const double lx = mx + 127.5, ly = my + 127.5;
            map[i] = float((2 * lx * ly + c1) * (2 * covariance + c2) /
                           ((lx * lx + ly * ly + c1) * (varianceX + varianceY + c2)));
        }
    return map;
}

}  // namespace lull
