// Filters images as pbrt-v3 does: from smaller and smaller copies, trilinearly or by elliptically
// weighted averages (pbrt 3rd ed., 10.4.3 to 10.4.5; Heckbert 1989).
#pragma once

#include <vector>

#include "renderer/base/math.h"
#include "renderer/scene/textures/image_lookup.h"

namespace lull {

// An image and its copies of half the size each, down to a single texel.
class MipPyramid {
  public:
    // Takes an image of 1 or 3 interleaved channels, its rows from the bottom, neither side 0. If a
    // side is not a power of two, the image is enlarged to the next one as in pbrt-v3 (Lanczos,
    // over two texels to each side), and negative results become 0. Throws Error if there is not
    // enough memory.
    MipPyramid(int width, int height, int channels, std::vector<float> texels, Wrap wrapS,
               Wrap wrapT);

    int LevelCount() const { return int(levels.size()); }
    size_t Bytes() const;

    // T is float for images of one channel, or Rgb. Any point of texture space is valid; results
    // are finite if the texels are.

    // Interpolates a level, 0 being the finest.
    template <typename T>
    T Bilinear(int level, const Vec2f& st) const;

    // Averages over about `width`, which is a share of the image's longer side, in both directions.
    template <typename T>
    T Trilinear(const Vec2f& st, float width) const;

    // Averages over an ellipse by a Gaussian. `d0` and `d1` are how far st moves from one sample of
    // the film to the next in either direction; the shorter is lengthened so that the longer is at
    // most `maxAnisotropy` (> 0) times as long.
    template <typename T>
    T Ewa(const Vec2f& st, Vec2f d0, Vec2f d1, float maxAnisotropy) const;

  private:
    // Sides are powers of two.
    struct Level {
        int width, height;
        std::vector<float> texels;
    };

    template <typename T>
    T Texel(int level, int x, int y) const;
    template <typename T>
    T Coarsest() const {
        return Texel<T>(LevelCount() - 1, 0, 0);
    }
    template <typename T>
    T EwaOfLevel(int level, const Vec2f& st, Vec2f d0, Vec2f d1) const;

    int channels;
    Wrap wrapS, wrapT;
    std::vector<Level> levels;
};

}  // namespace lull
