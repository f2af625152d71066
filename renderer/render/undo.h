// Saves the state of a block before a pass, to undo passes that exceed the time limit.
#pragma once

#include <map>

#include "renderer/film/film.h"

namespace lull {

// The pixels of blocks whose pass is under way. A pass is undone as a whole, so that all
// pixels of a block have the same samples.
class PassUndo {
  public:
    bool Has(int block) const { return kept.contains(block); }
    // Copies the pixels of the block that are in these tiles.
    void Keep(int block, const std::vector<PixelRect>& tiles, const Film&);
    // The pass has come to its end.
    void Forget(int block) { kept.erase(block); }
    // Puts all that is kept back. Returns the blocks.
    std::vector<int> UndoAll(Film*);

  private:
    struct Pixels {
        std::vector<PixelRect> tiles;
        std::vector<std::byte> planes;  // tile by tile, by PutPlanes()
    };
    std::map<int, Pixels> kept;
};

}  // namespace lull
