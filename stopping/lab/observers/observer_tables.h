// Writes the answers of observers as CSV tables.
#pragma once

#include <string>

#include "stopping/lab/observers/observers.h"

namespace lull {

// Returns a CSV with a line of column names: a row for each block. Thresholds are in spp; unknown
// fields are empty.
std::string DetailsCsv(const Collected& collected);

// Returns a CSV with a line of column names and a row for each file of answers: whether it
// counts or why not, the consistency of its answers, and the recorded display and
// distance.
std::string ObserversCsv(const Collected& collected);

// Returns the single answers of observers who count, as read by ReadSingleAnswers()
// (evaluation/single_answers.h) and `lull evaluate --answers`: for each adjustment, noise seen at
// the levels that were left, and none at its end, with a number for the adjustment, as these
// answers are steps on one path. Empty if there is none.
std::string SingleAnswersCsv(const Collected& collected, const std::string& viewpoint);

}  // namespace lull
