// Adds samples to films in tests.
#pragma once

#include "renderer/film/film.h"

namespace lull {

inline void AddTo(Film* film, const Vec2i& p, const Rgb& radiance, bool rejected = false) {
    FilmPixel pixel = film->At(p);
    pixel.Add(radiance, rejected);
    film->Set(p, pixel);
}

}  // namespace lull
