#include <gtest/gtest.h>

#include <numeric>

#include "renderer/render/film_picture.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/film/add_sample.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {

namespace {

double SumOfValues(const Planes& planes) {
    return std::accumulate(planes.values.begin(), planes.values.end(), 0.0);
}

TEST(PictureOf, HasBothHalvesOfTheMean) {
    const FeatureRender render(1);
    const NoisyPicture picture = PictureOf(render.film, kPictureRegion);
    ASSERT_EQ(picture.colour.a.width, kPictureRegion.Width());
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x) {
            const Rgb mean = render.film.At({x + 3, y + 5}).Mean();
            for (int c = 0; c < 3; ++c) {
                const float of =
                    (picture.colour.a.Row(c, y)[x] + picture.colour.b.Row(c, y)[x]) / 2;
                EXPECT_NEAR(of, mean[c], 1e-4f * std::abs(mean[c]));
            }
            for (int c = 0; c < picture.features.count; ++c)
                EXPECT_TRUE(std::isfinite(picture.features.Row(c, y)[x]));
            EXPECT_GE(picture.variance.Row(0, y)[x], 0);
        }
}

TEST(PictureOf, HasTheLightSeenDirectlyByHalves) {
    const FeatureRender render(1);
    const Halves emission = PictureOf(render.film, kPictureRegion).emission;
    for (int x = 0; x < 60; ++x) {
        const float a = emission.a.Row(0, 7)[x], b = emission.b.Row(0, 7)[x];
        EXPECT_EQ(a > 0 && b > 0 && a != b, (x + 3) % 3 == 0) << x;
        EXPECT_EQ(emission.a.Row(1, 7)[x], 0);
        EXPECT_NEAR(a, (x + 3) % 3 == 0 ? 0.5 : 0, 0.25);  // of 18 uniform numbers
    }
    // Too few samples for halves, or no such layer.
    const FeatureRender few(1, 3);
    EXPECT_EQ(SumOfValues(PictureOf(few.film, kPictureRegion).emission.a), 0);
    EXPECT_EQ(EmissionOf(Film(kPictureRegion), kPictureRegion).a.count, 0);
}

// It takes the place of the sums, more rows than are filtered at once.
TEST(TakePicture, IsThePictureOfTheFilm) {
    const PixelRect region{{2, 3}, {42, 203}};
    Film film(region, {.layers = {.features = true}});
    for (int y = 3; y < 203; ++y)
        for (int x = 2; x < 42; ++x) {
            FilmTile tile = film.Tile({{x, y}, {x + 1, y + 1}});
            FilmPixel sums = tile.At({x, y});
            for (uint32_t k = 0; k < 8; ++k) {
                PathSample sample{.index = k, .radiance = Rgb(1, float(x + k), float(y % 7))};
                sample.features.found = true;
                sample.features.weight = 1;
                sample.features.depth = float(1 + (x * y + int(k)) % 13);
                sample.features.albedo = Rgb(0.1f * float(x % 5), 0.5f, 0.02f * float(k));
                if (x == 20) sample.features.emission = Rgb(3, 2, 1);
                sums.Add(sample.radiance, false);
                film.layers.Add({x, y}, sample);
            }
            tile.Set({x, y}, sums);
        }
    const NoisyPicture expected = PictureOf(film, region), taken = TakePicture(&film, region);
    EXPECT_EQ(taken.colour.a.values, expected.colour.a.values);
    EXPECT_EQ(taken.colour.b.values, expected.colour.b.values);
    EXPECT_EQ(taken.features.values, expected.features.values);
    EXPECT_EQ(taken.variance.values, expected.variance.values);
    EXPECT_EQ(taken.emission.a.values, expected.emission.a.values);
    EXPECT_GT(SumOfValues(taken.emission.b), 0);
    EXPECT_FALSE(film.HasHalf());
    EXPECT_EQ(film.layers.Find<EmissionLayer>(), nullptr);
    EXPECT_EQ(film.At({20, 20}).count, 8u);
}

TEST(ReducedPictureOf, HasTheMeansOfPixels) {
    const FeatureRender render(1);
    const NoisyPicture whole = PictureOf(render.film, kPictureRegion),
                       reduced = ReducedPictureOf(render.film, kPictureRegion, 2);
    ASSERT_EQ(reduced.colour.a.width, 15);
    ASSERT_EQ(reduced.features.height, 10);
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 15; ++x) {
            double colour = 0, variance = 0;
            for (int v = 4 * y; v < 4 * y + 4; ++v)
                for (int u = 4 * x; u < 4 * x + 4; ++u) {
                    colour += double(whole.colour.b.Row(1, v)[u]) / 16;
                    variance += double(whole.variance.Row(0, v)[u]) / 256;
                }
            EXPECT_NEAR(reduced.colour.b.Row(1, y)[x], colour, 1e-4 * std::abs(colour));
            EXPECT_NEAR(reduced.variance.Row(0, y)[x], variance, 1e-4 * variance);
        }
}

