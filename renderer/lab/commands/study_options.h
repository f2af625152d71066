// The options of `lull study`.
#pragma once

#include "renderer/commands/render_settings.h"
#include "renderer/lab/pages/study_page.h"

namespace lull::study {

struct Options {
    RenderSettings render;
    StudySettings study;
    std::string images;                // the folder of another renderer's pictures; empty: none
    std::vector<std::string> collect;  // files of answers; empty: a study is made
    std::string output, name;
    std::string record;             // the data set that the render is recorded to; empty: none
    std::string report, studyPage;  // of --collect; empty: none
    int levels = 0;                 // 0: as many as steps of kLadderRatio give
};

inline constexpr double kLadderRatio = 1.25;

void AddOptions(CLI::App& app, Options* settings);

// Throws CLI::ValidationError for options that do not fit together.
void CheckOptions(const CLI::App& app, const Options& settings);

// Collects answers: the second half of the command. Throws Error.
void CollectAnswers(const Options& settings);

}  // namespace lull::study
