#include "renderer/lab/metrics/image_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderer/base/color.h"
#include "renderer/base/error.h"
#include "tests/renderer/lab/example_images.h"

namespace lull {
namespace {

RgbImage Even(int width, int height, float value) {
    return {width, height, std::vector<float>(size_t(width) * size_t(height) * 3, value)};
}

// Returns the linear image of which the display image is `srgb`.
RgbImage Linear(const std::vector<uint8_t>& srgb) {
    RgbImage image{kExampleWidth, kExampleHeight, {}};
    for (const uint8_t v : srgb) image.values.push_back(LinearFromSrgb(float(v) / 255));
    return image;
}

TEST(CompareImages, FindsNoErrorInTheSameImage) {
    const RgbImage image = Linear(ExampleImages().image);
    const ErrorFigures f = Average(CompareImages(image, image));
    EXPECT_EQ(f.rmse, 0);
    EXPECT_EQ(f.relMse, 0);
    EXPECT_EQ(f.rmseLightness, 0);
    EXPECT_TRUE(std::isinf(f.psnr));
    EXPECT_NEAR(f.ssim, 1, 1e-6);
    EXPECT_EQ(f.flip, 0);
    EXPECT_EQ(f.visibleDifference, 0);
}

TEST(CompareImages, MeasuresLinearErrors) {
    const ErrorFigures f = Average(CompareImages(Even(20, 20, 0.75f), Even(20, 20, 0.5f)));
    EXPECT_NEAR(f.rmse, 0.25, 1e-7);
    EXPECT_NEAR(f.relMse, 0.0625 / 0.26, 1e-7);
}

// 8-bit values 188 and 225 of linear 0.5 and 0.75; L of luminances 0.5029 and 0.7529.
TEST(CompareImages, MeasuresTheDisplayImage) {
    const ErrorFigures f = Average(CompareImages(Even(20, 20, 0.75f), Even(20, 20, 0.5f)));
    EXPECT_NEAR(f.psnr, 20 * std::log10(255.0 / (225 - 188)), 1e-6);
    const double a = LinearFromSrgb(225 / 255.f), b = LinearFromSrgb(188 / 255.f);
    EXPECT_NEAR(f.rmseLightness, 116 * (std::cbrt(a) - std::cbrt(b)), 1e-3);
}

// scikit-image and the authors' FLIP have computed these of the display images.
TEST(CompareImages, AgreesWithOtherPrograms) {
    const ExampleImages e;
    const ErrorFigures f = Average(CompareImages(Linear(e.image), Linear(e.reference)));
    EXPECT_NEAR(f.psnr, 26.5195325, 1e-5);
    EXPECT_NEAR(f.ssim, 0.9058999, 1e-6);
    EXPECT_NEAR(f.flip, 0.1022064, 2e-5);
    EXPECT_NEAR(f.visibleDifference, 11.37628, 1e-3);
}

TEST(CompareImages, TakesWhatIsNotFiniteAsBlack) {
    RgbImage image = Even(12, 12, 0.f);
    image.values[0] = std::numeric_limits<float>::quiet_NaN();
    image.values[1] = std::numeric_limits<float>::infinity();
    const ErrorFigures f = Average(CompareImages(image, Even(12, 12, 0.f)));
    EXPECT_EQ(f.rmse, 0);
    EXPECT_EQ(f.relMse, 0);
}

TEST(CompareImages, RefusesOtherSizes) {
    EXPECT_THROW(CompareImages(Even(4, 3, 0), Even(3, 4, 0)), Error);
}

TEST(Average, IsOverThePartAskedFor) {
    RgbImage image = Even(40, 20, 0.5f);
    const RgbImage reference = image;
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x)
            for (int c = 0; c < 3; ++c)
                image.values[3 * (size_t(y) * 40 + size_t(x)) + size_t(c)] = 0.7f;
    const ErrorMaps maps = CompareImages(image, reference);
    EXPECT_EQ(Average(maps, {{0, 0}, {20, 20}}).rmse, 0);
    EXPECT_NEAR(Average(maps, {{20, 0}, {40, 20}}).rmse, 0.2, 1e-6);
    EXPECT_NEAR(Average(maps).rmse, 0.2 / std::sqrt(2), 1e-6);
    // At the border there is no window inside the image.
    EXPECT_TRUE(std::isnan(Average(maps, {{0, 0}, {4, 20}}).ssim));
}

}  // namespace
}  // namespace lull
