#include "stopping/lab/evaluation/single_answers.h"

#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/base/text_lines.h"

namespace lull {

namespace {

constexpr const char* kHead = "block,spp,noise_seen";
constexpr const char* kTrackHead = "block,spp,noise_seen,observer,track";
constexpr int kMostBlocks = 1 << 16, kMostSpp = 1 << 24;

// Returns the three whole numbers of a line; nothing if it is something else.
std::optional<std::array<int, 3>> ParseNumbers(std::string_view line) {
    std::array<int, 3> numbers;
    const char *at = line.data(), *end = at + line.size();
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (i > 0 && (at == end || *at++ != ',')) return {};
        const auto [rest, error] = std::from_chars(at, end, numbers[i]);
        if (error != std::errc()) return {};
        at = rest;
    }
    if (at != end) return {};
    return numbers;
}

// Returns where the comma number `count` of a line is; npos if there are fewer.
size_t CommaAt(std::string_view line, int count) {
    size_t at = line.find(',');
    for (int i = 1; i < count && at != std::string_view::npos; ++i) at = line.find(',', at + 1);
    return at;
}

// Takes observer and track from the end of a line. Returns whether they are there.
bool ParseTrack(std::string_view* line, SingleAnswer* answer) {
    const size_t begin = CommaAt(*line, 3), end = line->rfind(',');
    if (begin == std::string_view::npos || end <= begin) return false;
    const std::string_view track = line->substr(end + 1);
    if (!track.empty()) {
        const auto [rest, error] =
            std::from_chars(track.data(), track.data() + track.size(), answer->track);
        if (error != std::errc() || rest != track.data() + track.size() || answer->track < 1)
            return false;
    }
    answer->observer = line->substr(begin + 1, end - begin - 1);
    *line = line->substr(0, begin);
    return true;
}

// Throws std::invalid_argument with the reason.
SingleAnswer ParseAnswer(std::string_view line, bool hasTrack) {
    SingleAnswer answer;
    const std::string whole(line);
    const bool isWhole = !hasTrack || ParseTrack(&line, &answer);
    const std::optional<std::array<int, 3>> numbers = ParseNumbers(line);
    if (!isWhole || !numbers)
        throw std::invalid_argument(
            "'" + Printable(whole) + "' is not an answer; " +
            (hasTrack
                 ? "three whole numbers, the observer and a track are needed, as in 5,640,1,ada,3"
                 : "three whole numbers are needed, as in 5,640,1"));
    const auto [block, spp, seen] = *numbers;
    if (block < 0 || block >= kMostBlocks)
        throw std::invalid_argument("there can be no block " + std::to_string(block) +
                                    "; blocks are counted from 0, row by row");
    if (spp < 1 || spp > kMostSpp)
        throw std::invalid_argument(std::to_string(spp) +
                                    " samples per pixel cannot be; give those of the picture");
    if (seen != 0 && seen != 1)
        throw std::invalid_argument("noise_seen is " + std::to_string(seen) +
                                    "; 1 is needed where noise was seen, else 0");
    answer.block = block;
    answer.spp = spp;
    answer.seen = seen == 1;
    return answer;
}

}  // namespace

std::vector<SingleAnswer> ReadSingleAnswers(std::istream& in, const std::string& fileName) {
    std::vector<SingleAnswer> answers;
    bool hasHead = false, hasTrack = false;
    for (TextLines lines(in, fileName); lines.Next();) {
        const std::string& line = lines.Line();
        const int number = lines.Number();
        if (line.empty()) continue;
        try {
            if (!hasHead && line != kHead && line != kTrackHead)
                throw std::invalid_argument(std::string("the first line has to be ") + kHead +
                                            ", or " + kTrackHead);
            if (!hasHead) hasTrack = line == kTrackHead;
            if (hasHead) {
                answers.push_back(ParseAnswer(line, hasTrack));
                answers.back().line = number;
            }
            hasHead = true;
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(fileName + ":" + std::to_string(number) + ": " + error.what());
        }
    }
    if (answers.empty())
        throw std::runtime_error(fileName + ": has no answers; lines of " + kHead + " are needed");
    return answers;
}

std::vector<SingleAnswer> ReadSingleAnswers(const std::string& path) {
    std::ifstream file = OpenInput(path);
    return ReadSingleAnswers(file, path);
}

void CheckBlocks(std::span<const SingleAnswer> answers, int blockCount,
                 const std::string& fileName) {
    for (const SingleAnswer& answer : answers)
        if (answer.block >= blockCount)
            throw std::runtime_error(fileName + ":" + std::to_string(answer.line) + ": block " +
                                     std::to_string(answer.block) +
                                     ", but the recorded picture has the blocks 0 to " +
                                     std::to_string(blockCount - 1));
}

}  // namespace lull
