#include "renderer/render/undo.h"

namespace lull {

void PassUndo::Keep(int block, const std::vector<PixelRect>& tiles, const Film& film) {
    StateWriter writer;
    for (const PixelRect& tile : tiles) PutPlanes(film, tile, &writer);
    kept[block] = {tiles, std::move(writer.bytes)};
}

std::vector<int> PassUndo::UndoAll(Film* film) {
    std::vector<int> blocks;
    for (const auto& [block, pixels] : kept) {
        StateReader reader(pixels.planes);
        for (const PixelRect& tile : pixels.tiles) GetPlanes(&reader, tile, film);
        blocks.push_back(block);
    }
    kept.clear();
    return blocks;
}

}  // namespace lull
