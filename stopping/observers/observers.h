// Makes human thresholds of what observers said.
#pragma once

#include "stopping/observers/observer_answers.h"
#include "stopping/rules/thresholds.h"

namespace lull {

struct CollectOptions {
    double mostFailed = 0.25;  // share of the checks that an observer may fail
    std::string study = {};    // the id of the only study that is taken; empty: any
};

// Names what was not taken, and why.
struct RefusedAnswers {
    std::string file, reason;
};

// Says what is known of an observer's care. Octaves are of spp: 1 is a factor of two.
struct JudgedObserver {
    ObserverAnswers answers;
    std::string leftOut;  // why; empty: the answers count
    int checks = 0, failed = 0, repeats = 0;
    // Standard deviation of a single answer, from those given twice: the root of the mean of half
    // the squared differences.
    std::optional<double> repeatOctaves;
    // How far the thresholds are above the mean of all observers (geometric means, octaves).
    std::optional<double> shiftOctaves;
};

// What observers said of a block, in spp.
struct BlockConsensus {
    double mean = 0, lowest = 0, highest = 0;
    std::optional<double> deviation, octaves;  // standard deviations over observers
    std::optional<double> low, high;           // 95 % confidence of the mean, within the ladder
};

struct CollectedViewpoint {
    std::string name, study;  // and the study's id
    std::vector<int> levels;
    int observers = 0;  // whose answers count
    std::vector<BlockConsensus> blocks;
    std::optional<double> agreement;  // intraclass correlation of the logarithms
};

struct Collected {
    std::vector<CollectedViewpoint> viewpoints;  // in the order of their names
    std::vector<JudgedObserver> observers;       // in the order of viewpoint, observer
    std::vector<RefusedAnswers> refused;
};

// Reads files of answers and refuses those that cannot be read, answer another study than most
// files of that viewpoint do, come twice, or contradict each other: the same session with other
// answers (all of them), or a name that has judged the viewpoint before (the later one).
Collected CollectFiles(const std::vector<std::string>& files, const CollectOptions& options);

// Does the same with answers that have been read.
Collected CollectObservers(std::vector<ObserverAnswers> answers, const CollectOptions& options);

// Returns the thresholds: means over the observers, rounded to whole spp.
std::vector<ThresholdsRow> ThresholdsOf(const Collected& collected);

}  // namespace lull
