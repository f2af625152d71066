#include "stopping/features/model_inputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/rules/learned.h"
#include "tests/stopping/cut_states.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

TEST(ModelSettings, NameFeatures) {
    const std::string features = "H,H1,H2,visible_drop,attributes26";
    EXPECT_EQ(FeatureNames(ParseFeatures(features)), features);
    for (const char* bad : {"", "H3", "H,", ",H", "H,H", "h", "H noise", "texture"})
        EXPECT_THROW(ParseFeatures(bad), std::invalid_argument) << bad;
}

TEST(InputVector, TakesTheMeanBeforeItScales) {
    BlockMeasures measures{.spp = 10000};
    for (int i = 0; i < 100; ++i) {
        measures.Of(Feature::H).push_back(i / 100.0);
        measures.Of(Feature::VisibleDrop).push_back(i);
    }
    const std::vector<double> x =
        InputVector(measures, {.features = {Feature::H, Feature::VisibleDrop}, .takesMean = true});
    ASSERT_EQ(x.size(), 2u);
    EXPECT_NEAR(x[0], 0.495, 1e-12);
    EXPECT_NEAR(x[1], std::log(49.6), 1e-12);
}

TEST(InputVector, GivesEachSubBlock) {
    const ModelSettings settings = {.m = 4, .features = {Feature::H, Feature::VisibleDrop}};
    const std::vector<InputRange> ranges = InputRanges(settings);
    ASSERT_EQ(ranges.size(), 2u);
    EXPECT_EQ(ranges[0].begin, 0);
    EXPECT_EQ(ranges[1].begin, 4);
    EXPECT_EQ(InputCount(settings), 104);

    BlockMeasures measures{.spp = 20};
    measures.Of(Feature::H) = {0.1, 0.2, 0.3, 0.4};
    measures.Of(Feature::VisibleDrop).assign(100, 1);
    const std::vector<double> x = InputVector(measures, settings);
    EXPECT_EQ(x[2], 0.3);
    EXPECT_NEAR(x[103], std::log(1.1), 1e-6);
    measures.Of(Feature::H).pop_back();
    EXPECT_THROW(InputVector(measures, settings), std::invalid_argument);
}

TEST(Window, NormalisesEntropiesOnly) {
    const ModelSettings settings{
        .k = 2, .n = 20, .features = {Feature::VisibleDrop, Feature::H}, .takesMean = true};
    History<double> history;
    AddInputs(20, {0.1, 0.2}, settings, &history);
    AddInputs(40, {0.3, 0.6}, settings, &history);
    Eigen::MatrixXf expected(2, 2);
    expected << 0.1f, 0.3f, 0, 1;
    EXPECT_TRUE(WindowOf(history, settings, 40)->isApprox(expected, 1e-6f));
}

TEST(Window, NormalisesAttributesAsEntropies) {
    const ModelSettings settings = {
        .k = 2, .n = 20, .m = 1, .features = ParseFeatures("attributes26,H"), .takesMean = true};
    ASSERT_EQ(InputCount(settings), 27);  // of attributes there is no mean
    History<double> history;
    for (const int spp : {20, 40}) {
        BlockMeasures measures{.spp = spp};
        for (int i = 0; i < 26; ++i) measures.Of(Feature::Attributes26).push_back(spp + i);
        measures.Of(Feature::H) = {0.5};
        AddInputs(spp, InputVector(measures, settings), settings, &history);
    }
    const Eigen::MatrixXf window = *WindowOf(history, settings, 40);
    for (int step = 0; step < 2; ++step)
        for (int i = 0; i < 26; ++i) EXPECT_NEAR(window(i, step), step, 1e-6);
    EXPECT_EQ(window(26, 1), 0);
}

// Training inputs, from a recording, must equal those in a render.
TEST(ModelInputs, AreThoseOfRecordings) {
    for (int m : {25, 100}) {
        ModelSettings settings = {.m = m};
        settings.features = ParseFeatures(m == 100 ? "H,H1,H2,attributes26" : "H,attributes26");
        BlockRecording recording;
        BlockRecorder recorder(20, 100, 100, &recording);
        for (int spp = 20; spp <= 100; spp += 20) {
            const BlockImage block = NoisyBlock(64, 60, 0.5, spp, unsigned(spp));
            recorder.Observe(block.At(spp));
            const std::vector<double> live =
                InputVector(MeasureBlock(block.At(spp), settings), settings);
            const std::vector<double> recorded =
                InputVector(MeasuresOf(recording, spp / 20 - 1, settings), settings);
            ASSERT_EQ(recorded.size(), live.size());
            for (size_t i = 0; i < live.size(); ++i)
                EXPECT_NEAR(recorded[i], live[i], 1e-6 * std::max(1.0, live[i]));
        }
    }
}

ModelSettings Geometric(int k, double ratio) {
    return {.k = k,
            .n = 40,
            .features = {Feature::H},
            .takesMean = true,
            .snorm = false,
            .spacing = Spacing::Geometric,
            .ratio = ratio};
}

