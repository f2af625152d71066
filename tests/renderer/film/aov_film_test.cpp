#include "renderer/film/aov_channels.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/film/add_sample.h"

namespace lull {
namespace {

const PixelRect kPixel = {{3, 4}, {4, 5}};

// One pixel with its layers.
struct OnePixel {
    Film film{kPixel};
    AovFilm aovs;

    explicit OnePixel(const std::vector<std::string>& layers) : aovs(kPixel, ParseAovs(layers)) {}
    void Add(const FirstHit& hit, const Rgb& radiance = Rgb::Zero()) {
        AddTo(&film, kPixel.min, radiance);
        aovs.At(kPixel.min).Add(hit, radiance);
    }
    float Value(const std::string& channel) const {
        for (const ExrChannel& c : MakeAovChannels(aovs, film))
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

TEST(AovSet, HasNames) {
    EXPECT_EQ(
        NameOf(ParseAovs({"noise", "albedo", "normal", "depth", "position", "object", "material"})),
        "albedo,normal,depth,position,object,material,noise");
    EXPECT_TRUE(ParseAovs({"depth"}).FirstHits());
    EXPECT_FALSE(ParseAovs({"noise"}).FirstHits());
    EXPECT_TRUE(ParseAovs({"noise"}).Any());
    EXPECT_FALSE(AovSet().Any());
    for (const char* bad : {"", "Albedo", "albedo normal", "albedo,noise"})
        EXPECT_TRUE(Contains(ErrorOf([&] {
                                 ParseAovs({"depth", bad});
                             }),
                             "there is no layer"))
            << bad;
}

TEST(AovFilm, HasTheChannelsThatAreWanted) {
    const auto names = [](const std::vector<std::string>& layers) {
        std::string text;
        const OnePixel pixel(layers);
        for (const ExrChannel& c : MakeAovChannels(pixel.aovs, pixel.film)) text += c.name + " ";
        return text;
    };
    EXPECT_EQ(names({"albedo", "normal"}), "albedo.R albedo.G albedo.B N.X N.Y N.Z ");
    EXPECT_EQ(names({"depth", "position", "object", "material", "noise"}),
              "Z P.X P.Y P.Z objectID materialID noise ");
}

TEST(AovFilm, AveragesOverAllSamplesOrThoseThatMetSomething) {
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

TEST(AovFilm, WeighsAsThePixelFilterDoes) {
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

TEST(AovFilm, KnowsOfPixelsThatMetNothing) {
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
TEST(AovFilm, NoiseIsTheStandardErrorInLightness) {
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

}  // namespace
}  // namespace lull
