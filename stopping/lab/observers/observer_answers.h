// Reads an observer's answers on one viewpoint: the JSON files that the page of `lull study` saves.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lull {

enum class AnswerKind {
    Asked,   // where the block's noise was seen to end
    Repeat,  // the same, asked again
    Catch    // a check of the observer, to which the right answer is known
};

// Whether noise was seen in a picture of `spp` samples per pixel.
struct NoiseAnswer {
    int spp = 0;
    bool seen = false;
};

struct BlockAnswer {
    AnswerKind kind = AnswerKind::Asked;
    int block = 0;        // row-major
    double spp = 0;       // the threshold, within the ladder; 0 for a check
    bool failed = false;  // of a check
    std::vector<NoiseAnswer> single = {};
};

struct ObserverAnswers {
    std::string file;                  // that they were read from
    std::string observer, session;     // a name that the observer chose; digits of the session
    std::string started;               // ISO 8601, so that texts are ordered as times
    std::string study, viewpoint;      // id and name
    std::vector<int> levels;           // spp of the ladder, increasing, two or more
    std::vector<double> thresholds;    // spp of each block: the mean of all answers to it
    std::vector<BlockAnswer> answers;  // at least one for each block that is no check
    bool isIdle = false;               // the observer pointed at nothing
    double seconds = 0;                // without pauses
    int given = 0;                     // answers in all
    // Of the display, as set or stated by the observer; zoom: 1 is 100 %; pixels are those of
    // pictures, `shown` is the number of display pixels for one of them.
    std::optional<double> gamma, distanceCm, pixelsPerDegree, zoom;
    std::optional<int> shown, windowWidth, windowHeight;
    std::string tones;  // "all" or "not all", which can be told apart; empty: not known

    bool operator==(const ObserverAnswers& other) const;  // but for the file
};

// Reads answers from a text. Throws std::runtime_error with the reason: no JSON, not made by the
// page, or contradictory. Names can stand in thresholds files.
ObserverAnswers ParseAnswers(std::string_view text);

// Reads a file. Throws std::runtime_error, without the file's name.
ObserverAnswers ReadAnswers(const std::string& path);

}  // namespace lull
