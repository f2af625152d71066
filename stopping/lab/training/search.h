// Tries many settings of a training: reads which, says how long it will take, ranks what came out.
#pragma once

#include <cstddef>
#include <istream>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/block_split.h"
#include "stopping/lab/training/training.h"

namespace lull {

// Holds an option of the training, without its dashes, and the values to try.
struct SearchAxis {
    std::string option;
    std::vector<std::string> values;
    int line = 0;  // of the file, from 1
};

// Reads a grid: on each line an option and its values, with spaces between them; what follows a #
// is a comment. Throws std::runtime_error beginning with "file:line: " for an option without
// values, one that comes twice, or a value that does; also if there is no option at all or there
// are more than kMostCombinations.
inline constexpr size_t kMostCombinations = 100000;
std::vector<SearchAxis> ReadGrid(const std::string& path);
std::vector<SearchAxis> ReadGrid(std::istream& in, const std::string& fileName);

size_t CombinationCount(std::span<const SearchAxis> axes);
// Returns the value of each axis; that of the last one changes from each index to the next.
std::vector<std::string> CombinationAt(std::span<const SearchAxis> axes, size_t index);

// Holds what came of a combination. Shares are in [0, 1], all NaN if there was nothing to learn
// from or the training diverged. AUC and accuracy are those of the answers to all windows, classes
// balanced.
struct SearchResult {
    std::vector<std::string> values;  // of the axes
    double testAuc = 0, testAccuracy = 0;
    double trainingAuc = 0, trainingAccuracy = 0;
    double criticalError = 0;    // at a margin of 2 %, of the blocks left out
    double early = 0, late = 0;  // shares of them, see Judgement
    double seconds = 0;          // that it took
};

// Sorts by the AUC on the blocks left out, the largest first; equal ones stay as they are, those
// that are NaN come last.
void RankResults(std::vector<SearchResult>* results);

// Return tables of ranked results: a row each, the values of the axes first.
std::string SearchCsv(std::span<const SearchAxis> axes, std::span<const SearchResult> results);
std::string SearchMarkdown(std::span<const SearchAxis> axes, std::span<const SearchResult> results);

// Pack results into bytes and back. `data` says what everything was learned from and with;
// RestoreResults() throws std::runtime_error if it is another now, or the bytes are damaged.
std::vector<std::byte> SaveResults(const std::string& data, std::span<const SearchResult> results);
std::vector<SearchResult> RestoreResults(std::span<const std::byte> bytes, const std::string& data);
// Does the same with a file of such bytes; what it throws begins with the file's name.
std::vector<SearchResult> ReadResults(const std::string& path, const std::string& data);

// Estimates how long a combination takes, in a unit of its own: the training of all splits, and
// judging their blocks.
double SearchCost(const ModelSettings& settings, const TrainingOptions& training,
                  std::span<const BlockSplit> splits);

// Returns the seconds that are left when the first combinations have taken `seconds`, from the
// costs of all: as many seconds a unit of cost as these took together. 0 if none is done.
double SecondsLeft(std::span<const double> costs, std::span<const double> seconds);

}  // namespace lull
