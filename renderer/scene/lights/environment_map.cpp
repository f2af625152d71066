#include "renderer/scene/lights/environment_map.h"

#include <numeric>

#include "renderer/base/color.h"
#include "renderer/base/memory.h"
#include "renderer/base/visit.h"
#include "renderer/scene/textures/image_lookup.h"

namespace lull {
namespace {

// Growth of the variance that blocks may add which a compensated map samples evenly.
constexpr float kTolerance = 0.02f;

// Dark cells keep this much of their brightness: directions that scatter light but are never
// sampled, which shading normals cause, need it.
constexpr float kLeast = 0.1f;

// Returns the texel beside that of a cell, on the side of the cell, of n in a ring.
int NeighbourOf(int cell, int n) { return (cell / 2 + (cell % 2 == 0 ? n - 1 : 1)) % n; }

}  // namespace

EnvironmentMap::EnvironmentMap(Image i, const Rgb& s, bool isCompensated)
    : image(std::move(i)), scale(s) {
    const int columns = 2 * image.width, rows = 2 * image.height;
    const auto solidAngle = [&](int row) {
        return std::sin(kPi * (float(row) + 0.5f) / float(rows));
    };
    float mean = 0;
    if (isCompensated) {
        double sum = 0, weights = 0;
        std::vector<float> brightness(columns);
        for (int row = 0; row < rows; ++row) {
            Brightness(row, brightness);
            sum += solidAngle(row) * std::accumulate(brightness.begin(), brightness.end(), 0.0);
            weights += double(solidAngle(row)) * columns;
        }
        mean = float(sum / weights);
    }
    const auto weigh = [&](int row, std::span<float> weights) {
        Brightness(row, weights);
        for (float& w : weights) w = solidAngle(row) * std::max(w - mean, kLeast * w);
    };
    cells = BlockDistribution(columns, rows, weigh, isCompensated ? kTolerance : 0);
}

Rgb EnvironmentMap::Radiance(const Vec2f& st) const {
    return scale * BilinearRgb(image, st, Wrap::Repeat);
}

void EnvironmentMap::Prefetch(const Vec2f& st) const {
    const Footprint f = BilinearFootprint(st, image.width, image.height, Wrap::Repeat);
    Visit(image.texels, [&](const auto& texels) {
        for (const int y : {f.y0, f.y1})
            lull::Prefetch(
                &texels[(size_t(y) * size_t(image.width) + size_t(f.x0)) * size_t(image.channels)]);
    });
}

void EnvironmentMap::Brightness(int row, std::span<float> cells) const {
    // Interpolate between the centres of the texels, down and then across.
    const int near = row / 2, far = NeighbourOf(row, image.height);
    std::vector<float> column(image.width);
    std::visit(
        [&](const auto& texels) {
            for (int x = 0; x < image.width; ++x)
                column[x] = Luminance(scale * (0.75f * TexelRgb(image, texels, x, near) +
                                               0.25f * TexelRgb(image, texels, x, far)));
        },
        image.texels);
    for (int u = 0; u < int(cells.size()); ++u)
        cells[u] = 0.75f * column[u / 2] + 0.25f * column[NeighbourOf(u, image.width)];
}

Rgb EnvironmentMap::MeanTexel() const {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    std::visit(
        [&](const auto& texels) {
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x)
                    sum += TexelRgb(image, texels, x, y).template cast<double>();
        },
        image.texels);
    return scale * (sum / (double(image.width) * image.height)).cast<float>();
}

}  // namespace lull
