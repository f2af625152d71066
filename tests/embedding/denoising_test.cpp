// Calls the C interface of the denoiser as a program in C++ would.
#include <gtest/gtest.h>
#include <lull/lull.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "tests/expect_has.h"

namespace lull::denoising_test {
namespace {

constexpr int kWidth = 80, kHeight = 60;
constexpr size_t kPixels = size_t(kWidth) * kHeight;

struct Pictures {
    std::vector<float> truth, a, b, albedo;
    std::vector<float> clean = std::vector<float>(3 * kPixels, -1), error = clean;
    lull_block_error block = {10, 5, 60, 50, -1, -1};
    lull_noisy_image noisy = {};
    lull_denoised_image output = {clean.data(), error.data(), &block, 1};

    Pictures() {
        std::mt19937 generator(1);
        std::normal_distribution<float> gauss(0, 0.08f);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c) {
                    albedo.push_back((x / 15 + y / 15 + c) % 2 ? 0.8f : 0.3f);
                    truth.push_back(albedo.back() * (0.3f + 0.005f * float(x)));
                    a.push_back(std::max(0.f, truth.back() + gauss(generator)));
                    b.push_back(std::max(0.f, truth.back() + gauss(generator)));
                }
        noisy.width = kWidth;
        noisy.height = kHeight;
        noisy.colour = {a.data(), b.data(), 0, 0, 0};
        noisy.albedo = {albedo.data(), nullptr, 0, 0, 0};
    }
    Pictures(const Pictures&) = delete;
    Pictures& operator=(const Pictures&) = delete;
};

double Rms(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - double(b[i]), 2);
    return std::sqrt(sum / double(a.size()));
}

TEST(Denoising, TakesNoiseOutAndSaysHowMuchIsLeft) {
    Pictures p;
    ASSERT_EQ(lull_denoise(&p.noisy, &p.output), LULL_OK);
    std::vector<float> mean;
    for (size_t i = 0; i < p.a.size(); ++i) mean.push_back((p.a[i] + p.b[i]) / 2);
    EXPECT_LT(Rms(p.clean, p.truth), Rms(mean, p.truth) / 4);
    EXPECT_GE(p.block.estimate, 0);
    EXPECT_GE(p.block.upper, p.block.estimate);
    EXPECT_LT(p.block.upper, 3);  // of the samples: some 10
    for (size_t i = 0; i < kPixels; ++i) ASSERT_TRUE(p.error[i] >= 0 && p.error[i] < 20);

    // Structure in the albedo is not blurred; without it the error is larger, and known to be.
    Pictures without;
    without.noisy.albedo = {};
    ASSERT_EQ(lull_denoise(&without.noisy, &without.output), LULL_OK);
    EXPECT_GT(Rms(without.clean, p.truth), 1.5 * Rms(p.clean, p.truth));
    EXPECT_GT(without.block.upper, p.block.upper);
}

TEST(Denoising, ReadsAnyLayout) {
    Pictures plain, other;
    ASSERT_EQ(lull_denoise(&plain.noisy, &plain.output), LULL_OK);

    // Channel by channel, from the bottom up, and only the image wanted.
    const auto turned = [](const std::vector<float>& image) {
        std::vector<float> planes(image.size());
        for (size_t c = 0; c < 3; ++c)
            for (size_t y = 0; y < kHeight; ++y)
                for (size_t x = 0; x < kWidth; ++x)
                    planes[c * kPixels + (kHeight - 1 - y) * kWidth + x] =
                        image[3 * (y * kWidth + x) + c];
        return planes;
    };
    const std::vector<float> a = turned(other.a), b = turned(other.b),
                             albedo = turned(other.albedo);
    constexpr size_t last = kPixels - kWidth;
    constexpr ptrdiff_t row = -ptrdiff_t(kWidth * sizeof(float)), plane = kPixels * sizeof(float);
    other.noisy.colour = {&a[last], &b[last], row, sizeof(float), plane};
    other.noisy.albedo = {&albedo[last], nullptr, row, sizeof(float), plane};
    other.output.error = nullptr;
    other.output.blocks = nullptr;
    other.output.block_count = 0;
    ASSERT_EQ(lull_denoise(&other.noisy, &other.output), LULL_OK);
    EXPECT_EQ(other.clean, plain.clean);
}

