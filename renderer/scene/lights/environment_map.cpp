#include "renderer/scene/lights/environment_map.h"

#include "renderer/base/color.h"
#include "renderer/base/memory.h"
#include "renderer/scene/image_lookup.h"

namespace lull {
namespace {

// Brings an index in [0, 2 n) to [0, n).
int Wrapped(int i, int n) { return i < n ? i : i - n; }

// Interpolates between the corners of a quad, at the centre of its near (0) or far (1) cell along
// each axis.
float CellBrightness(const std::array<float, 4>& corners, int u, int v) {
    const float du = 0.25f + 0.5f * float(u), dv = 0.25f + 0.5f * float(v);
    return (1 - dv) * ((1 - du) * corners[0] + du * corners[1]) +
           dv * ((1 - du) * corners[2] + du * corners[3]);
}

// Chooses the near (0) or the far (1) part by their weights; `t` in [0, 1) becomes the place in it.
int ChooseFar(float nearWeight, float farWeight, float* t) {
    const float border = nearWeight / (nearWeight + farWeight);
    const bool isFar = !(*t < border);
    *t = isFar ? (*t - border) / (1 - border) : *t / border;
    return isFar;
}

}  // namespace

EnvironmentMap::EnvironmentMap(Image i, const Rgb& s, bool isCompensated)
    : image(std::move(i)),
      scale(s),
      kLuminanceWeights(s * Rgb(Luminance({1, 0, 0}), Luminance({0, 1, 0}), Luminance({0, 0, 1}))) {
    const int rows = 2 * image.height;
    for (int v = 0; v < rows; ++v) rowWeights.push_back(std::sin(kPi * (v + 0.5f) / rows));

    // Weigh the quads; to compensate, once more by what lies above the mean.
    std::vector<float> weights(size_t(image.width) * size_t(image.height));
    double total = 0, solidAngle = 0;
    for (int pass = 0; pass <= int(isCompensated); ++pass) {
        if (pass == 1) compensation = float(total / solidAngle);
        total = solidAngle = 0;
        for (int j = 0; j < image.height; ++j) {
            for (int i = 0; i < image.width; ++i) {
                const std::array<float, 4> corners = Corners(i, j);
                float weight = 0;
                for (int v = 0; v < 2; ++v) {
                    const float rowWeight = rowWeights[Wrapped(2 * j + 1 + v, rows)];
                    for (int u = 0; u < 2; ++u) weight += rowWeight * CellWeight(corners, u, v);
                    solidAngle += 2 * rowWeight;
                }
                weights[size_t(j) * image.width + i] = weight;
                total += weight;
            }
        }
    }
    quads = Distribution2D(weights, image.width, image.height);
    // A map that is black, or so dark that this overflows, is left to be found by chance.
    const float norm = float(4.0 * image.width * image.height / total);
    for (float& weight : rowWeights) weight = std::isfinite(norm) ? weight * norm : 0;
}

Rgb EnvironmentMap::Radiance(const Vec2f& st) const {
    return scale * BilinearRgb(image, st, Wrap::Repeat);
}

std::array<float, 4> EnvironmentMap::Corners(int i, int j) const {
    const int i1 = i + 1 == image.width ? 0 : i + 1, j1 = j + 1 == image.height ? 0 : j + 1;
    return std::visit(
        [&](const auto& texels) {
            const auto brightness = [&](int x, int y) {
                return Rgb(kLuminanceWeights * TexelRgb(image, texels, x, y)).sum();
            };
            return std::array{brightness(i, j), brightness(i1, j), brightness(i, j1),
                              brightness(i1, j1)};
        },
        image.texels);
}

void EnvironmentMap::Prefetch(int i, int j) const {
    const int j1 = j + 1 == image.height ? 0 : j + 1;
    std::visit(
        [&](const auto& texels) {
            for (const int y : {j, j1})
                lull::Prefetch(&texels[(size_t(y) * size_t(image.width) + size_t(i)) *
                                       size_t(image.channels)]);
        },
        image.texels);
}

float EnvironmentMap::CellWeight(const std::array<float, 4>& corners, int u, int v) const {
    constexpr float kLeast = 0.1f;
    const float brightness = CellBrightness(corners, u, v);
    return std::max(brightness - compensation, kLeast * brightness);
}

Vec2f EnvironmentMap::Sample(const Vec2f& u, float* pdf) const {
    // Choose a quad.
    const Vec2f p = quads.SampleContinuous(u, [&](int i, int j) { Prefetch(i, j); });
    const float x = p.x() * float(image.width), y = p.y() * float(image.height);
    const int i = std::min(int(x), image.width - 1), j = std::min(int(y), image.height - 1);
    float tx = x - float(i), ty = y - float(j);

    // Choose one of its cells: a row, then one of the two in it.
    const int columns = 2 * image.width, rows = 2 * image.height;
    const std::array<float, 4> corners = Corners(i, j);
    std::array<std::array<float, 2>, 2> density;
    for (const int v : {0, 1})
        for (const int h : {0, 1})
            density[v][h] = rowWeights[Wrapped(2 * j + 1 + v, rows)] * CellWeight(corners, h, v);
    const float nearV = density[0][0] + density[0][1], farV = density[1][0] + density[1][1];
    *pdf = 0;
    if (!(nearV + farV > 0)) return p;
    const int v = ChooseFar(nearV, farV, &ty), h = ChooseFar(density[v][0], density[v][1], &tx);
    *pdf = density[v][h];
    const float column = float(Wrapped(2 * i + 1 + h, columns)) + tx;
    const float row = float(Wrapped(2 * j + 1 + v, rows)) + ty;
    return {std::min(column / float(columns), kOneMinusEpsilon),
            std::min(row / float(rows), kOneMinusEpsilon)};
}

float EnvironmentMap::Pdf(const Vec2f& st) const {
    const int columns = 2 * image.width, rows = 2 * image.height;
    const int column = std::clamp(int(st.x() * float(columns)), 0, columns - 1);
    const int row = std::clamp(int(st.y() * float(rows)), 0, rows - 1);
    // Cells 2 i + 1 and 2 i + 2 are those of quad i, where cell 0 follows the last.
    const int u = Wrapped(column + columns - 1, columns), v = Wrapped(row + rows - 1, rows);
    return rowWeights[row] * CellWeight(Corners(u / 2, v / 2), u % 2, v % 2);
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
