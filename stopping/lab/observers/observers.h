// Computes human thresholds from the answers of observers.
#pragma once

#include <string>

#include "stopping/lab/observers/observer_answers.h"
#include "stopping/rules/thresholds.h"

namespace lull {

struct CollectOptions {
    double mostFailed = 0.25;   // share of the checks that an observer may fail
    double leastSeconds = 0.2;  // mean time of an answer; less is no look
    std::string study = {};     // the id of the only study that is taken; empty: any
};

struct RefusedAnswers {
    std::string file, reason;
};

// Consistency of an observer. Octaves are of spp: 1 is a factor of two.
struct CheckedObserver {
    ObserverAnswers answers;
    std::string leftOut;  // why; empty: the answers count
    std::string doubts;   // about answers that count; may be empty
    int checks = 0, failed = 0, repeats = 0;
    // Standard deviation of a single answer, from those given twice: the root of the mean of half
    // the squared differences.
    std::optional<double> repeatOctaves;
    // How far the thresholds are above the mean of all observers (geometric means, octaves).
    std::optional<double> shiftOctaves;
};

// Answers of the observers on a block, in spp.
struct BlockConsensus {
    double mean = 0, lowest = 0, highest = 0;
    std::optional<double> deviation, octaves;  // standard deviations over observers
    int answers = 0;                           // that it rests on, of all observers
};

struct CollectedViewpoint {
    std::string name, study;  // and the study's id
    std::vector<int> levels;
    int observers = 0;  // whose answers count
    std::vector<BlockConsensus> blocks;
};

struct Collected {
    std::vector<CollectedViewpoint> viewpoints;  // in the order of their names
    std::vector<CheckedObserver> observers;      // in the order of viewpoint, observer
    std::vector<RefusedAnswers> refused;
};

// A threshold that rests on fewer answers is rough.
inline constexpr int kEnoughAnswers = 30;

// Returns how many answers the threshold of a block rests on, at the least.
int FewestAnswers(const CollectedViewpoint& viewpoint);

// Reads files of answers and refuses those that cannot be read, answer another study than most
// files of that viewpoint do, come twice, or contradict each
// other: the same session with other answers (all of them), or a name that has judged the viewpoint
// before (the later one).
Collected CollectFiles(const std::vector<std::string>& files, const CollectOptions& options);

// Does the same with answers that have been read.
Collected CollectObservers(std::vector<ObserverAnswers> answers, const CollectOptions& options);

// Returns the thresholds: means over the observers, rounded to whole spp.
std::vector<ThresholdsRow> ThresholdsOf(const Collected& collected);

// Writes the answers of observers as CSV tables.

// Returns a CSV with a head line and a row for each block: thresholds in spp; unknown ones empty.
std::string DetailsCsv(const Collected& collected);

// Returns a CSV with a line of column names and a row for each file of answers: whether it
// counts or why not, the consistency of its answers, and the recorded display and
// distance.
std::string ObserversCsv(const Collected& collected);

// Returns the single answers of observers who count, as read by ReadSingleAnswers()
// (evaluation/answer_scores.h) and `lull evaluate --answers`: for each adjustment, noise seen at
// the levels that were left, and none at its end, with a number for the adjustment. May be empty.
std::string SingleAnswersCsv(const Collected& collected, const std::string& viewpoint);

}  // namespace lull
