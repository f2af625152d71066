#include "renderer/render/undo.h"

namespace lull {

void PassUndo::Keep(int block, const PixelRect& rect, const Film& film) {
    const auto [entry, isNew] = kept.try_emplace(block, Pixels{rect, {}});
    if (!isNew) return;
    std::vector<FilmPixel>& values = entry->second.values;
    values.reserve(size_t(rect.Area()));
    for (int y = rect.min.y(); y < rect.max.y(); ++y) {
        const FilmPixel* row = &film.At({rect.min.x(), y});
        values.insert(values.end(), row, row + rect.Width());
    }
}

void PassUndo::UndoAll(Film* film) {
    for (const auto& [block, pixels] : kept) {
        const PixelRect& rect = pixels.rect;
        const FilmPixel* from = pixels.values.data();
        for (int y = rect.min.y(); y < rect.max.y(); ++y, from += rect.Width())
            std::copy_n(from, rect.Width(), &film->At({rect.min.x(), y}));
    }
    kept.clear();
}

}  // namespace lull
