#include "renderer/film/layers.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lull::layers_test {
namespace {

const PixelRect kRegion = {{3, 5}, {43, 31}};

// A film with all layers.
struct Planes {
    Film film;
    AovFilm aovs{kRegion, {.depth = true}};
    FeatureFilm features{kRegion};
    MatteFilm mattes{kRegion, true};
    LightGroupFilm lights{kRegion, {{"a", "rest"}, {0, 1}}, {true, true}};

    explicit Planes(bool withHalf = true)
        : film(kRegion, {.grid = {.blockSize = 20, .tileSize = 8}, .withHalf = withHalf}) {}
    Layers TheLayers() {
        return {.aovs = &aovs, .features = &features, .mattes = &mattes, .lights = &lights};
    }
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
                GroupRadiance groups(lights.Groups());
                groups.Clear();
                groups.Add(0, radiance / 4);
                groups.Add(1, radiance / 2);
                groups.Add(1, radiance / 4);
                TheLayers().Add({x, y}, pixel.count, hit, radiance, &groups);
                pixel.Add(radiance, x % 3 == 0);
                tile.Set({x, y}, pixel);
            }
    }
    std::vector<std::byte> Bytes(const PixelRect& pixels) {
        StateWriter writer;
        PutPlanes(film, TheLayers(), pixels, &writer);
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
    EXPECT_EQ(bytes.size(), 400u * (24 + 24 + 104 + 60 + 40 + 128 + 2 * 80) + 9 * 8);
    StateReader reader(bytes);
    GetPlanes(&reader, kBlock, &to.film, to.TheLayers());
    EXPECT_NO_THROW(reader.Finish());
    EXPECT_EQ(to.Bytes(kRegion), from.Bytes(kRegion));  // nothing is anywhere else
    EXPECT_EQ(to.film.SampleCount(), 4 * 400 + 16);
    EXPECT_EQ(to.film.RejectedCount(), from.film.RejectedCount());
    EXPECT_EQ(to.film.At({41, 23}).sum, (std::array<double, 3>{205, 115, 5}));
    EXPECT_EQ(to.lights.At(1, {41, 23}, 5).sum, (std::array<double, 3>{153.75, 86.25, 3.75}));
    EXPECT_EQ(to.lights.At(1, {41, 23}, 5).halfSum, (std::array<double, 3>{61.5, 34.5, 1.5}));
}

TEST(Planes, ReplaceWhatWasThere) {
    Planes planes;
    planes.AddTo(kTile);
    const std::vector<std::byte> before = planes.Bytes(kRegion);
    const std::vector<std::byte> tile = planes.Bytes(kTile);
    planes.AddTo(kTile);
    EXPECT_NE(planes.Bytes(kRegion), before);
    StateReader reader(tile);
    GetPlanes(&reader, kTile, &planes.film, planes.TheLayers());
    EXPECT_EQ(planes.Bytes(kRegion), before);
}

TEST(Planes, AreThoseThatThereAre) {
    Planes planes(false);
    planes.AddTo(kTile);
    StateWriter writer;
    PutPlanes(planes.film, {.features = &planes.features}, kTile, &writer);
    EXPECT_EQ(writer.bytes.size(), 16u * (24 + 60) + 8);
    std::string names;
    ForEachPlane(
        planes.film, {.mattes = &planes.mattes}, kTile,
        [&](const std::string& name, const auto&, const PixelRect&) { names += name + " "; });
    EXPECT_EQ(names, "tiles sums alpha crypto ");
    names = "";
    ForEachPlane(
        planes.film, {.lights = &planes.lights}, kTile,
        [&](const std::string& name, const auto&, const PixelRect&) { names += name + " "; });
    EXPECT_EQ(names,
              "tiles sums light_00 light_00_noise light_00_background light_01 light_01_noise "
              "light_01_background ");
}

TEST(Planes, AreNotReadFromTooFewBytes) {
    Planes planes;
    std::vector<std::byte> bytes = planes.Bytes(kTile);
    bytes.pop_back();
    StateReader reader(bytes);
    EXPECT_THROW(GetPlanes(&reader, kTile, &planes.film, planes.TheLayers()), std::runtime_error);
}

}  // namespace
}  // namespace lull::layers_test
