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
                    const Layers& layers) {
    Pixels& pixels = kept[block];
    pixels.tiles = tiles;
    StateWriter writer;
    for (const PixelRect& tile : tiles) {
        CopyPixels(film, tile, &pixels.values);
        PutLayers(layers, tile, &writer);
    }
    pixels.layers = std::move(writer.bytes);
}

std::vector<int> PassUndo::UndoAll(Film* film, const Layers& layers) {
    std::vector<int> blocks;
    for (const auto& [block, pixels] : kept) {
        const FilmPixel* from = pixels.values.data();
        StateReader reader(pixels.layers);
        for (const PixelRect& tile : pixels.tiles) {
            from = SetPixels(from, tile, film);
            GetLayers(&reader, tile, layers);
        }
        blocks.push_back(block);
    }
    kept.clear();
    return blocks;
}

}  // namespace lull
