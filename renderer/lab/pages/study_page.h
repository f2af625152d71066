// Writes the page on which people say where they still see noise.
#pragma once

#include "renderer/base/enum_names.h"
#include "renderer/lab/pages/study_texts.h"
#include "renderer/lab/viewpoints/study.h"
#include "renderer/results/report_json.h"

namespace lull {

// How people are asked.
enum class StudyProcedure {
    Adjust,    // image and reference side by side: click where they differ, until they match
    Staircase  // block and reference side by side: which is noisier? (QUEST)
};

template <>
struct EnumNames<StudyProcedure> {
    static constexpr std::pair<StudyProcedure, const char*> all[] = {
        {StudyProcedure::Adjust, "adjust"}, {StudyProcedure::Staircase, "staircase"}};
};

struct StudySettings {
    StudyProcedure procedure = StudyProcedure::Adjust;
    double repeats = 0.25;   // share of the blocks that are asked twice, [0, 1]
    double catches = 0.15;   // share that checks the observer, [0, 1)
    int answers = 20;        // to each block of a staircase, > 0
    double descending = 0;   // share of the blocks that are also asked from above, [0, 1]
    bool questions = false;  // on age and sight
    StudyTexts texts = {};   // those that replace the page's own, and the one that is shown first
};

// Returns the standard deviation, in octaves, of a threshold from this many answers of a staircase
// (> 0), if the observer follows the model of QUEST: of 2,000 simulated staircases with thresholds
// from 100 to 4,000 spp on a ladder from 20 to 10,000; between and beyond those numbers, by powers.
double StaircaseOctaves(int answers);

// Returns the page, which contains everything and loads nothing.
std::string MakeStudyPage(const Study&, const StudySettings&);

// Returns the data of a study's page, with the pictures of the blocks at the last level in
// "references", as data URIs. Throws Error beginning with the path for anything that is not such a
// page.
Json ReadStudyPage(const std::string& path);

}  // namespace lull
