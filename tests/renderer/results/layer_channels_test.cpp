// Channels of layers, where pixels have samples, none, or a background that is left out; windows of
// EXRs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "renderer/results/channel_names.h"
#include "renderer/results/image_files.h"
#include "renderer/results/layer_channels.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/film/add_sample.h"

namespace lull::layer_channels_test {
namespace {

const PixelRect kPixel = {{3, 4}, {4, 5}};

std::vector<ExrChannel> ChannelsOfFilm(const Film& film) {
    const auto name = [](uint32_t n) { return std::to_string(n); };
    return ChannelsOf({.film = film, .nameOfObject = name, .nameOfMaterial = name}).channels;
}

// With the denoiser's features AOVs are of the same hits, through mirrors and glass.
LayerOptions LayersOf(const std::vector<std::string>& aovs, bool features) {
    LayerOptions options{.aovs = ParseAovs(aovs), .features = features};
    options.aovs.throughSpecular = features;
    return options;
}

// One pixel with its layers.
struct OnePixel {
    Film film;

    explicit OnePixel(const std::vector<std::string>& aovs, bool features = false)
        : film(kPixel, {.layers = LayersOf(aovs, features)}) {}
    void Add(const FirstHit& hit, const Rgb& radiance = Rgb::Zero()) {
        film.layers.Add(kPixel.min, {.index = film.At(kPixel.min).count,
                                     .radiance = radiance,
                                     .hit = hit,
                                     .features = hit});
        AddTo(&film, kPixel.min, radiance);
    }
    float Value(const std::string& channel) const {
        for (const ExrChannel& c : ChannelsOfFilm(film))
            if (c.name == channel) return c.values.at(0);
        ADD_FAILURE() << "no channel " << channel;
        return 0;
    }
};

FirstHit HitAt(float depth, uint32_t object, float offset2) {
    return {.albedo = Rgb(0.5f, 0.25f, 1),
            .normal = Vec3f(0, 0, -1),
            .position = Vec3f(depth, 2, 3),
            .depth = depth,
            .object = object,
            .material = object + 10,
            .found = true,
            .weight = 1,
            .offset2 = offset2};
}

TEST(AovChannels, HasTheChannelsThatAreWanted) {
    const auto names = [](const std::vector<std::string>& layers) {
        std::string text;
        for (const ExrChannel& c : ChannelsOfFilm(OnePixel(layers).film)) text += c.name + " ";
        return text;
    };
    EXPECT_EQ(names({"albedo", "normal"}), "albedo.R albedo.G albedo.B N.X N.Y N.Z ");
    EXPECT_EQ(names({"depth", "position", "object", "material", "noise"}),
              "Z P.X P.Y P.Z objectID materialID noise ");
}

TEST(AovChannels, AveragesOverAllSamplesOrThoseThatMetSomething) {
    OnePixel pixel({"albedo", "normal", "depth", "position", "object", "material"});
    pixel.Add(HitAt(2, 1, 0.3f));
    pixel.Add(HitAt(4, 2, 0.1f));
    pixel.Add({.albedo = Rgb(1, 0, 0), .offset2 = 0.2f});  // the sky
    pixel.Add({.offset2 = 0.4f});
    EXPECT_FLOAT_EQ(pixel.Value("albedo.R"), 0.5f);
    EXPECT_FLOAT_EQ(pixel.Value("albedo.G"), 0.125f);
    EXPECT_FLOAT_EQ(pixel.Value("N.Z"), -0.5f);
    EXPECT_FLOAT_EQ(pixel.Value("Z"), 3);
    EXPECT_FLOAT_EQ(pixel.Value("P.X"), 3);
    EXPECT_FLOAT_EQ(pixel.Value("P.Y"), 2);
    EXPECT_EQ(pixel.Value("objectID"), 2);  // not a mean: that nearest to the centre
    EXPECT_EQ(pixel.Value("materialID"), 12);
}

// A denoiser's halves are added up.
TEST(AovChannels, AreSharedWithTheDenoiser) {
    OnePixel alone({"albedo", "normal", "noise"}), shared({"albedo", "normal", "noise"}, true);
    for (int i = 0; i < 10; ++i)
        for (OnePixel* pixel : {&alone, &shared})
            pixel->Add(HitAt(2, 1, float(i)), Rgb::Constant(float(i)));
    for (const char* channel : {"albedo.G", "N.Z", "noise"})
        EXPECT_NEAR(shared.Value(channel), alone.Value(channel),
                    1e-5f * std::abs(alone.Value(channel)));
    EXPECT_FALSE(PlanesOf(shared.film).contains("albedo and normal"));
    // They outlast what the denoiser alone needs.
    shared.film.layers.ForgetFeatures();
    EXPECT_FLOAT_EQ(shared.Value("N.Z"), -1);
}

TEST(AovChannels, WeighsAsThePixelFilterDoes) {
    OnePixel pixel({"albedo", "depth"});
    FirstHit hit = HitAt(2, 1, 0);
    for (const float weight : {1.25f, 1.25f, 1.25f, -0.75f}) {
        hit.weight = weight;
        hit.albedo = Rgb::Constant(weight > 0 ? 0.8f : 0.4f);
        pixel.Add(hit);
    }
    EXPECT_FLOAT_EQ(pixel.Value("albedo.R"), (3 * 1.25f * 0.8f - 0.75f * 0.4f) / 4);
    EXPECT_FLOAT_EQ(pixel.Value("Z"), 2);
}

TEST(AovChannels, KnowsOfPixelsThatMetNothing) {
    OnePixel pixel({"albedo", "normal", "depth", "position", "object", "material", "noise"});
    EXPECT_EQ(pixel.Value("albedo.R"), 0);  // not even a sample
    EXPECT_EQ(pixel.Value("noise"), 100);
    pixel.Add({});
    EXPECT_EQ(pixel.Value("noise"), 100);
    pixel.Add({});
    EXPECT_EQ(pixel.Value("Z"), kAovFarAway);
    EXPECT_EQ(pixel.Value("P.X"), 0);
    EXPECT_EQ(pixel.Value("objectID"), 0);
    EXPECT_EQ(pixel.Value("noise"), 0);
}

// The deviation of L over many pixels is what the layer says of each.
TEST(AovChannels, NoiseIsTheStandardErrorInLightness) {
    std::mt19937 random(1);
    constexpr int kPixels = 4000, kSamples = 64;
    for (const float mean : {0.004f, 0.2f, 3.f}) {
        std::uniform_real_distribution<float> sample(0.6f * mean, 1.4f * mean);
        double sum = 0, squares = 0, said = 0;
        for (int i = 0; i < kPixels; ++i) {
            OnePixel pixel({"noise"});
            for (int k = 0; k < kSamples; ++k) pixel.Add({}, Rgb::Constant(sample(random)));
            const double y = Luminance(pixel.film.At(kPixel.min).Mean());
            const double L = y > 0.008856 ? 116 * std::cbrt(y) - 16 : 116 * 7.787 * y;
            sum += L;
            squares += L * L;
            said += pixel.Value("noise");
        }
        const double deviation = std::sqrt(squares / kPixels - sum * sum / kPixels / kPixels);
        // A deviation of 4,000 numbers has an error of 1.1 %.
        EXPECT_NEAR(said / kPixels / deviation, 1, 0.05) << mean;
    }
}

const PixelRect kTwoPixels = {{2, 3}, {4, 4}};

// Four samples of the first pixel, one of which sees past everything; none of the second.
struct Lights {
    Film film{kTwoPixels,
              {.layers = {.aovs = {.alpha = true},
                          .groups = {{"lamp", "sky"}, {0, 1}},
                          .groupBackground = true}}};

