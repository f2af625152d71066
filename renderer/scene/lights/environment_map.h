// Radiance from all directions as an image, sampled by its brightness.
#pragma once

#include <array>

#include "renderer/base/sampling.h"
#include "renderer/image/image.h"

namespace lull {

// Interpolates bilinearly and repeats in both directions, as pbrt-v3 does. The density is pbrt-v3's
// as well (3rd ed., 14.2.4): constant over cells of half a texel a side, the brightness at their
// centres. The four cells between the centres of four texels, a quad, follow from these texels,
// which radiance needs too; so the table holds quads, and a density needs no table at all. This
// matters, as every access to a large map waits for memory.
class EnvironmentMap {
  public:
    // Sums of a few such texels are still finite.
    static constexpr float kMaxTexel = 1e37f;

    // Multiplies the texels by `scale`. The products must be from 0 to kMaxTexel. Rows run from
    // theta = 0; the density follows the solid angle of a row. A compensated map leaves what is
    // darker than the mean to BSDF sampling, which handles it well enough (Karlik et al. 2019).
    EnvironmentMap(Image image, const Rgb& scale, bool isCompensated = false);

    // Returns the radiance at a point of the unit square.
    Rgb Radiance(const Vec2f& st) const;
    // Returns a point of the unit square, and the density there, which is 0 if the map is black.
    Vec2f Sample(const Vec2f& u, float* pdf) const;
    // Returns the density over the unit square.
    float Pdf(const Vec2f& st) const;
    Rgb MeanTexel() const;

  private:
    // Returns the brightness of the texels around a quad: (i, j), (i + 1, j), (i, j + 1) and (i +
    // 1, j + 1), where the first follows the last.
    std::array<float, 4> Corners(int i, int j) const;

    // Starts to load them.
    void Prefetch(int i, int j) const;

    // Returns the density of a cell up to a constant, without its solid angle. Dark cells
    // keep some: directions that scatter light but are never sampled, which shading normals cause,
    // need it.
    float CellWeight(const std::array<float, 4>& corners, int u, int v) const;

    Image image;
    Rgb scale, kLuminanceWeights;
    Distribution2D quads;
    float compensation = 0;         // brightness that is left to BSDF sampling
    std::vector<float> rowWeights;  // from brightness to density, by row of cells
};

}  // namespace lull
