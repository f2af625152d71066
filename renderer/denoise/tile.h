// Cuts images into tiles whose pixels are computed sixteen side by side.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Core>

#include "renderer/denoise/planes.h"

namespace lull {

inline constexpr int kLanes = 16;  // pixels that are computed side by side
using Lanes = Eigen::Array<float, kLanes, 1>;
using LanesIn = Eigen::Map<const Lanes>;
inline void Store(const Lanes& values, float* to) { Eigen::Map<Lanes>{to} = values; }

// Holds the pixels [x0, x1) x [y0, y1).
struct ImageTile {
    int x0, y0, x1, y1;

    ImageTile Grown(int margin) const {
        return {x0 - margin, y0 - margin, x1 + margin, y1 + margin};
    }
};

// Calls use(tile) for the tiles of an image, in any order, on all threads. How an image is cut
// depends on nothing but its size.
template <typename Use>
void ForEachTile(int width, int height, const Use& use) {
    constexpr int side = 128;
    const int columns = (width + side - 1) / side, rows = (height + side - 1) / side;
    // Isolated, so that a thread that waits here takes up no other task of a render.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(0, columns * rows, [&](int i) {
            const int x = i % columns * side, y = i / columns * side;
            use(ImageTile{x, y, std::min(x + side, width), std::min(y + side, height)});
        });
    });
}

// Holds the part of an image that a tile covers, copied so that rows can be read up to 4 kLanes
// past their end; where the tile lies beyond the image, the border is repeated.
class Cutout {
  public:
    Cutout(const ImageTile& tile, int count)
        : tile(tile), planes(tile.x1 - tile.x0 + 4 * kLanes, tile.y1 - tile.y0, count) {}
    Cutout(const ImageTile& tile, const Planes& image) : Cutout(tile, image.count) {
        for (int c = 0; c < image.count; ++c)
            for (int y = 0; y < planes.height; ++y) {
                const float* from = image.Row(c, std::clamp(tile.y0 + y, 0, image.height - 1));
                float* to = planes.Row(c, y);
                for (int x = 0; x < planes.width; ++x)
                    to[x] = from[std::clamp(tile.x0 + x, 0, image.width - 1)];
            }
    }

    // Returns where the value of a pixel is, by its place in the image.
    float* At(int c, int x, int y) { return planes.Row(c, y - tile.y0) + (x - tile.x0); }
    const float* At(int c, int x, int y) const {
        return planes.Row(c, y - tile.y0) + (x - tile.x0);
    }
    const ImageTile& Area() const { return tile; }
    int Count() const { return planes.count; }

  private:
    ImageTile tile;
    Planes planes;
};

}  // namespace lull
