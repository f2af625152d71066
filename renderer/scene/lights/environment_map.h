// Radiance from all directions as an image, sampled by its brightness.
#pragma once

#include <optional>

#include "renderer/base/block_distribution.h"
#include "renderer/image/image.h"
#include "renderer/scene/lights/environment_tiles.h"

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
    EnvironmentMap(const EnvironmentMap&) = delete;  // tiles refer to it
    EnvironmentMap& operator=(const EnvironmentMap&) = delete;

    // Returns the radiance at a point of the unit square.
    Rgb Radiance(const Vec2f& st) const;
    // Starts to load the texels there: every access to a large map waits for memory.
    void Prefetch(const Vec2f& st) const;
    // Returns a point of the unit square, and the density there, which is 0 if the map is black.
    Vec2f Sample(const Vec2f& u, float* pdf) const { return cells.Sample(u, pdf); }
    // Returns the density over the unit square.
    float Pdf(const Vec2f& st) const { return cells.Pdf(st); }
    // Do the same with other probabilities of the tiles, which there must be; `tile` receives the
    // one chosen.
    Vec2f Sample(const TileShares& shares, Vec2f u, float* pdf, int* tile) const {
        *tile = shares.Choose(&u);
        const Vec2f st = tiles->Sample(*tile, u, pdf);
        *pdf *= shares.Probability(*tile);
        return st;
    }
    float Pdf(const TileShares& shares, const Vec2f& st) const {
        int tile;
        const float pdf = tiles->Pdf(st, &tile);
        return pdf * shares.Probability(tile);
    }
    Rgb MeanTexel() const;
    // Returns the tiles of a compensated map; else, and for a black one, null.
    const EnvironmentTiles* Tiles() const { return tiles ? &*tiles : nullptr; }
    // Returns the integral of luminance over all directions, of a map with tiles.
    float TotalLuminance() const { return totalLuminance; }

  private:
    // Writes the brightness of a row of cells.
    void Brightness(int row, std::span<float> cells) const;

    Image image;
    Rgb scale;
    BlockDistribution cells;
    std::optional<EnvironmentTiles> tiles;
    float totalLuminance = 0;
};

}  // namespace lull