// Measures whose entropies of 100 sub-blocks are above 0.2 by 1 / spp.
BlockMeasures At(int spp) {
    BlockMeasures measures{.spp = spp};
    measures.Of(Feature::H).assign(100, 0.2 + 1.0 / spp);
    measures.lightness.mean.assign(100, 60);
    measures.lightness.deviation.assign(100, 0);
    return measures;
}

double SppOf(double input) { return 1 / (input - 0.2); }

TEST(BlockMemory, StepsGeometrically) {
    BlockMemory memory(Geometric(4, 2));
    for (int spp = 20; spp <= 10000; spp += 40) {
        memory.Add(At(spp));
        const auto window = memory.WindowAt(spp);
        EXPECT_TRUE(window || spp < 340) << spp;
        EXPECT_FALSE(window && spp < 140) << spp;
        if (!window) continue;
        EXPECT_NEAR(SppOf((*window)(0, 3)), spp, 1e-2 * spp);
        for (int step = 0; step < 3; ++step) {
            const double wanted = spp / std::pow(2, 3 - step);
            EXPECT_NEAR(SppOf((*window)(0, step)), wanted, 21 + 0.05 * wanted) << spp;
        }
        for (int step = 1; step < 4; ++step) EXPECT_LT((*window)(0, step), (*window)(0, step - 1));
    }
    EXPECT_FALSE(memory.WindowAt(9000));  // the last one only
}

TEST(BlockMemory, KeepsLittle) {
    BlockMemory memory(Geometric(4, 2));
    for (int spp = 20; spp <= 200000; spp += 40) memory.Add(At(spp));
    StateWriter writer;
    memory.Save(&writer);
    EXPECT_LE(writer.bytes.size(), 12 + 26 * (4 + sizeof(double)));
}

TEST(BlockMemory, CompletesFallsOfEntropies) {
    const ModelSettings settings{
        .k = 1,
        .features = {Feature::VisibleDrop},
        .takesMean = true,
        .visibility = {.mask = 24, .flare = 0, .reference = 10000, .nearness = 0.5}};
    BlockMemory memory(settings);
    memory.Add(At(20));
    EXPECT_FALSE(memory.WindowAt(20));  // there is nothing to compare with
    for (int spp = 60; spp <= 4020; spp += 40) memory.Add(At(spp));
    const Eigen::MatrixXf window = *memory.WindowAt(4020);
    const double left = std::sqrt(1 / 4020.0);
    EXPECT_NEAR(std::exp(window(0, 0)) - 0.1, left * 60 * std::sqrt(1 - 0.402), 1e-3);
}

TEST(BlockMemory, ScalesNoiseByCaution) {
    ModelSettings settings{
        .k = 1, .features = {Feature::VisibleDrop, Feature::H}, .takesMean = true, .snorm = false};
    auto inputs = [&] {
        BlockMemory memory(settings);
        for (int spp = 20; spp <= 420; spp += 40) memory.Add(At(spp));
        return *memory.WindowAt(420);
    };
    const Eigen::MatrixXf once = inputs();
    settings.caution = 2;
    const Eigen::MatrixXf twice = inputs();
    EXPECT_NEAR(std::exp(twice(0, 0)) - 0.1, 2 * (std::exp(once(0, 0)) - 0.1), 1e-4);
    EXPECT_EQ(twice(1, 0), once(1, 0));
}

TEST(BlockMemory, GoesOnAfterARestart) {
    ModelSettings settings = Geometric(3, 1.5);
    settings.features = {Feature::VisibleDrop};
    BlockMemory first(settings), second(settings);
    for (int spp = 20; spp <= 1020; spp += 40) first.Add(At(spp));
    StateWriter writer;
    first.Save(&writer);
    StateReader reader(writer.bytes);
    second.Restore(&reader);
    reader.Finish();
    for (int spp = 1060; spp <= 3000; spp += 40) {
        first.Add(At(spp));
        second.Add(At(spp));
        EXPECT_EQ(*first.WindowAt(spp), *second.WindowAt(spp)) << spp;
    }
    ExpectRefusesCut(writer.bytes, 101, [&](auto bytes) {
        StateReader cut(bytes);
        BlockMemory(settings).Restore(&cut);
    });
}

ModelSettings Plain(int k, int n) { return {.k = k, .n = n, .m = 4, .snorm = false}; }

// The inputs of a block, and the settings that say what is kept of them.
struct Inputs {
    ModelSettings settings;
    History<double> history = {};

    void Add(int spp, std::vector<double> inputs) {
        AddInputs(spp, std::move(inputs), settings, &history);
    }
    std::optional<Eigen::MatrixXf> WindowAt(int spp) const {
        return WindowOf(history, settings, spp);
    }
};

// Adds the inputs (spp, spp + 1, spp + 2, spp + 3) / 1000.
void Add(Inputs* history, int spp) {
    std::vector<double> inputs;
    for (int i = 0; i < 4; ++i) inputs.push_back((spp + i) / 1000.0);
    history->Add(spp, std::move(inputs));
}

