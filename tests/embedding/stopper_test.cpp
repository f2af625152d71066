// Answers to other programs: the same as lull's own, whatever the layout of their images.
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "stopping/signals/lightness.h"
#include "tests/embedding/stopper_of.h"

extern "C" int lull_header_in_c(void);

namespace lull {
namespace {

TEST(Stopper, IsTheSameInC) { EXPECT_EQ(lull_header_in_c(), 4 + int(sizeof(lull_answer))); }

TEST(Stopper, AnswersAsTheRuleDoes) {
    for (const char* rule :
         {"entropy:3", "lnoise:4", "dammertz:0.05", "fixed:200", "luxtile:0.4", "cycles:0.2"}) {
        const StopperHandle stopper = MakeStopper(SettingsOf(60, 50, rule, 20));
        const auto criterion = MakeCriterion(ParseRule(rule));
        bool stopped = false;
        for (int spp = 20; spp <= 1000 && !stopped; spp += 20) {
            const BlockImage image = ImageAt(spp);
            const Decision expected = criterion->Observe(image.At(spp));
            const lull_answer answer = Show(stopper, PictureOf(image), spp);
            EXPECT_EQ(answer.stop, expected.stop) << rule << spp;
            EXPECT_EQ(answer.checked, expected.checked);
            EXPECT_EQ(answer.value, expected.value);
            EXPECT_EQ(answer.threshold, expected.threshold);
            EXPECT_EQ(answer.votes, expected.votes);
            EXPECT_EQ(answer.spp, spp);
            stopped = answer.stop;
        }
        EXPECT_TRUE(stopped) << rule;
        EXPECT_EQ(lull_stopper_done(stopper.get()), 1);
    }
}

TEST(Stopper, AnswersAsTheDefaultModelDoes) {
    lull_settings settings = SettingsOf(60, 50, nullptr, 20);
    settings.models = LULL_MODELS_DIR;
    const StopperHandle stopper = MakeStopper(settings);
    const Rule factory = ParseRule("learned", {.models = LULL_MODELS_DIR});
    const auto criterion = MakeCriterion(factory);
    lull_answer answer = {};
    for (int spp = 20; spp <= 10000 && !answer.stop; spp += 20) {
        const BlockImage image = ImageAt(spp);
        const Decision expected = criterion->Observe(image.At(spp));
        answer = Show(stopper, PictureOf(image), spp);
        EXPECT_EQ(answer.probability, expected.value) << spp;
        EXPECT_EQ(answer.votes, expected.votes);
        EXPECT_EQ(answer.votes_needed, 3);
        EXPECT_EQ(answer.stop, expected.stop);
        if (answer.checked) {
            EXPECT_EQ(answer.masked_noise, VisibleNoise(image.At(spp)));
        }
    }
    EXPECT_EQ(answer.stop, 1);
}

TEST(Stopper, LooksAtPicturesOfAnySpp) {
    for (const bool isModel : {false, true}) {
        lull_settings settings = SettingsOf(60, 50, isModel ? nullptr : "entropy:3");
        settings.models = LULL_MODELS_DIR;
        const StopperHandle stopper = MakeStopper(settings);
        lull_answer answer = {};
        int last = 0, shown = 0;
        for (int spp = 3; spp < 20000 && !answer.stop; spp += 7 + spp / 5) {
            const bool isLookedAt = last == 0 || spp >= last + 40;
            if (last > 0) {
                EXPECT_EQ(answer.next_spp, last + 40);
            }
            answer = Show(stopper, PictureOf(ImageAt(spp)), spp);
            if (isLookedAt) last = spp;
            EXPECT_LE(answer.checked, isLookedAt) << spp;
            ++shown;
        }
        EXPECT_EQ(answer.stop, 1) << isModel;
        EXPECT_GT(shown, 10);
        EXPECT_EQ(answer.next_spp, 0);
    }
}

TEST(Stopper, ShowsFixedModelsTheirMultiples) {
    lull_settings settings = SettingsOf(60, 50, nullptr);
    settings.models = LULL_MODELS_DIR;
    settings.model = "paper";
    const StopperHandle stopper = MakeStopper(settings);
    EXPECT_EQ(Show(stopper, PictureOf(ImageAt(10)), 10).next_spp, 40);
    for (int spp = 20; spp <= 320; spp += 20)
        EXPECT_EQ(Show(stopper, PictureOf(ImageAt(spp)), spp).checked, spp == 320) << spp;
}

// The same pixels, laid out in other ways.
TEST(Stopper, ReadsAnyStrides) {
    const char* rule = "lnoise:0.1";
    const BlockImage image = ImageAt(40);
    const size_t pixels = size_t(image.width) * size_t(image.height);
    const lull_answer expected = Show(MakeStopper(SettingsOf(60, 50, rule)), PictureOf(image), 40);

    // Planes, each with the last row first and a gap after each row.
    const int gap = 3, row = image.width + gap;
    std::vector<float> planes[2];
    for (int h = 0; h < 2; ++h) {
        planes[h].assign(3 * size_t(row) * size_t(image.height), 1e30f);
        for (size_t i = 0; i < pixels; ++i)
            for (size_t c = 0; c < 3; ++c) {
                const size_t x = i % size_t(image.width), y = i / size_t(image.width);
                planes[h]
                      [(c * size_t(image.height) + (size_t(image.height) - 1 - y)) * size_t(row) +
                       x] = (h ? image.halfMean : image.mean)[3 * i + c];
            }
    }
    lull_image picture = PictureOf(image);
    const size_t lastRow = size_t(image.height - 1) * size_t(row);
    picture.mean = &planes[0][lastRow];
    picture.half = &planes[1][lastRow];
    picture.row_stride = -row * ptrdiff_t(sizeof(float));
    picture.pixel_stride = sizeof(float);
    picture.channel_stride = image.height * row * ptrdiff_t(sizeof(float));
    EXPECT_TRUE(SameAnswer(Show(MakeStopper(SettingsOf(60, 50, rule)), picture, 40), expected));

    // Blue first, with a fourth channel between.
    std::vector<float> bgrx[2];
    for (int h = 0; h < 2; ++h)
        for (size_t i = 0; i < pixels; ++i) {
            const float* rgb = &(h ? image.halfMean : image.mean)[3 * i];
            bgrx[h].insert(bgrx[h].end(), {rgb[2], rgb[1], rgb[0], 1e30f});
        }
    picture = PictureOf(image);
    picture.mean = &bgrx[0][2];
    picture.half = &bgrx[1][2];
    picture.channel_stride = -ptrdiff_t(sizeof(float));
    picture.pixel_stride = 4 * sizeof(float);
    EXPECT_TRUE(SameAnswer(Show(MakeStopper(SettingsOf(60, 50, rule)), picture, 40), expected));
}

TEST(Stopper, TakesEightBitsForTheColoursThatTheyStandFor) {
    // All 256 codes are among them.
    std::vector<uint8_t> codes[2];
    BlockImage linear[2] = {BlockImage(60, 50, 0), BlockImage(60, 50, 0)};
    for (int k = 0; k < 2; ++k) {
        for (size_t i = 0; i < linear[k].mean.size(); ++i) {
            codes[k].push_back(uint8_t((i * i / 7 + i * size_t(k)) % 256));
            const double v = codes[k].back() / 255.0;
            linear[k].mean[i] =
                float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
        }
        std::vector<uint8_t> again(codes[k].size());
        EncodeSrgb8(linear[k].mean, again);
        EXPECT_EQ(again, codes[k]);
    }
    const StopperHandle eight = MakeStopper(SettingsOf(60, 50, "entropy")),
                        real = MakeStopper(SettingsOf(60, 50, "entropy"));
    for (int k = 0; k < 2; ++k) {
        lull_image picture = PictureOf(linear[k], false);
        const lull_answer expected = Show(real, picture, 100 * (k + 1));
        picture.format = LULL_SRGB8;
        picture.mean = codes[k].data();
        const lull_answer answer = Show(eight, picture, 100 * (k + 1));
        EXPECT_TRUE(SameAnswer(answer, expected));
        EXPECT_EQ(answer.checked, k);
        EXPECT_EQ(answer.masked_noise, -1);
    }
}

TEST(Stopper, CountsWhatIsNotFiniteAsBlack) {
    BlockImage black = ImageAt(40), strange = black;
    const float odd[] = {std::numeric_limits<float>::quiet_NaN(),
                         std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity()};
    for (size_t i = 0; i < black.mean.size(); i += 53) {
        black.mean[i] = black.halfMean[i] = 0;
        strange.mean[i] = odd[i % 3];
        strange.halfMean[i] = odd[(i + 1) % 3];
    }
    const lull_answer a = Show(MakeStopper(SettingsOf(60, 50, "lnoise")), PictureOf(black), 40),
                      b = Show(MakeStopper(SettingsOf(60, 50, "lnoise")), PictureOf(strange), 40);
    EXPECT_TRUE(SameAnswer(a, b));
    EXPECT_TRUE(std::isfinite(a.value));
}

TEST(Stopper, CutsPicturesIntoTheBlocksOfRenders) {
    struct Case {
        int width, height, block, columns, rows, lastWidth, lastHeight;
    };
    for (const Case& c : {Case{1920, 1080, 0, 10, 6, 120, 80}, Case{239, 240, 0, 2, 2, 39, 40},
                          Case{40, 40, 0, 1, 1, 40, 40}, Case{500, 300, 65536, 1, 1, 500, 300},
                          Case{100, 90, 40, 3, 3, 20, 10}}) {
        lull_settings settings = SettingsOf(c.width, c.height, "fixed:1");
        settings.block = c.block;
        const StopperHandle stopper = MakeStopper(settings);
        ASSERT_EQ(lull_stopper_column_count(stopper.get()), c.columns);
        ASSERT_EQ(lull_stopper_block_count(stopper.get()), c.columns * c.rows);
        std::vector<int> covered(size_t(c.width) * size_t(c.height));
        lull_rect rect = {};
        for (int i = 0; i < c.columns * c.rows; ++i) {
            ASSERT_EQ(lull_stopper_block_rect(stopper.get(), i, &rect), LULL_OK);
            for (int y = rect.y; y < rect.y + rect.height; ++y)
                for (int x = rect.x; x < rect.x + rect.width; ++x)
                    ++covered[size_t(y) * size_t(c.width) + size_t(x)];
        }
        EXPECT_EQ(rect.width, c.lastWidth);
        EXPECT_EQ(rect.height, c.lastHeight);
        EXPECT_EQ(covered, std::vector<int>(covered.size(), 1));
    }
}

// The block at the right is 30 pixels wide, and noisier.
TEST(Stopper, LetsSmallBlocksFollowTheirNeighbour) {
    lull_settings settings = SettingsOf(90, 60, "lnoise:5");
    settings.block = 60;
    const StopperHandle whole = MakeStopper(settings), pieces = MakeStopper(settings);
    const StopperHandle alone = MakeStopper(SettingsOf(60, 60, "lnoise:5"));
    bool hasStopped = false;
    for (int spp = 20; spp <= 400 && !hasStopped; spp += 20) {
        const BlockImage image = ImageAt(spp, 60, 60);
        BlockImage wider(90, 60, 0.5f);
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 90; ++x)
                for (int c = 0; c < 3; ++c) {
                    wider.Mean(x, y)[c] = x < 60 ? image.mean[size_t(3 * (60 * y + x) + c)] : 0.5f;
                    wider.HalfMean(x, y)[c] =
                        x < 60 ? image.halfMean[size_t(3 * (60 * y + x) + c)] : float(x % 2);
                }
        lull_answer answers[2], piece;
        const lull_image picture = PictureOf(wider);
        ASSERT_EQ(lull_stopper_observe(whole.get(), &picture, spp, answers), LULL_OK);
        EXPECT_TRUE(SameAnswer(answers[0], answers[1]));
        EXPECT_TRUE(SameAnswer(answers[0], Show(alone, PictureOf(image), spp)));
        for (const int block : {0, 1}) {
            lull_image part = picture;
            part.width = block == 0 ? 60 : 30;
            part.row_stride = 90 * 3 * sizeof(float);
            part.mean = wider.Mean(60 * block, 0);
            part.half = wider.HalfMean(60 * block, 0);
            ASSERT_EQ(lull_stopper_observe_block(pieces.get(), block, &part, spp, &piece), LULL_OK);
            EXPECT_TRUE(SameAnswer(piece, answers[0])) << block;
        }
        hasStopped = answers[0].stop;
        EXPECT_EQ(lull_stopper_done(whole.get()), answers[0].stop);
    }
    EXPECT_TRUE(hasStopped);
    // It is saved and restored as the other is.
    const std::vector<char> state = SavedState(whole);
    const StopperHandle restored = MakeStopper(settings);
    ASSERT_EQ(lull_stopper_restore(restored.get(), state.data(), state.size()), LULL_OK);
    EXPECT_EQ(lull_stopper_done(restored.get()), 1);
}

TEST(Stopper, TakesLargePictures) {
    lull_settings settings = SettingsOf(65536, 8192, "entropy");
    settings.block = 64;
    const StopperHandle stopper = MakeStopper(settings);
    EXPECT_EQ(lull_stopper_block_count(stopper.get()), 1024 * 128);
    EXPECT_EQ(lull_stopper_done(stopper.get()), 0);
}

// Half of the image has no noise, and stops first; then its pixels are not read.
TEST(Stopper, StopsEachBlockByItself) {
    lull_settings settings = SettingsOf(100, 50, "lnoise:1");
    settings.block = 50;
    const StopperHandle whole = MakeStopper(settings), pieces = MakeStopper(settings);
    for (int spp = 20; spp <= 100; spp += 20) {
        BlockImage image = ImageAt(spp, 100, 50, 1);
        for (int y = 0; y < 50; ++y)
            for (int i = 0; i < 150; ++i)
                image.Mean(0, y)[i] = image.HalfMean(0, y)[i] = spp > 60 ? float(i % 7) : 0.3f;
        lull_answer answers[2], piece;
        const lull_image picture = PictureOf(image);
        ASSERT_EQ(lull_stopper_observe(whole.get(), &picture, spp, answers), LULL_OK);
        EXPECT_EQ(answers[0].stop, spp >= 60);
        EXPECT_EQ(answers[0].spp, std::min(spp, 60));
        EXPECT_EQ(answers[0].checked, spp <= 60);
        EXPECT_EQ(answers[1].stop, 0);
        for (int block = 0; block < 2; ++block) {
            lull_image part = picture;
            part.width = 50;
            part.row_stride = 100 * 3 * sizeof(float);
            part.mean = image.Mean(50 * block, 0);
            part.half = image.HalfMean(50 * block, 0);
            if (answers[block].stop && spp > 60) part.mean = part.half = &part;  // not to be read
            ASSERT_EQ(lull_stopper_observe_block(pieces.get(), block, &part, spp, &piece), LULL_OK);
            EXPECT_TRUE(SameAnswer(piece, answers[block]));
            ASSERT_EQ(lull_stopper_answer(pieces.get(), block, &piece), LULL_OK);
            EXPECT_TRUE(SameAnswer(piece, answers[block]));
        }
    }
    EXPECT_EQ(lull_stopper_done(whole.get()), 0);
}

TEST(Stopper, AnswersAnyNumberOfThreadsTheSame) {
    lull_settings settings = SettingsOf(200, 200, "entropy:3");
    settings.block = 50;
    const StopperHandle together = MakeStopper(settings), apart = MakeStopper(settings);
    std::vector<lull_answer> answers(16);
    for (int spp = 50; spp <= 250; spp += 50) {
        const BlockImage image = ImageAt(spp, 200, 200);
        const lull_image picture = PictureOf(image, false);
        ASSERT_EQ(lull_stopper_observe(together.get(), &picture, spp, answers.data()), LULL_OK);
        std::vector<std::thread> threads;
        for (int t = 0; t < 3; ++t)
            threads.emplace_back([&, t] {
                for (int i = t; i < 16; i += 3) {
                    lull_rect rect;
                    lull_stopper_block_rect(apart.get(), i, &rect);
                    lull_image part = picture;
                    part.width = rect.width;
                    part.height = rect.height;
                    part.row_stride = 200 * 3 * sizeof(float);
                    part.mean = &image.mean[size_t(3 * (rect.y * 200 + rect.x))];
                    EXPECT_EQ(lull_stopper_observe_block(apart.get(), i, &part, spp, nullptr),
                              LULL_OK);
                    lull_stopper_done(apart.get());
                }
            });
        for (std::thread& thread : threads) thread.join();
        for (int i = 0; i < 16; ++i) {
            lull_answer answer;
            ASSERT_EQ(lull_stopper_answer(apart.get(), i, &answer), LULL_OK);
            EXPECT_TRUE(SameAnswer(answer, answers[size_t(i)])) << i;
        }
    }
    EXPECT_EQ(answers[0].checked, 1);
}

}  // namespace
}  // namespace lull
