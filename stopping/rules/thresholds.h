// Reads and writes thresholds files, in the format in which the human thresholds are published.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace lull {

// The spp at which each block of a viewpoint needs no more samples, blocks row-major. The
// published files have 4 x 4 blocks and 10,000 where a block never stopped; any count is allowed.
struct ThresholdsRow {
    std::string name;      // of the viewpoint; not empty, without ';' and line breaks
    std::vector<int> spp;  // at least one, each >= 0
};

// Reads `name;t0;t1;...;` line by line; the last semicolon may be missing, empty lines are
// skipped. Throws std::runtime_error beginning with "file:line: " for anything else, or a name
// that comes twice.
std::vector<ThresholdsRow> ReadThresholds(const std::string& path);
std::vector<ThresholdsRow> ReadThresholds(std::istream& in, const std::string& fileName);

// Writes the rows so that ReadThresholds() returns them. Throws std::invalid_argument for a row
// that the format cannot hold and std::runtime_error if the file cannot be written.
void WriteThresholds(const std::string& path, const std::vector<ThresholdsRow>& rows);
void WriteThresholds(std::ostream& out, const std::vector<ThresholdsRow>& rows);

}  // namespace lull