TEST(Normalize, MapsToTheUnitInterval) {
    const Eigen::ArrayXd values = Eigen::Array3d(0.5, 0.1, 0.3);
    const Eigen::ArrayXd result = Normalize(values);
    EXPECT_NEAR(result[0], 1, 1e-15);
    EXPECT_EQ(result[1], 0);
    EXPECT_NEAR(result[2], 0.5, 1e-15);
    // Equal values leave 0 / 2.2e-16, those that differ by little a share of it.
    EXPECT_TRUE((Normalize(Eigen::Array3d::Constant(0.7)) == 0).all());
    EXPECT_NEAR(Normalize(Eigen::Array2d(0, 2.220446049250313e-16))[1], 0.5, 1e-12);
}

TEST(Window, TakesEveryNthSpp) {
    Inputs history{Plain(3, 40)};
    for (int spp = 20; spp <= 80; spp += 20) {
        Add(&history, spp);
        EXPECT_FALSE(history.WindowAt(spp)) << spp;
    }
    Add(&history, 100);
    const auto window = history.WindowAt(100);
    ASSERT_TRUE(window);
    EXPECT_EQ(window->rows(), 4);
    EXPECT_EQ(window->cols(), 3);
    for (int step = 0; step < 3; ++step)
        for (int i = 0; i < 4; ++i)
            EXPECT_FLOAT_EQ((*window)(i, step), float(20 + 40 * step + i) / 1000);
    Add(&history, 120);
    EXPECT_FLOAT_EQ((*history.WindowAt(120))(0, 0), 0.040f);
}

TEST(Window, IsFullFirstAt300SppWithThePapersSettings) {
    Inputs history{{.m = 4}};
    for (int spp = 20; spp <= 300; spp += 20) {
        Add(&history, spp);
        EXPECT_EQ(history.WindowAt(spp).has_value(), spp == 300);
    }
    for (int spp = 320; spp <= 2000; spp += 20) {
        Add(&history, spp);
        EXPECT_TRUE(history.WindowAt(spp));
        EXPECT_EQ(history.history.States().size(), 15u);  // no more is kept than can be needed
    }
}

TEST(Window, HasNoWindowWithAGap) {
    Inputs history{Plain(3, 40)};
    for (int spp : {20, 100, 140}) Add(&history, spp);
    EXPECT_FALSE(history.WindowAt(100));
    EXPECT_FALSE(history.WindowAt(140));
    Add(&history, 180);
    EXPECT_TRUE(history.WindowAt(180));
}

TEST(Window, NormalisesEachFeatureOverTheWindow) {
    const std::vector<double> first = {0.1, 0.2, 0.3, 0.5}, second = {0.4, 0.0, 0.8, 0.4};
    Inputs history{{.k = 2, .n = 20, .m = 4}};
    history.Add(20, first);
    history.Add(40, second);
    Eigen::MatrixXf expected(4, 2);
    expected << 0, 1, 1, 0, 0, 1, 1, 0;
    EXPECT_TRUE(history.WindowAt(40)->isApprox(expected, 1e-6f));
}

TEST(Window, NormalisesAConstantWindowToZero) {
    Inputs history{{.k = 3, .n = 20, .m = 4}};
    for (int spp : {20, 40, 60}) history.Add(spp, std::vector<double>(4, 0.3));
    EXPECT_TRUE(history.WindowAt(60)->isZero(0));
}

TEST(Window, RefusesWhatDoesNotFit) {
    Inputs history{Plain(3, 40)};
    Add(&history, 40);
    EXPECT_THROW(Add(&history, 40), std::invalid_argument);
    EXPECT_THROW(Add(&history, 20), std::invalid_argument);
    EXPECT_THROW(history.Add(60, std::vector<double>(3)), std::invalid_argument);
    for (double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        EXPECT_THROW(history.Add(60, std::vector<double>(4, bad)), std::invalid_argument);
}

TEST(ModelSettings, AreChecked) {
    EXPECT_NO_THROW(CheckSettings({}));
    const std::vector<Feature> drop = {Feature::VisibleDrop};
    for (const ModelSettings& bad :
         std::initializer_list<ModelSettings>{{.k = 0},
                                              {.n = 0},
                                              {.m = 99},
                                              {.m = 25, .features = drop},
                                              {.features = {}},
                                              {.votes = 0},
                                              {.voteSpacing = -20},
                                              {.visibility = {.mask = 0}},
                                              {.visibility = {.flare = -1}},
                                              {.visibility = {.reference = 0}},
                                              {.visibility = {.nearness = std::nan("")}},
                                              {.caution = 0},
                                              Geometric(2, 1),
                                              Geometric(100, 2)}) {
        EXPECT_THROW(CheckSettings(bad), std::invalid_argument);
        EXPECT_THROW(BlockMemory{bad}, std::invalid_argument);
    }
}

}  // namespace
}  // namespace lull
