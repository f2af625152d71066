// Adds samples to films in tests, whose tiles are single pixels.
#pragma once

#include "renderer/film/film.h"

namespace lull {

inline void AddTo(Film* film, const Vec2i& p, const Rgb& radiance, bool rejected = false) {
    FilmTile tile = film->Tile({p, p + Vec2i(1, 1)});
    FilmPixel pixel = tile.At(p);
    pixel.Add(radiance, rejected);
    tile.Set(p, pixel);
}

}  // namespace lull
