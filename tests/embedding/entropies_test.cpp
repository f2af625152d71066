// Entropies, attributes and warnings by the C interface.
#include <array>

#include "stopping/signals/attributes26.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/svd_entropy.h"
#include "tests/embedding/stopper_of.h"

namespace lull {
namespace {

TEST(Entropies, AreThoseOfTheLibrary) {
    const BlockImage image = ImageAt(40, 60, 50);
    const lull_image picture = PictureOf(image, false);
    std::array<lull_entropy, 25> entropies;
    ASSERT_EQ(lull_svd_entropy(&picture, 25, entropies.data()), LULL_OK) << lull_error_message();
    const std::vector<double> lightness = LightnessOf(image.mean);
    const std::vector<SvdEntropy> expected = SubBlockEntropies(lightness, 60, 50, 25);
    for (size_t i = 0; i < 25; ++i) {
        EXPECT_EQ(entropies[i].h, expected[i].h);
        EXPECT_EQ(entropies[i].h1, expected[i].h1);
        EXPECT_EQ(entropies[i].h2, expected[i].h2);
    }
    std::array<double, kAttributes> attributes;
    ASSERT_EQ(lull_attributes26(&picture, attributes.data()), LULL_OK);
    EXPECT_EQ(attributes, ComputeAttributes(lightness, 60, 50));
}

TEST(Entropies, RefuseWhatTheyCannotMeasure) {
    const BlockImage image = ImageAt(40);
    lull_image picture = PictureOf(image);
    std::array<lull_entropy, 100> entropies;
    double attributes[26];
    for (const int parts : {0, -4, 99}) {
        EXPECT_EQ(lull_svd_entropy(&picture, parts, entropies.data()), LULL_BAD_ARGUMENT);
        EXPECT_HAS(lull_error_message(), "square number");
    }
    EXPECT_EQ(lull_svd_entropy(nullptr, 4, entropies.data()), LULL_BAD_ARGUMENT);
    EXPECT_EQ(lull_svd_entropy(&picture, 4, nullptr), LULL_BAD_ARGUMENT);
    EXPECT_EQ(lull_attributes26(&picture, nullptr), LULL_BAD_ARGUMENT);
    picture.width = 4;
    EXPECT_EQ(lull_attributes26(&picture, attributes), LULL_BAD_ARGUMENT);
    picture.width = 0;
    EXPECT_EQ(lull_svd_entropy(&picture, 1, entropies.data()), LULL_BAD_ARGUMENT);
    picture = PictureOf(image);
    picture.mean = nullptr;
    EXPECT_EQ(lull_svd_entropy(&picture, 1, entropies.data()), LULL_BAD_ARGUMENT);
}

TEST(Warnings, TellOfPicturesTooFarApart) {
    lull_settings settings = SettingsOf(60, 50, nullptr);
    settings.model = "entropy";
    settings.models = LULL_MODELS_DIR;
    const StopperHandle doubling = MakeStopper(settings), nearer = MakeStopper(settings);
    EXPECT_STREQ(lull_stopper_warning(doubling.get()), "");
    EXPECT_STREQ(lull_stopper_warning(nullptr), "");
    for (int spp = 64; spp <= 1024; spp *= 2) Show(doubling, PictureOf(ImageAt(spp), false), spp);
    EXPECT_HAS(lull_stopper_warning(doubling.get()),
               "images at 64, 128 and 256 spp lie too far apart")
        << lull_stopper_warning(doubling.get());
    for (double spp = 64; spp <= 1024; spp *= 1.4)
        Show(nearer, PictureOf(ImageAt(int(spp)), false), int(spp));
    EXPECT_STREQ(lull_stopper_warning(nearer.get()), "");
}

TEST(Warnings, TellOfAFourthChannel) {
    const std::vector<float> rgba(60 * 50 * 4, 0.5f);
    lull_image picture = {};
    picture.width = 60, picture.height = 50;
    picture.mean = rgba.data();
    picture.pixel_stride = 4 * sizeof(float);
    const StopperHandle stopper = MakeStopper(SettingsOf(60, 50, "entropy"));
    Show(stopper, picture, 40);
    EXPECT_HAS(lull_stopper_warning(stopper.get()), "fourth channel");
}

TEST(Pictures, HaveRowsThatDoNotOverlap) {
    const std::vector<float> pixels(60 * 50 * 3, 0.5f);
    lull_image picture = {};
    picture.width = 60, picture.height = 50;
    picture.mean = pixels.data();
    const StopperHandle stopper = MakeStopper(SettingsOf(60, 50, "entropy"));
    picture.row_stride = 60 * 3;  // in values, not bytes
    lull_answer answer;
    EXPECT_EQ(lull_stopper_observe(stopper.get(), &picture, 40, &answer), LULL_BAD_ARGUMENT);
    EXPECT_HAS(lull_error_message(), "row_stride is 180 bytes") << lull_error_message();
    // Upside down, and by columns.
    picture.row_stride = -ptrdiff_t(60 * 3 * sizeof(float));
    picture.mean = pixels.data() + 49 * 60 * 3;
    EXPECT_EQ(lull_stopper_observe(stopper.get(), &picture, 40, &answer), LULL_OK);
    picture.mean = pixels.data();
    picture.row_stride = 3 * sizeof(float);
    picture.pixel_stride = 50 * 3 * sizeof(float);
    EXPECT_EQ(lull_stopper_observe(stopper.get(), &picture, 80, &answer), LULL_OK)
        << lull_error_message();
}

}  // namespace
}  // namespace lull