TEST(Denoising, SurvivesNonsense) {
    Pictures p;
    p.a[5] = std::numeric_limits<float>::quiet_NaN();
    p.b[700] = std::numeric_limits<float>::infinity();
    p.albedo[9] = -std::numeric_limits<float>::infinity();
    std::vector<float> depth(kPixels, 0);
    depth[3] = -1;
    depth[4] = std::numeric_limits<float>::quiet_NaN();
    depth[5] = std::numeric_limits<float>::infinity();
    p.noisy.depth = {depth.data(), nullptr, 0, 0, 0};
    ASSERT_EQ(lull_denoise(&p.noisy, &p.output), LULL_OK);
    for (const float v : p.clean) ASSERT_TRUE(v >= 0 && std::isfinite(v));
    EXPECT_TRUE(std::isfinite(p.block.upper));
}

TEST(Denoising, SaysWhatIsWrong) {
    const std::pair<const char*, std::function<void(Pictures*)>> cases[] = {
        {"0x60", [](Pictures* p) { p->noisy.width = 0; }},
        {"65537", [](Pictures* p) { p->noisy.height = 65537; }},
        {"both halves", [](Pictures* p) { p->noisy.colour.b = nullptr; }},
        {"the same colours", [](Pictures* p) { p->noisy.colour.b = p->noisy.colour.a; }},
        {"the same colours", [](Pictures* p) { p->b = p->a; }},
        {"the same noise",
         [](Pictures* p) {
             std::mt19937 generator(2);
             std::normal_distribution<float> gauss(0.4f, 0.1f);
             for (size_t i = 0; i < 3 * kPixels; ++i)
                 p->a[i] = std::abs(gauss(generator)), p->b[i] = 1.001f * p->a[i];
         }},
        {"all in the first",
         [](Pictures* p) {
             for (size_t i = 0; i < 3 * kPixels; ++i) p->b[i] = (p->a[i] + p->b[i]) / 2;
         }},
        {"first half: 100 % of the pixels are brighter",
         [](Pictures* p) {
             for (float& v : p->a) v *= 255;
         }},
        {"second half: 100 % of the pixels have values that are not finite",
         [](Pictures* p) { p->b.assign(3 * kPixels, std::numeric_limits<float>::quiet_NaN()); }},
        {"negative",
         [](Pictures* p) {
             for (float& v : p->b) v -= 0.4f;
         }},
        {"albedo", [](Pictures* p) { std::swap(p->noisy.albedo.a, p->noisy.albedo.b); }},
        {"room", [](Pictures* p) { p->output.colour = nullptr; }},
        {"block 0", [](Pictures* p) { p->block.x = kWidth - 59; }},
        {"block 0", [](Pictures* p) { p->block.height = 9; }},
        {"block 0", [](Pictures* p) { p->block.width = std::numeric_limits<int>::max(); }},
        {"-1 blocks", [](Pictures* p) { p->output.block_count = -1; }}};
    for (const auto& [expected, spoil] : cases) {
        Pictures p;
        spoil(&p);
        ASSERT_EQ(lull_denoise(&p.noisy, &p.output), LULL_BAD_ARGUMENT) << expected;
        EXPECT_HAS(lull_error_message(), expected);
        EXPECT_EQ(p.clean, std::vector<float>(3 * kPixels, -1));
        EXPECT_EQ(p.block.upper, -1);
    }
    EXPECT_EQ(lull_denoise(nullptr, nullptr), LULL_BAD_ARGUMENT);
}

}  // namespace
}  // namespace lull::denoising_test
