#include "stopping/lab/training/training_preset.h"

namespace lull {

std::span<const TrainingPreset> TrainingPresets() {
    static const TrainingPreset presets[] = {
        {.name = "entropy",
         .settings = {.k = 2,
                      .features = {Feature::VisibleDrop},
                      .takesMean = true,
                      .spacing = Spacing::Geometric,
                      .ratio = 1.4142,
                      .visibility = {.mask = 1e9, .flare = 0, .nearness = 0.25},
                      .peakLimit = 1.1},
         .training = {.units = {8, 4},
                      .dropout = 0,
                      .learningRate = 0.003,
                      .epochs = 60,
                      .balanceViewpoints = true,
                      .balanceClasses = false}},
        {.name = "paper"}};
    return presets;
}

}  // namespace lull
