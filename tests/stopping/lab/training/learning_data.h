// Writes the recordings and thresholds of a small training to files.
#pragma once

#include <string>
#include <vector>

#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/lab/training/training_plan.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"
#include "tests/stopping/scratch_file.h"

namespace lull {

// Returns a line of a thresholds file.
inline std::string Line(const ThresholdsRow& row) {
    std::string line = row.name + ";";
    for (const int spp : row.spp) line += std::to_string(spp) + ";";
    return line + "\n";
}

// Recordings of three viewpoints and thresholds of people for two of them, attic and barn.
struct LearningData {
    std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("attic", 4, 1200),
                                                  MakeViewpoint("barn", 3, 1200),
                                                  MakeViewpoint("cellar", 2, 1200)};
    ScratchFile human{".csv", Line(MakeHumanRow("attic")) + Line(MakeHumanRow("barn"))};
    ScratchFile dataset{".h5"};

    LearningData() { WriteBytes(dataset.path, EncodeDataset(viewpoints)); }

    std::vector<LabelledBlock> Blocks() const {
        return ReadLabelledBlocks(viewpoints, human.path, {}, [](const std::string&) {});
    }
    // Returns a plan that is trained at once.
    TrainingPlan Plan() const {
        TrainingPlan plan;
        plan.datasets = {dataset.path};
        plan.human = human.path;
        plan.settings = {.k = 2, .m = 25, .voteSpacing = 40};
        plan.training = {.units = {4}, .epochs = 3, .seed = 1};
        plan.version = "test";
        return plan;
    }
};

}  // namespace lull
