#include "renderer/film/film.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/renderer/files/test_files.h"

namespace lull::layers_test {
namespace {

const PixelRect kRegion = {{3, 5}, {43, 31}};

const LayerOptions kAll = {.aovs = {.depth = true, .alpha = true, .cryptomatte = true},
                           .features = true,
                           .groups = {{"a", "rest"}, {0, 1}},
                           .groupNoise = true,
                           .groupBackground = true};

Film MakeFilm(const LayerOptions& layers, bool withHalf = true) {
    return Film(kRegion,
                {.grid = {.blockSize = 20, .tileSize = 8}, .withHalf = withHalf, .layers = layers});
}

struct Planes {
    Film film = MakeFilm(kAll);

    // Adds a sample to each pixel of a tile, different in all of them.
    void AddTo(const PixelRect& pixels) {
        FilmTile tile = film.Tile(pixels);
        for (int y = pixels.min.y(); y < pixels.max.y(); ++y)
            for (int x = pixels.min.x(); x < pixels.max.x(); ++x) {
                FilmPixel pixel = tile.At({x, y});
                const Rgb radiance(float(x), float(y), 1);
                const FirstHit hit = {.albedo = radiance / 64,
                                      .depth = float(x + y),
                                      .object = uint32_t(x),
                                      .material = uint32_t(y),
                                      .found = true,
                                      .weight = 1};
                GroupRadiance groups(kAll.groups);
                groups.Clear();
                groups.Add(0, radiance / 4);
                groups.Add(1, radiance / 2);
                groups.Add(1, radiance / 4);
                film.layers.Add(
                    {x, y},
                    {.groups = &groups, .index = pixel.count, .radiance = radiance, .hit = hit});
                pixel.Add(radiance, x % 3 == 0);
                tile.Set({x, y}, pixel);
            }
    }
    std::vector<std::byte> Bytes(const PixelRect& pixels) {
        StateWriter writer;
        PutPlanes(film, pixels, &writer);
        return std::move(writer.bytes);
    }
};

const PixelRect kBlock = {{23, 5}, {43, 25}}, kTile = {{39, 21}, {43, 25}};

TEST(Planes, AreSetToWhatWasPut) {
    Planes from, to;
    for (int i = 0; i < 4; ++i) from.AddTo(kBlock);
    from.AddTo(kTile);
    const std::vector<std::byte> bytes = from.Bytes(kBlock);
    // Sums of all samples and of the half, layers, two groups of lights, and nine tiles.
    EXPECT_EQ(bytes.size(), 400u * (24 + 24 + 56 + 40 + 4 + 40 + 128 + 2 * 80) + 9 * 8);
    EXPECT_EQ(Layers::Bytes(kAll), 56 + 40 + 4 + 40 + 128 + 2 * 80);
    StateReader reader(bytes);
    GetPlanes(&reader, kBlock, &to.film);
    EXPECT_NO_THROW(reader.Finish());
    EXPECT_EQ(to.Bytes(kRegion), from.Bytes(kRegion));  // nothing is anywhere else
    EXPECT_EQ(to.film.SampleCount(), 4 * 400 + 16);
    EXPECT_EQ(to.film.RejectedCount(), from.film.RejectedCount());
    EXPECT_EQ(to.film.At({41, 23}).sum, (std::array<double, 3>{205, 115, 5}));
    EXPECT_EQ(to.film.layers.Find<LightGroupLayer>()->At(1, {41, 23}, 5).sum,
              (std::array<double, 3>{153.75, 86.25, 3.75}));
    EXPECT_EQ(to.film.layers.Find<LightGroupLayer>()->At(1, {41, 23}, 5).halfSum,
              (std::array<double, 3>{61.5, 34.5, 1.5}));
}

TEST(Planes, ReplaceWhatWasThere) {
    Planes planes;
    planes.AddTo(kTile);
    const std::vector<std::byte> before = planes.Bytes(kRegion);
    const std::vector<std::byte> tile = planes.Bytes(kTile);
    planes.AddTo(kTile);
    EXPECT_NE(planes.Bytes(kRegion), before);
    StateReader reader(tile);
    GetPlanes(&reader, kTile, &planes.film);
    EXPECT_EQ(planes.Bytes(kRegion), before);
}

TEST(Planes, AreThoseThatThereAre) {
    const auto names = [](const LayerOptions& layers) {
        const Film film = MakeFilm(layers, false);
        std::string text;
        Film::ForEachPlane(
            film, kTile,
            [&](const std::string& name, const auto&, const PixelRect&) { text += name + "; "; });
        EXPECT_EQ(int64_t(std::ranges::count(text, ';')), int64_t(PlanesOf(film).size()) + 1);
        return text;
    };
    EXPECT_EQ(names({}), "tiles; sums; ");
    EXPECT_EQ(names({.features = true}),
              "tiles; sums; features; noise for the denoiser; lamps for the denoiser; ");
    EXPECT_EQ(names({.aovs = {.normal = true, .object = true, .noise = true}}),
              "tiles; sums; albedo and normal; object and material; noise; ");
    EXPECT_EQ(names({.aovs = {.cryptomatte = true}}), "tiles; sums; alpha; cryptomatte; ");
    EXPECT_EQ(names({.groups = {{"a"}, {0}}, .groupNoise = true, .groupBackground = true}),
              "tiles; sums; light group 00; light group 00 noise; light group 00 background; ");
}

TEST(Planes, HaveTheIdentityOfTheirLayers) {
    LayerOptions layers = {.aovs = {.depth = true, .noise = true}};
    const auto first = PlanesOf(MakeFilm(layers));
    layers.aovs.throughSpecular = true;
    const auto through = PlanesOf(MakeFilm(layers));
    EXPECT_EQ(first.at("noise"), through.at("noise"));
    EXPECT_NE(first.at("depth and position"), through.at("depth and position"));
}

TEST(Layers, AskForFirstHitsWhereOneOfThemDoes) {
    EXPECT_FALSE(Layers(kRegion, {}).NeedFirstHits());
    EXPECT_TRUE(Layers(kRegion, {}).IsEmpty());
    EXPECT_FALSE(Layers(kRegion, {.aovs = {.noise = true}}).NeedFirstHits());
    EXPECT_FALSE(Layers(kRegion, {.aovs = {.noise = true}}).IsEmpty());
    EXPECT_TRUE(Layers(kRegion, {.aovs = {.depth = true, .noise = true}}).NeedFirstHits());
}

TEST(Planes, AreNotReadFromTooFewBytes) {
    Planes planes;
    std::vector<std::byte> bytes = planes.Bytes(kTile);
    bytes.pop_back();
    StateReader reader(bytes);
    EXPECT_THROW(GetPlanes(&reader, kTile, &planes.film), std::runtime_error);
}

TEST(AovSet, HasNames) {
    EXPECT_EQ(
        NameOf(ParseAovs({"noise", "albedo", "normal", "depth", "position", "object", "material"})),
        "albedo,normal,depth,position,object,material,noise");
    EXPECT_TRUE(ParseAovs({"depth"}).Hits());
    EXPECT_FALSE(ParseAovs({"noise"}).Hits());
    EXPECT_TRUE(ParseAovs({"noise"}).Any());
    EXPECT_FALSE(AovSet().Any());
    for (const char* bad : {"", "Albedo", "albedo normal", "albedo,noise"})
        EXPECT_HAS(ErrorOf([&] { ParseAovs({"depth", bad}); }), "there is no layer") << bad;
}

FirstHit HitOf(uint32_t object, float weight = 1) {
    return {.object = object, .material = object + 10, .found = true, .weight = weight};
}

TEST(MatteLayer, CountsWhatIsCoveredByWeight) {
    AlphaPixel pixel;
    EXPECT_EQ(pixel.Alpha(), 0);
    pixel.Add(HitOf(1, 2), Rgb(1, 1, 1));
    EXPECT_EQ(pixel.Alpha(), 1);
    pixel.Add({.weight = 6}, Rgb(0.25f, 0.5f, 1));
    pixel.Add({.weight = -1}, Rgb(-0.25f, 0, 0));  // of a filter with negative lobes
    EXPECT_FLOAT_EQ(pixel.Alpha(), 2 / 7.f);
    EXPECT_EQ(pixel.background, (std::array<double, 3>{0, 0.5, 1}));
    // Never beyond 1.
    pixel.Add({.weight = -6}, Rgb::Zero());
    EXPECT_EQ(pixel.Alpha(), 1);
}

TEST(MatteLayer, SharesPixelsAmongObjects) {
    CryptoPixel pixel;
    for (const uint32_t object : {4u, 7u, 4u, 0u}) pixel.Add({.object = object, .material = 1});
    EXPECT_EQ(pixel.objects[0], (MatteShare{4, 2}));
    EXPECT_EQ(pixel.objects[1], (MatteShare{7, 1}));
    EXPECT_EQ(pixel.objects[2], MatteShare());
    EXPECT_EQ(pixel.materials[0], (MatteShare{1, 4}));
    // Those that come when all places are taken are left out.
    for (uint32_t object = 100; object < 120; ++object) pixel.Add(HitOf(object));
    EXPECT_EQ(pixel.objects.back().number, 105u);
}

}  // namespace
}  // namespace lull::layers_test
