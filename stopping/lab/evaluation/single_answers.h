// Reads single answers of people: whether they saw noise in a block at some spp.
#pragma once

#include <istream>
#include <span>
#include <string>
#include <vector>

namespace lull {

struct SingleAnswer {
    int block = 0;  // row-major number
    int spp = 0;    // > 0, of the picture that was shown
    bool seen = false;
    int line = 0;               // of the file that it was read from
    std::string observer = {};  // who gave it; may be empty
    // The adjustment that it is a step of, a number that no other one has; 0: it was asked by
    // itself.
    int track = 0;
};

// Reads a CSV of one viewpoint with the line of names "block,spp,noise_seen", after which there can
// be ",observer,track", and an answer, 0 or 1, in each other line; empty lines are skipped. Throws
// std::runtime_error, beginning with "file:line: " where a line is at fault, also if there is no
// answer.
std::vector<SingleAnswer> ReadSingleAnswers(const std::string& path);
std::vector<SingleAnswer> ReadSingleAnswers(std::istream& in, const std::string& fileName);

// Throws std::runtime_error, beginning with "file:line: ", for an answer to a block that a picture
// of `blockCount` blocks does not have.
void CheckBlocks(std::span<const SingleAnswer> answers, int blockCount,
                 const std::string& fileName);

}  // namespace lull
