// Writes files of answers as the page of `lull study` does.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace lull {

// Describes an observer of a study of the levels 20, 40, 80, 160, 320. Each threshold is the
// block's first answer.
struct ExampleAnswers {
    std::string observer = "ada", session = "00ff", study = "0123456789abcdef", viewpoint = "room";
    std::string started = "2026-01-01T00:00:00.000Z";
    std::vector<int> levels = {1, 2, 3, 4};  // of each block, as numbers in the ladder
    std::vector<int> repeats = {};           // of the first blocks, asked again
    std::vector<int> starts = {};            // where the first blocks began; empty: not said
    int checks = 4, failed = 0, clicks = 3;
    double seconds = 12.5;
    std::string display = R"({"gamma":2.2,"distanceCm":60})";

    std::string Text() const {
        static const int spp[] = {20, 40, 80, 160, 320};
        std::ostringstream answers, thresholds, text;
        int count = 0;
        const auto add = [&](size_t block, const char* kind) -> std::ostream& {
            if (count++ > 0) answers << ",";
            return answers << R"({"block":)" << block << R"(,"round":0,"clicks":)" << clicks
                           << R"(,"kind":")" << kind << "\",";
        };
        for (size_t i = 0; i < levels.size(); ++i) {
            add(i, "asked") << R"("level":)" << levels[i];
            if (i < starts.size()) answers << R"(,"start":)" << starts[i];
            answers << "}";
            double mean = spp[levels[i]];
            if (i < repeats.size()) {
                add(i, "repeat") << R"("level":)" << repeats[i] << "}";
                mean = (mean + spp[repeats[i]]) / 2;
            }
            thresholds << (i > 0 ? "," : "") << mean;
        }
        for (int i = 0; i < checks; ++i)
            add(0, "catch") << R"("failed":)" << (i < failed ? "true" : "false") << "}";
        text << R"({"format":"lull-judge-answers","version":1,"study":{"id":")" << study
             << R"(","viewpoint":")" << viewpoint << R"(","procedure":"adjust","blocks":)"
             << levels.size() << R"(,"levels":[20,40,80,160,320]},"observer":")" << observer
             << R"(","session":")" << session << R"(","seed":1,"started":")" << started
             << R"(","finished":"2026-01-01T01:00:00.000Z","seconds":)" << seconds
             << R"(,"display":)" << display << R"(,"thresholds":[)" << thresholds.str()
             << R"(],"answers":[)" << answers.str() << "]}";
        return text.str();
    }
};

}  // namespace lull