    Lights() {
        film.SetFirstLook({.spacing = 1, .colours = {Rgb::Constant(9), Rgb::Constant(3)}});
        FilmTile tile = film.Tile({{2, 3}, {3, 4}});
        FilmPixel pixel = tile.At({2, 3});
        for (uint32_t k = 0; k < 4; ++k) {
            GroupRadiance groups(film.layers.Options().groups);
            groups.Clear();
            if (k > 0) groups.Add(0, Rgb(4, 8, 12));
            groups.Add(1, Rgb(2, 2, 2));
            const Rgb radiance = groups.All()[0] + groups.All()[1];
            film.layers.Add({2, 3}, {.groups = &groups,
                                     .index = k,
                                     .radiance = radiance,
                                     .hit = {.found = k > 0, .weight = 1}});
            pixel.Add(radiance, false);
        }
        tile.Set({2, 3}, pixel);
    }
    LayerChannels Make(const DenoisedImage* denoised, bool isTransparent) const {
        return ChannelsOf(*film.layers.Find<LightGroupLayer>(), {film, denoised, isTransparent});
    }
};

TEST(LightGroupChannels, NamesMeansOfTheSamples) {
    const LayerChannels extra = Lights().Make(nullptr, false);
    ASSERT_EQ(extra.channels.size(), 6u);
    EXPECT_EQ(extra.channels[1].name, "light.lamp.G");
    EXPECT_EQ(extra.channels[1].values, (std::vector<float>{6, 0}));
    EXPECT_EQ(extra.channels[3].name, "light.sky.R");
    EXPECT_EQ(extra.channels[3].values, (std::vector<float>{2, 3}));  // the first look
    EXPECT_EQ(std::get<std::string>(extra.attributes.at("lightGroups")), "lamp,sky");
    EXPECT_TRUE(extra.colours.empty());
    // Where the background is left out.
    const LayerChannels alone = Lights().Make(nullptr, true);
    EXPECT_EQ(alone.channels[1].values[0], 6);
    EXPECT_EQ(alone.channels[3].values[0], 1.5f);
}

TEST(LightGroupChannels, SplitsDenoisedLightAsThatOfTheSamples) {
    DenoisedImage denoised{{2, 1, {}}, {}, {}};
    denoised.groups = {{3, 7, 9, 0, 0, 0}, {4, 4, 4, 3, 3, 3}};
    EXPECT_EQ(Lights().Make(&denoised, false).channels[1].values, (std::vector<float>{7, 0}));
    const LayerChannels extra = Lights().Make(&denoised, true);
    EXPECT_EQ(extra.channels[1].values[0], 7);
    EXPECT_EQ(extra.channels[3].values[0], 3);
    EXPECT_EQ(extra.colours, (std::vector<float>{6, 10, 12, 3, 3, 3}));
}

// An image whose data are 1, 2, ... over 3x2 pixels at `origin` of a picture of 4x3.
ExrImage Numbered(const Vec2i& origin) {
    return {3, 2, origin, {4, 3}, {{"R", {1, 2, 3, 4, 5, 6}}}, {}};
}

std::vector<float> Shown(ExrImage image) {
    MoveTo(ShownWindow(image, "a.exr"), &image);
    EXPECT_EQ(DataWindow(image), (PixelRect{{0, 0}, {4, 3}}));
    return image.channels[0].values;
}

TEST(ExrWindows, AreBlackOutsideTheDataAndCutAtThePicture) {
    using Values = std::vector<float>;
    EXPECT_EQ(Shown(Numbered({1, 0})), (Values{0, 1, 2, 3, 0, 4, 5, 6, 0, 0, 0, 0}));
    EXPECT_EQ(Shown(Numbered({-1, -1})), (Values{5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(Shown(Numbered({3, 2})), (Values{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(Shown(Numbered({9, 0})), Values(12));
    EXPECT_EQ(MovedTo({{1, 0}, {2, 2}}, {{0, 0}, {2, 2}}, 2, {1, 2, 3, 4, 5, 6, 7, 8}),
              (Values{3, 4, 7, 8}));
}

TEST(ExrWindows, AreThePartOfOwnRenders) {
    ExrImage image = Numbered({1, 0});
    image.attributes["criterion"] = std::string("fixed:4");
    EXPECT_EQ(ShownWindow(image, "a.exr"), DataWindow(image));
}

TEST(ExrWindows, AreRefusedBeyondAnyMemory) {
    ExrImage image = Numbered({0, 0});
    image.displaySize = {1 << 30, 1 << 30};
    EXPECT_HAS(ErrorOf([&] { ShownWindow(image, "a.exr"); }), "a.exr: its display");
}

}  // namespace
}  // namespace lull::layer_channels_test

// Checks the parts of Cryptomattes.

namespace lull {
namespace {

// Well-known values of the function's 32-bit variant with seed 0.
TEST(Cryptomatte, HashesAsMurmurHash3) {
    EXPECT_EQ(MurmurHash3(""), 0u);
    EXPECT_EQ(MurmurHash3("hello"), 0x248bfa47u);
    EXPECT_EQ(MurmurHash3("hello, world"), 0x149bbb7fu);
    EXPECT_EQ(MurmurHash3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, MakesIdsThatAreUsualFloats) {
    EXPECT_EQ(CryptomatteId("hello"), 0x248bfa47u);
    EXPECT_EQ(CryptomatteId(""), 0x00800000u);
    int changed = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::string name = std::to_string(i);
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(CryptomatteId(name))));
        changed += CryptomatteId(name) != MurmurHash3(name);
    }
    EXPECT_GT(changed, 0);
}

TEST(Cryptomatte, RanksSharesOfNames) {
    MatteLayer mattes({{0, 0}, {1, 1}}, {.aovs = {.cryptomatte = true}});
    const auto add = [&](uint32_t object, int count) {
        for (int i = 0; i < count; ++i)
            mattes.Add({0, 0}, {.hit = {.object = object, .found = object > 0}});
    };
    add(1, 2);
    add(2, 1);
    add(3, 3);
    add(0, 2);
    // The first two are parts of one thing.
    const LayerChannels layers =
        MakeCryptomatte("CryptoObject", mattes, &CryptoPixel::objects,
                        [](uint32_t n) { return n == 3 ? "a \"b\"\xff" : "whole"; });
    ASSERT_EQ(layers.channels.size(), 12u);
    EXPECT_EQ(layers.channels[0].name, "CryptoObject00.R");
    EXPECT_EQ(layers.channels[11].name, "CryptoObject02.A");
    const std::string odd = "a \"b\"\xef\xbf\xbd";  // what is not UTF-8 is replaced
    for (const size_t rank : {0, 1}) EXPECT_EQ(layers.channels[2 * rank + 1].values[0], 3 / 8.f);
    const auto idAt = [&](size_t i) {
        return std::bit_cast<uint32_t>(layers.channels[i].values[0]);
    };
    EXPECT_EQ(std::min(idAt(0), idAt(2)), std::min(CryptomatteId("whole"), CryptomatteId(odd)));
    EXPECT_EQ(std::max(idAt(0), idAt(2)), std::max(CryptomatteId("whole"), CryptomatteId(odd)));
    EXPECT_EQ(layers.channels[4].values[0], 0);
    const std::string prefix =
        "cryptomatte/" + fmt::format("{:08x}", CryptomatteId("CryptoObject")).substr(0, 7);
    EXPECT_EQ(std::get<std::string>(layers.attributes.at(prefix + "/name")), "CryptoObject");
    EXPECT_EQ(std::get<std::string>(layers.attributes.at(prefix + "/manifest")),
              fmt::format("{{\"a \\\"b\\\"\xef\xbf\xbd\":\"{:08x}\",\"whole\":\"{:08x}\"}}",
                          CryptomatteId(odd), CryptomatteId("whole")));
}

}  // namespace
}  // namespace lull