// Of few samples one half has the pixel, and the other its neighbours, in turns.
TEST(PictureOf, SplitsPixelsWithFewSamplesAsAChessboard) {
    for (const int spp : {1, 3}) {
        const FeatureRender render(1, spp);
        const NoisyPicture picture = PictureOf(render.film, kPictureRegion);
        for (const Vec2i& p : {Vec2i(20, 20), Vec2i(21, 20)}) {
            const auto meanAt = [&](int x, int y) {
                return render.film.At(kPictureRegion.min + Vec2i(x, y)).Mean()[1];
            };
            const float own = meanAt(p.x(), p.y());
            const float neighbours = (meanAt(p.x() - 1, p.y()) + meanAt(p.x() + 1, p.y()) +
                                      meanAt(p.x(), p.y() - 1) + meanAt(p.x(), p.y() + 1)) /
                                     4;
            const bool isInA = (p.x() + p.y()) % 2 == 0;
            const float a = picture.colour.a.Row(1, p.y())[p.x()];
            const float b = picture.colour.b.Row(1, p.y())[p.x()];
            EXPECT_NEAR(isInA ? a : b, own, 1e-5f * own) << spp;
            EXPECT_NEAR(isInA ? b : a, neighbours, 1e-5f * neighbours) << spp;
            EXPECT_GT(picture.variance.Row(0, p.y())[p.x()], 0);
        }
    }
}

TEST(PictureOf, HasTheFirstLookWhereThereAreNoSamples) {
    Film film(kPictureRegion, {.layers = {.features = true}});
    film.SetFirstLook({1000, {Rgb(1, 2, 3)}});
    const NoisyPicture picture = PictureOf(film, kPictureRegion);
    for (const Planes* half : {&picture.colour.a, &picture.colour.b})
        for (int c = 0; c < 3; ++c) EXPECT_EQ(half->Row(c, 7)[9], float(c + 1));
}

// Checks that a film shows its first look where it has no samples, and nowhere else.

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

// Each eye of a pair has squares of its own.
TEST(FirstLook, EndsAtTheSeamOfAPair) {
    Film film({{0, 0}, {20, 5}});
    RenderOptions options;
    options.schedule.eyeWidth = 10;
    TakeFirstLook(PositionSample, options, &film);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 20; ++x) {
            const float shown = film.MeanAt({x, y})[0];
            EXPECT_EQ(shown >= 10, x >= 10) << x;
            EXPECT_LE(std::abs(shown - float(x)), 3) << x;
        }
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

// Blocks stop by the error of the denoised picture and, where their light is told apart, of that of
// each group.

namespace lull::block_denoiser_test {
namespace {

const PixelRect kRegion = {{0, 0}, {40, 40}};

// Each sample finds one of two lamps: the light of each is noise, and their sum is grey.
void OneOfTwoLamps(Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
    sampler.StartSample(pixel, index);
    const int lamp = sampler.Get2D().x() < 0.5f ? 0 : 1;
    sample->index = index;
    sample->radiance = Rgb::Constant(0.5f);
    if (sample->groups) {
        sample->groups->Clear();
        sample->groups->Add(lamp, sample->radiance);
    }
    sample->features = {.albedo = sample->radiance, .depth = 1, .found = true};
}

// Renders by the rule `denoised`; returns the samples that the block took.
int SppOf(bool withGroups) {
    LayerOptions layers = {.features = true, .groupNoise = true};
    if (withGroups) layers.groups = {{"a", "b"}, {0, 1}};
    Film film(kRegion, {.grid = {.blockSize = 40, .tileSize = 8}, .layers = layers});
    RenderOptions options;
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.schedule = {.blockSize = 40, .passLength = 20, .cap = 640};
    options.threads = 2;
    const auto denoiser = std::make_shared<BlockDenoiser>(MakeBlocks(kRegion, options.schedule));
    denoiser->Show(&film);
    options.makeCriterion = CriteriaOf(
        ParseRule("denoised:1", {.passSpp = 20,
                                 .blockCount = 1,
                                 .cap = 640,
                                 .measures = {{kDenoisedRuleName, MeasureOf(denoiser)}}}));
    const RenderResult result = Render(Onto(&film, options, OneOfTwoLamps));
    const auto* lights = film.layers.Find<LightGroupLayer>();
    for (int y = 0; y < 40 && withGroups; ++y)
        for (int x = 0; x < 40; ++x) {
            const FilmPixel a = lights->At(0, {x, y}, 1), b = lights->At(1, {x, y}, 1);
            EXPECT_EQ(a.sum[0] + b.sum[0], film.At({x, y}).sum[0]);
            EXPECT_EQ(a.halfSum[0] + b.halfSum[0], film.At({x, y}).halfSum[0]);
        }
    return result.blocks.at(0).block.spp;
}

TEST(BlockDenoiser, WaitsForEveryLightGroup) {
    EXPECT_EQ(SppOf(false), 20);
    EXPECT_GT(SppOf(true), 60);
}

}  // namespace
}  // namespace lull::block_denoiser_test
