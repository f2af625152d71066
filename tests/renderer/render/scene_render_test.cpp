// Renders small scenes all the way from pbrt text to pixels.
#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"
#include "tests/renderer/scene_of.h"

namespace lull::scene_render_test {
namespace {

// A box open to the viewer with a lamp under its ceiling, a glass ball and a mirror ball.
constexpr const char* kBox = R"(
LookAt 0 0 -3.4  0 0 0  0 1 0
Camera "perspective" "float fov" [39]
Film "image" "integer xresolution" [96] "integer yresolution" [80] "string filename" "box.exr"
Sampler "random"
WorldBegin
Material "matte" "rgb Kd" [.7 .7 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 8 9 10 8 10 11]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1    -1 1 -1  1 1 -1  1 1 1  -1 1 1
             -1 -1 1  1 -1 1  1 1 1  -1 1 1]
Material "matte" "rgb Kd" [.6 .1 .1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [-1 -1 -1  -1 -1 1  -1 1 1  -1 1 -1]
Material "matte" "rgb Kd" [.1 .5 .1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [1 -1 -1  1 -1 1  1 1 1  1 1 -1]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [12 11 9] "bool twosided" "true"
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
    "point P" [-.3 .98 -.3  .3 .98 -.3  .3 .98 .3  -.3 .98 .3]
AttributeEnd
AttributeBegin
  Translate -.4 -.6 .2
  Material "mirror"
  Shape "sphere" "float radius" [.4]
AttributeEnd
AttributeBegin
  Translate .45 -.65 -.3
  Material "glass"
  Shape "sphere" "float radius" [.35]
AttributeEnd
WorldEnd
)";

// An evenly lit wall seen head on: nothing in it can hide a border between blocks.
constexpr const char* kWall = R"(
LookAt 0 0 -2  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "image" "integer xresolution" [80] "integer yresolution" [80] "string filename" "wall.exr"
Sampler "random"
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "matte" "rgb Kd" [.5 .5 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [-5 -5 0  5 -5 0  5 5 0  -5 5 0]
WorldEnd
)";

Film Rendered(const Scene& scene, int threads, int passLength, Estimator estimator,
              uint64_t seed = 0) {
    RenderOptions options;
    options.schedule = {.passLength = passLength, .cap = 20};
    options.sampler = Sampler(SamplerKind::Random, seed);
    options.threads = threads;
    Film film(RegionOf(scene));
    Render(Onto(&film, options, SamplesOf(scene, estimator)));
    return film;
}

// With any estimator, and for any threads and passes.
TEST(SceneRender, GivesACropTheSamePixels) {
    const auto whole = SceneOf(kBox);
    FilmOverrides overrides;
    overrides.crop = {.25f, .75f, .1f, .6f};
    const auto part = SceneOf(kBox, {.film = overrides});
    const PixelRect crop = RegionOf(*part);
    EXPECT_EQ(crop, (PixelRect{{24, 8}, {72, 48}}));
    for (const Estimator estimator : {Estimator::Combined, Estimator::PbrtV3}) {
        const Film wholeFilm = Rendered(*whole, 1, 20, estimator),
                   partFilm = Rendered(*part, 4, 7, estimator);
        for (int y = crop.min.y(); y < crop.max.y(); ++y)
            for (int x = crop.min.x(); x < crop.max.x(); ++x)
                ASSERT_EQ(partFilm.At({x, y}).sum, wholeFilm.At({x, y}).sum) << x << " " << y;
    }
}

TEST(SceneRender, DependsOnTheSeed) {
    const auto scene = SceneOf(kBox);
    EXPECT_NE(Rendered(*scene, 2, 20, Estimator::Combined, 1).MeanImage(),
              Rendered(*scene, 2, 20, Estimator::Combined, 2).MeanImage());
}

// Neighbours across a border differ no more than neighbours elsewhere.
TEST(SceneRender, ShowsNoBordersOfBlocks) {
    const auto scene = SceneOf(kWall);
    RenderOptions options;
    options.schedule = {.blockSize = 20, .passLength = 20, .cap = 200};
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.threads = 2;
    // Stop the blocks at different spp, as criteria do.
    options.makeCriterion = [](const BlockInfo& block) {
        return std::make_unique<ScriptedCriterion>(20 + 60 * (block.index % 3));
    };
    Film film(RegionOf(*scene));
    Render(Onto(&film, options, SamplesOf(*scene, Estimator::Combined)));

    double atBorders = 0, elsewhere = 0, squares = 0;
    int borderPairs = 0, otherPairs = 0;
    for (int y = 0; y < 80; ++y)
        for (int x = 1; x < 80; ++x) {
            const double jump = film.At({x, y}).Mean().x() - film.At({x - 1, y}).Mean().x();
            (x % 20 == 0 ? atBorders : elsewhere) += jump;
            ++(x % 20 == 0 ? borderPairs : otherPairs);
            squares += jump * jump;
        }
    const double deviation = std::sqrt(squares / (borderPairs + otherPairs));
    EXPECT_LT(std::abs(atBorders / borderPairs), 4 * deviation / std::sqrt(borderPairs) + 1e-6);
}

}  // namespace
}  // namespace lull::scene_render_test
