#include "renderer/render/first_look.h"

#include "stopping/base/parallel.h"

namespace lull {

namespace {

constexpr int kSpacing = 4;  // pixels

bool HasAllSamples(const Film& film) {
    const PixelRect& region = film.Region();
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x)
            if (film.At({x, y}).count == 0) return false;
    return true;
}

}  // namespace

void TakeFirstLook(const SampleSource& source, const RenderOptions& options, Film* film) {
    if (HasAllSamples(*film)) return;
    const PixelRect& region = film->Region();
    const int columns = (region.Width() + kSpacing - 1) / kSpacing;
    const int rows = (region.Height() + kSpacing - 1) / kSpacing;
    FirstLook look{kSpacing, std::vector<Rgb>(size_t(columns) * size_t(rows), Rgb(0, 0, 0))};
    const auto isCancelled = [&] { return options.isCancelled && options.isCancelled(); };
    const auto takeRow = [&](int row) {
        Sampler sampler = options.sampler;
        PathSample sample;
        for (int column = 0; column < columns && !isCancelled(); ++column) {
            const Vec2i middle = kSpacing * Vec2i(column, row) + Vec2i(kSpacing, kSpacing) / 2;
            const Vec2i pixel = (region.min + middle).cwiseMin(region.max - Vec2i(1, 1));
            source(sampler, pixel, 0, &sample);
            look.colours[size_t(row) * size_t(columns) + size_t(column)] = sample.radiance;
        }
    };
    RunWithThreads(options.threads, [&] { ForEachIndex(rows, takeRow); });
    if (!isCancelled()) film->SetFirstLook(std::move(look));
}

}  // namespace lull
