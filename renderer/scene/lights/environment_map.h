// Radiance from all directions as an image, sampled by its brightness.
#pragma once

#include "renderer/base/block_distribution.h"
#include "renderer/image/image.h"

namespace lull {

// Interpolates bilinearly and repeats in both directions, as pbrt-v3 does. The density is constant
// over cells of half a texel a side, in proportion to the brightness at their centres.
class EnvironmentMap {
  public:
    // Sums of a few such texels are still finite.
    static constexpr float kMaxTexel = 1e37f;

    // Multiplies the texels by `scale`. The products must be from 0 to kMaxTexel. Rows run from
    // theta = 0; the density follows the solid angle of a row. Not compensated, it is pbrt-v3's
    // (3rd ed., 14.2.4). A compensated map leaves texels darker than the mean to BSDF sampling,
    // which suffices there (Karlik et al. 2019), and samples nearly constant maps uniformly.
    EnvironmentMap(Image image, const Rgb& scale, bool isCompensated = false);

    // Returns the radiance at a point of the unit square.
    Rgb Radiance(const Vec2f& st) const;
    // Starts to load the texels there: every access to a large map waits for memory.
    void Prefetch(const Vec2f& st) const;
    // Returns a point of the unit square, and the density there, which is 0 if the map is black.
    Vec2f Sample(const Vec2f& u, float* pdf) const { return cells.Sample(u, pdf); }
    // Returns the density over the unit square.
    float Pdf(const Vec2f& st) const { return cells.Pdf(st); }
    Rgb MeanTexel() const;

  private:
    // Writes the brightness of a row of cells.
    void Brightness(int row, std::span<float> cells) const;

    Image image;
    Rgb scale;
    BlockDistribution cells;
};

}  // namespace lull
