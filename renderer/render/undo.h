// Keeps what a block was before its pass, for passes that the time does not suffice for.
#pragma once

#include <map>

#include "renderer/output/film.h"

namespace lull {

// Holds the pixels of blocks whose pass is under way. A pass is undone as a whole, so that all
// pixels of a block have the same samples.
class PassUndo {
  public:
    // Copies the pixels of a block, unless they have been kept already.
    void Keep(int block, const PixelRect& rect, const Film& film);
    // The pass has come to its end.
    void Forget(int block) { kept.erase(block); }
    // Puts all that is kept back.
    void UndoAll(Film* film);

  private:
    struct Pixels {
        PixelRect rect;
        std::vector<FilmPixel> values;
    };
    std::map<int, Pixels> kept;
};

}  // namespace lull
