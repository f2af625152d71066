// Writes down what observers said.
#pragma once

#include <string>

#include "stopping/lab/observers/observers.h"

namespace lull {

// Returns a CSV with a line of column names: a row for each block, and one for each viewpoint with
// the block "all". Thresholds are in spp; fields of what is not known are empty.
std::string DetailsCsv(const Collected& collected);

// Returns a CSV with a line of column names and a row for each file of answers: who counts, who was
// left out and why, how consistent each was, and what is known of the display, the distance and the
// observer.
std::string ObserversCsv(const Collected& collected);

// Returns what those who count said one by one, as ReadSingleAnswers() in stopping/evaluation reads
// it and `lull evaluate --answers` takes it: of each adjustment that noise was seen at the levels
// that were left, and none where it ended, with a number for the adjustment, as these answers are
// steps on one way. Empty if there is none: of staircases it is known which
// of two pictures was found noisier, half of the time by chance, and not whether noise was seen.
std::string SingleAnswersCsv(const Collected& collected, const std::string& viewpoint);

}  // namespace lull
