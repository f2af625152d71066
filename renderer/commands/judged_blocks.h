// Reads the recordings and human thresholds that commands learn from or judge by.
#pragma once

#include <string>
#include <vector>

#include "stopping/learning/training_samples.h"

namespace lull {

// Reads data sets as one; blocks of a viewpoint can be in several files. Throws Error or
// std::runtime_error beginning with the file's name.
std::vector<ViewpointRecording> ReadDatasets(const std::vector<std::string>& paths);

// Joins recordings, which must outlive the result, with the thresholds in the file `human`, less
// the viewpoints in `without`; says on stderr which have no thresholds. Throws Error if no block is
// left or they do not fit together, or for a name in `without` that is neither recorded nor judged.
std::vector<JudgedBlock> ReadJudgedBlocks(const std::vector<ViewpointRecording>& viewpoints,
                                          const std::string& human,
                                          const std::vector<std::string>& without);

}  // namespace lull
