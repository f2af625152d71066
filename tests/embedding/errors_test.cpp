// Errors have a message, and change nothing.
#include <cstdlib>
#include <limits>
#include <thread>

#include "tests/embedding/stopper_of.h"

namespace lull {
namespace {

TEST(StopperErrors, RefusesBadSettings) {
    struct Case {
        lull_settings settings;
        lull_status status;
        const char* part;
    };
    std::vector<Case> cases;
    auto add = [&](lull_status status, const char* part) -> lull_settings& {
        cases.push_back({SettingsOf(100, 100, "entropy"), status, part});
        return cases.back().settings;
    };
    add(LULL_BAD_ARGUMENT, "39x100").width = 39;
    add(LULL_BAD_ARGUMENT, "100x0").height = 0;
    add(LULL_BAD_ARGUMENT, "65536").width = std::numeric_limits<int>::max();
    add(LULL_BAD_ARGUMENT, "blocks of 39").block = 39;
    add(LULL_BAD_ARGUMENT, "blocks of -1").block = -1;
    add(LULL_BAD_ARGUMENT, "pass").pass = -20;
    add(LULL_BAD_ARGUMENT, "cap").cap = -1;
    add(LULL_BAD_ARGUMENT, "caution").caution = std::numeric_limits<double>::quiet_NaN();
    add(LULL_BAD_ARGUMENT, "caution").caution = -1;
    add(LULL_BAD_ARGUMENT, "caution must be from 0.01 to 100").caution = 1e9;
    add(LULL_BAD_ARGUMENT, "pass is 33554432").pass = 1 << 25;
    add(LULL_BAD_ARGUMENT, "16777216 spp").cap = std::numeric_limits<int>::max();
    add(LULL_BAD_ARGUMENT, "both").model = "entropy";
    add(LULL_BAD_ARGUMENT, "there is no such rule").rule = "hunch";
    add(LULL_BAD_ARGUMENT, "'-3' is not a threshold").rule = "entropy:-3";
    add(LULL_BAD_FILE, "nowhere.h5").rule = "learned:nowhere.h5";
    add(LULL_BAD_FILE, "nowhere.csv").rule = "thresholds:nowhere.csv";
    lull_settings& unknown = add(LULL_BAD_FILE, "there are entropy, paper");
    unknown.rule = nullptr;
    unknown.model = "unknown";
    unknown.models = LULL_MODELS_DIR;
    lull_settings& pass = add(LULL_BAD_FILE, "multiples of the pass of 30 spp");
    pass.rule = nullptr;
    pass.models = LULL_MODELS_DIR;
    pass.pass = 30;
    for (const Case& c : cases) {
        lull_stopper* stopper = reinterpret_cast<lull_stopper*>(&cases);
        ExpectError(c.status, lull_stopper_create(&c.settings, &stopper), c.part);
        EXPECT_EQ(stopper, nullptr);
    }
}

TEST(StopperErrors, RefusesBadPicturesAndChangesNothing) {
    const StopperHandle stopper = MakeStopper(SettingsOf(60, 50, "lnoise:9")),
                        undisturbed = MakeStopper(SettingsOf(60, 50, "lnoise:9"));
    for (int spp = 20; spp <= 60; spp += 20) {
        const BlockImage image = ImageAt(spp);
        const lull_image good = PictureOf(image);
        auto refuse = [&](lull_image picture, int atSpp, const std::string& part) {
            lull_answer answer = {};
            answer.votes = 77;
            ExpectError(LULL_BAD_ARGUMENT,
                        lull_stopper_observe(stopper.get(), &picture, atSpp, &answer), part);
            ExpectError(LULL_BAD_ARGUMENT,
                        lull_stopper_observe_block(stopper.get(), 0, &picture, atSpp, &answer),
                        part);
            EXPECT_EQ(answer.votes, 77);
        };
        const std::vector<float> copy = image.mean;
        std::pair<lull_image, const char*> bad[] = {{good, "59x50"},
                                                    {good, "LULL_SRGB8"},
                                                    {good, "mean is null"},
                                                    {good, "half buffer"},
                                                    {good, "the half buffer equals the mean"},
                                                    {good, "the half buffer equals the mean"}};
        bad[0].first.width = 59;
        bad[1].first.format = 7;
        bad[2].first.mean = nullptr;
        bad[3].first.half = nullptr;
        bad[4].first.half = good.mean;
        bad[5].first.half = copy.data();
        for (const auto& [picture, part] : bad) refuse(picture, spp, part);
        refuse(good, 0, "above 0");
        refuse(good, spp - 20, spp == 20 ? "above 0" : "spp must increase");
        ExpectError(LULL_BAD_ARGUMENT,
                    lull_stopper_observe_block(stopper.get(), 1, &good, spp, nullptr),
                    "there is no block 1");
        EXPECT_TRUE(SameAnswer(Show(stopper, good, spp), Show(undisturbed, good, spp)));
    }
    EXPECT_EQ(lull_stopper_done(stopper.get()), 1);
    EXPECT_EQ(lull_stopper_needs_half(stopper.get()), 1);
    EXPECT_EQ(lull_stopper_needs_half(MakeStopper(SettingsOf(60, 50, "entropy")).get()), 0);
}

TEST(StopperErrors, RefusesValuesThatNoPictureHas) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    BlockImage calm = ImageAt(4000, 120, 50);
    lull_settings settings = SettingsOf(120, 50, "entropy:9");
    settings.block = 60;
    const StopperHandle stopper = MakeStopper(settings),
                        undisturbed = MakeStopper(SettingsOf(60, 50, "entropy:9"));
    std::vector<float> original = calm.mean;
    const auto refuse = [&](const char* part) {
        lull_answer answers[2] = {};
        const lull_image picture = PictureOf(calm);
        ExpectError(LULL_BAD_ARGUMENT, lull_stopper_observe(stopper.get(), &picture, 40, answers),
                    part);
        calm.mean = original;
    };
    for (float& v : calm.mean) v *= 255;
    refuse("brighter than 4 times");
    for (size_t i = 0; i < calm.mean.size(); ++i)
        if (i / 3 % 120 >= 60) calm.mean[i] = nan;
    refuse("block 1: 100 % of the pixels have values that are not finite");
    for (float& v : calm.mean) v -= 1;
    refuse("negative");
    std::vector<float> half = calm.halfMean;
    calm.halfMean.assign(half.size(), nan);
    refuse("not finite");
    calm.halfMean = half;
    // A few such values are black, and a block may be a window; nothing has changed.
    calm.mean[5] = nan;
    for (size_t i = 0; i < calm.mean.size(); ++i)
        if (i / 3 % 120 >= 80) calm.mean[i] *= 100;
    lull_answer answers[2] = {};
    const lull_image picture = PictureOf(calm);
    EXPECT_EQ(lull_stopper_observe(stopper.get(), &picture, 40, answers), LULL_OK)
        << lull_error_message();
    EXPECT_EQ(answers[1].spp, 40);
    BlockImage bright = ImageAt(4000);
    for (std::vector<float>* image : {&bright.mean, &bright.halfMean})
        for (float& v : *image) v *= 100;
    const lull_image window = PictureOf(bright);
    lull_answer answer = {};
    EXPECT_EQ(lull_stopper_observe_block(undisturbed.get(), 0, &window, 40, &answer), LULL_OK)
        << lull_error_message();
}

TEST(StopperErrors, RefusesNullPointers) {
    const StopperHandle owner = MakeStopper(SettingsOf(60, 50, "entropy"));
    lull_stopper *stopper = owner.get(), *made = nullptr;
    const BlockImage image = ImageAt(20);
    const lull_image picture = PictureOf(image);
    const lull_settings settings = SettingsOf(60, 50, "entropy");
    lull_rect rect;
    lull_answer answer;
    size_t size = 0;
    char byte = 0;
    for (const lull_status status :
         {lull_stopper_create(nullptr, &made), lull_stopper_create(&settings, nullptr),
          lull_stopper_block_rect(nullptr, 0, &rect), lull_stopper_block_rect(stopper, 0, nullptr),
          lull_stopper_block_rect(stopper, -1, &rect),
          lull_stopper_observe(nullptr, &picture, 20, nullptr),
          lull_stopper_observe(stopper, nullptr, 20, nullptr),
          lull_stopper_observe_block(nullptr, 0, &picture, 20, nullptr),
          lull_stopper_observe_block(stopper, 0, nullptr, 20, nullptr),
          lull_stopper_answer(nullptr, 0, &answer), lull_stopper_answer(stopper, 0, nullptr),
          lull_stopper_answer(stopper, 1, &answer), lull_stopper_save(nullptr, nullptr, &size),
          lull_stopper_save(stopper, nullptr, nullptr), lull_stopper_restore(nullptr, &byte, 1),
          lull_stopper_restore(stopper, nullptr, 1)})
        EXPECT_EQ(status, LULL_BAD_ARGUMENT);
    lull_stopper_destroy(nullptr);
    EXPECT_EQ(lull_stopper_block_count(nullptr), 0);
    EXPECT_EQ(lull_stopper_column_count(nullptr), 0);
    EXPECT_EQ(lull_stopper_needs_half(nullptr), 0);
    EXPECT_EQ(lull_stopper_done(nullptr), 1);
}

TEST(StopperErrors, SaysToEachThreadItsOwn) {
    lull_stopper_destroy(nullptr);
    lull_stopper_create(nullptr, nullptr);
    const std::string here = lull_error_message();
    std::thread([] { EXPECT_STREQ(lull_error_message(), ""); }).join();
    EXPECT_NE(here, "");
    EXPECT_EQ(lull_error_message(), here);
    EXPECT_STREQ(lull_version(), LULL_VERSION);
}

TEST(StopperState, GoesOnAsIfNeverInterrupted) {
    for (const char* rule : {"entropy:2", "lnoise:3", "learned", "fixed:300"}) {
        lull_settings settings = SettingsOf(60, 50, rule);
        settings.models = LULL_MODELS_DIR;
        StopperHandle stopper = MakeStopper(settings);
        const StopperHandle uninterrupted = MakeStopper(settings);
        for (int spp = 30; spp <= 900; spp += 30) {
            const BlockImage image = ImageAt(spp);
            EXPECT_TRUE(SameAnswer(Show(stopper, PictureOf(image), spp),
                                   Show(uninterrupted, PictureOf(image), spp)));
            const std::vector<char> state = SavedState(stopper);
            stopper = MakeStopper(settings);
            ASSERT_EQ(lull_stopper_restore(stopper.get(), state.data(), state.size()), LULL_OK)
                << lull_error_message();
            EXPECT_EQ(SavedState(stopper), state);
        }
    }
}

TEST(StopperState, RefusesWhatIsDamagedOrAnothers) {
    const StopperHandle stopper = MakeStopper(SettingsOf(60, 50, "entropy:2"));
    for (const int spp : {30, 70, 110}) Show(stopper, PictureOf(ImageAt(spp)), spp);
    const std::vector<char> state = SavedState(stopper);
    for (size_t i = 0; i < state.size(); i += 11) {
        std::vector<char> damaged = state;
        damaged[i] ^= 1;
        ExpectError(LULL_BAD_FILE,
                    lull_stopper_restore(stopper.get(), damaged.data(), damaged.size()), "damaged");
        EXPECT_EQ(lull_stopper_restore(stopper.get(), state.data(), i), LULL_BAD_FILE);
    }
    EXPECT_EQ(SavedState(stopper), state);
    for (const lull_settings& other :
         {SettingsOf(60, 51, "entropy:2"), SettingsOf(60, 50, "entropy"),
          SettingsOf(60, 50, "entropy:2", 20)})
        ExpectError(LULL_BAD_FILE,
                    lull_stopper_restore(MakeStopper(other).get(), state.data(), state.size()),
                    "other");
}

TEST(StopperModels, AreFoundByTheEnvironmentAndBesideTheLibrary) {
    lull_settings settings = SettingsOf(60, 50, nullptr);
    for (const char* model : {"entropy", "paper"}) {
        settings.model = model;
        MakeStopper(settings);  // beside the library
    }
    lull_stopper* stopper = nullptr;
    setenv("LULL_MODELS", "/nowhere", 1);
    ExpectError(LULL_BAD_FILE, lull_stopper_create(&settings, &stopper), "/nowhere");
    setenv("LULL_MODELS", LULL_MODELS_DIR, 1);
    MakeStopper(settings);
    unsetenv("LULL_MODELS");
    settings.model = LULL_MODELS_DIR "/paper.h5";
    EXPECT_EQ(lull_stopper_needs_half(MakeStopper(settings).get()), 0);
}

}  // namespace
}  // namespace lull
