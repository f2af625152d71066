// Checks that a film shows its first look where it has no samples, and nowhere else.
#include "renderer/render/first_look.h"

#include <gtest/gtest.h>

#include "tests/renderer/film/add_sample.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

const PixelRect kLookRegion = {{3, 5}, {24, 15}};  // of no whole number of squares

void PositionSample(Sampler&, const Vec2i& pixel, uint32_t index, PathSample* sample) {
    EXPECT_EQ(index, 0u);
    sample->radiance = Rgb(float(pixel.x()), float(pixel.y()), 1);
}

TEST(FirstLook, ShowsAPixelOfEachSquare) {
    Film film(kLookRegion);
    EXPECT_TRUE(IsBlack(film.MeanAt({3, 5})));
    AddTo(&film, {4, 6}, Rgb(7, 8, 9));
    RenderOptions options;
    options.threads = 3;
    TakeFirstLook(PositionSample, options, &film);
    EXPECT_TRUE((film.MeanAt({4, 6}) == Rgb(7, 8, 9)).all());
    EXPECT_EQ(film.SampleCount(), 1);
    for (int y = kLookRegion.min.y(); y < kLookRegion.max.y(); ++y)
        for (int x = kLookRegion.min.x(); x < kLookRegion.max.x(); ++x) {
            if (film.At({x, y}).count > 0) continue;
            const Rgb mean = film.MeanAt({x, y});
            EXPECT_LE(std::abs(mean[0] - float(x)), 3) << x << " " << y;
            EXPECT_LE(std::abs(mean[1] - float(y)), 3) << x << " " << y;
        }
    FilmView view;
    film.Extract(kLookRegion, false, &view);
    EXPECT_EQ(view.mean, film.MeanImage());
    EXPECT_TRUE(std::ranges::all_of(view.mean, [](float v) { return v > 0; }));
}

TEST(FirstLook, IsLeftOutWhereItWouldNotBeSeen) {
    Film film(kLookRegion);
    RenderOptions cancelled;
    cancelled.isCancelled = [] { return true; };
    TakeFirstLook(PositionSample, cancelled, &film);
    EXPECT_TRUE(IsBlack(film.MeanAt({3, 5})));
    for (int y = kLookRegion.min.y(); y < kLookRegion.max.y(); ++y)
        for (int x = kLookRegion.min.x(); x < kLookRegion.max.x(); ++x)
            AddTo(&film, {x, y}, Rgb(1, 1, 1));
    TakeFirstLook([](Sampler&, const Vec2i&, uint32_t, PathSample*) { ADD_FAILURE(); },
                  RenderOptions(), &film);
}

}  // namespace
}  // namespace lull
