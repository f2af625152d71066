#include "renderer/film/display/snapshot.h"

#include <utility>

namespace lull {

namespace {

int Cells(int pixels) { return (pixels + Snapshot::kCell - 1) / Snapshot::kCell; }

PixelRect Union(const PixelRect& a, const PixelRect& b) {
    if (a.Area() == 0) return b;
    return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
}

PixelRect Intersection(const PixelRect& a, const PixelRect& b) {
    return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)};
}

PixelRect Moved(const PixelRect& r, const Vec2i& by) { return {r.min - by, r.max - by}; }

}  // namespace

Snapshot::Snapshot(const PixelRect& region)
    : region(region),
      width(region.Width()),
      columns(Cells(region.Width())),
      rows(Cells(region.Height())),
      values(size_t(region.Area()) * kChannels),
      denoised(size_t(region.Area())),
      changed(size_t(columns) * size_t(rows)),
      shown(changed.size()) {}

void Snapshot::Mark(const PixelRect& pixels) {
    for (int j = pixels.min.y() / kCell; j < Cells(pixels.max.y()); ++j)
        for (int i = pixels.min.x() / kCell; i < Cells(pixels.max.x()); ++i) {
            const PixelRect cell = {{i * kCell, j * kCell}, {(i + 1) * kCell, (j + 1) * kCell}};
            PixelRect& of = changed[size_t(j) * size_t(columns) + size_t(i)];
            of = Union(of, Intersection(pixels, cell));
        }
}

void Snapshot::Show(const PixelRect& pixels, const Film& film) {
    const PixelRect r = Moved(pixels, region.min);
    std::lock_guard lock(mutex);
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x) {
            const Vec2i p = region.min + Vec2i(x, y);
            const Rgb mean = film.MeanAt(p);
            float* to = At(x, y);
            for (int c = 0; c < 3 && !denoised[Index(x, y)]; ++c) to[c] = mean[c];
            to[3] = float(film.At(p).count);
        }
    Mark(r);
}

void Snapshot::ShowDenoised(const PixelRect& pixels, std::span<const float> rgb) {
    const PixelRect r = Moved(pixels, region.min);
    const float* from = rgb.data();
    std::lock_guard lock(mutex);
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x, from += 3) {
            std::copy_n(from, 3, At(x, y));
            denoised[Index(x, y)] = true;
        }
    Mark(r);
}

void Snapshot::ShowStop(const PixelRect& block) {
    const PixelRect r = Moved(block, region.min);
    std::lock_guard lock(mutex);
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x) At(x, y)[4] = 1;
    Mark(r);
}

void Snapshot::ShowAllAgain() {
    std::lock_guard lock(mutex);
    for (size_t i = 0; i < changed.size(); ++i)
        if (shown[i].Area() > 0) changed[i] = Union(changed[i], shown[i]);
}

bool Snapshot::Take(Update* update) {
    std::lock_guard lock(mutex);
    for (size_t tried = 0; tried < changed.size(); ++tried) {
        const size_t cell = next;
        next = (next + 1) % changed.size();
        if (changed[cell].Area() == 0) continue;
        const PixelRect r = update->pixels = std::exchange(changed[cell], PixelRect());
        shown[cell] = Union(shown[cell], r);
        update->values.clear();
        for (int y = r.min.y(); y < r.max.y(); ++y)
            update->values.insert(update->values.end(), At(r.min.x(), y),
                                  At(r.min.x(), y) + size_t(r.Width()) * kChannels);
        return true;
    }
    return false;
}

}  // namespace lull
