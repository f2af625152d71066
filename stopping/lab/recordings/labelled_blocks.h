// Reads the recordings and the thresholds of people that networks learn from and rules are judged
// by.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stopping/lab/recordings/training_samples.h"

namespace lull {

// Receives warnings for the user, and is called by one thread at a time.
using WarningSink = std::function<void(const std::string& message)>;

// Reads data sets as one; blocks of a viewpoint can be in several files. Throws std::runtime_error
// beginning with the file's name.
std::vector<ViewpointRecording> ReadDatasets(const std::vector<std::string>& paths);

// Joins recordings, which must outlive the result, with the thresholds in the file `human`, less
// the viewpoints in `without`; tells which have no thresholds. Throws std::runtime_error if no
// block is left or they do not fit together, or for a name in `without` that is neither recorded
// nor judged.
std::vector<LabelledBlock> ReadLabelledBlocks(const std::vector<ViewpointRecording>& viewpoints,
                                              const std::string& human,
                                              const std::vector<std::string>& without,
                                              const WarningSink& warn);

// Returns the blocks that were recorded with all that the settings ask for, and tells how many were
// not. Throws std::runtime_error if none is left.
std::vector<LabelledBlock> KeepRecorded(const std::vector<LabelledBlock>& judged,
                                        const ModelSettings& settings, const WarningSink& warn);

}  // namespace lull
