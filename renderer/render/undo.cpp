#include "renderer/render/undo.h"

namespace lull {

void CopyPixels(const Film& film, const PixelRect& rect, std::vector<FilmPixel>* to) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x) to->push_back(film.At({x, y}));
}

const FilmPixel* SetPixels(const FilmPixel* from, const PixelRect& rect, Film* film) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x) film->Set({x, y}, *from++);
    return from;
}

void PassUndo::Keep(int block, const std::vector<PixelRect>& tiles, const Film& film,
                    const AovFilm* aovs) {
    Pixels& pixels = kept[block];
    pixels.tiles = tiles;
    for (const PixelRect& tile : tiles) CopyPixels(film, tile, &pixels.values);
    for (const PixelRect& tile : tiles)
        if (aovs) aovs->Copy(tile, &pixels.aovs);
}

std::vector<int> PassUndo::UndoAll(Film* film, AovFilm* aovs) {
    std::vector<int> blocks;
    for (const auto& [block, pixels] : kept) {
        const FilmPixel* from = pixels.values.data();
        for (const PixelRect& tile : pixels.tiles) from = SetPixels(from, tile, film);
        const AovPixel* fromAovs = pixels.aovs.data();
        for (const PixelRect& tile : pixels.tiles)
            if (aovs) fromAovs = aovs->Set(fromAovs, tile);
        blocks.push_back(block);
    }
    kept.clear();
    return blocks;
}

}  // namespace lull
