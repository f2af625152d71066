#include "stopping/lab/training/training_preset.h"

#include <gtest/gtest.h>

#include "stopping/network/model_file.h"

namespace lull {
namespace {

// Compares the settings in the file of a model with a preset.
void ExpectTrainedBy(const TrainingPreset& preset, const Model& model) {
    const ModelSettings &a = preset.settings, &b = model.settings;
    EXPECT_EQ(a.k, b.k);
    EXPECT_EQ(a.n, b.n);
    EXPECT_EQ(a.m, b.m);
    EXPECT_EQ(a.features, b.features);
    EXPECT_EQ(a.takesMean, b.takesMean);
    EXPECT_EQ(a.snorm, b.snorm);
    EXPECT_EQ(a.votes, b.votes);
    EXPECT_EQ(a.spacing, b.spacing);
    EXPECT_EQ(a.ratio, b.ratio);
    EXPECT_EQ(a.visibility.mask, b.visibility.mask);
    EXPECT_EQ(a.visibility.flare, b.visibility.flare);
    EXPECT_EQ(a.visibility.nearness, b.visibility.nearness);
    EXPECT_EQ(a.peakLimit, b.peakLimit);
}

TEST(TrainingPreset, IsThatOfTheModelThatShips) {
    const TrainingPreset& preset = TrainingPresets().front();
    const Model model = ReadModel(LULL_SOURCE_DIR "/stopping/models/" + preset.name + ".h5");
    ExpectTrainedBy(preset, model);
    ASSERT_EQ(model.network.lstm.size(), preset.training.units.size());
    for (size_t i = 0; i < model.network.lstm.size(); ++i)
        EXPECT_EQ(model.network.lstm[i].Units(), preset.training.units[i]);
}

TEST(TrainingPreset, HasThePaperForOthers) {
    ASSERT_EQ(TrainingPresets().size(), 2u);
    const TrainingPreset& preset = TrainingPresets()[1];
    EXPECT_EQ(preset.name, "paper");
    EXPECT_EQ(preset.training.units, (std::vector<int>{512, 128, 32}));
    ExpectTrainedBy(preset, ReadModel(LULL_SOURCE_DIR "/stopping/models/paper.h5"));
}

}  // namespace
}  // namespace lull
