// Writes the page on which people say where they still see noise.
#pragma once

#include "renderer/base/enum_names.h"
#include "renderer/lab/viewpoints/study.h"
#include "renderer/results/report_json.h"

namespace lull {

// How people are asked.
enum class StudyProcedure {
    Adjust,    // the whole image beside the reference: click where they differ, until they match
    Staircase  // a block beside its reference: which of both has the noise? (QUEST)
};

template <>
struct EnumNames<StudyProcedure> {
    static constexpr std::pair<StudyProcedure, const char*> all[] = {
        {StudyProcedure::Adjust, "adjust"}, {StudyProcedure::Staircase, "staircase"}};
};

struct StudySettings {
    StudyProcedure procedure = StudyProcedure::Adjust;
    double repeats = 0.25;  // share of the blocks that are asked twice, [0, 1]
    double catches = 0.15;  // share that checks the observer, [0, 1)
    int answers = 8;        // to each block of a staircase, > 0
    std::string text = {};  // shown first, in Markdown; empty: nothing
};

// Returns the page, which contains everything and loads nothing.
std::string MakeStudyPage(const Study&, const StudySettings&);

// Reads a text that observers are to see first. Throws Error beginning with the path if it cannot
// be read, is empty or is longer than anybody would read.
std::string ReadStudyText(const std::string& path);

// Returns what a study's page says of the study, with the pictures of the blocks at the last level
// in "references", as data URIs. Throws Error beginning with the path for anything that is not such
// a page.
Json ReadStudyPage(const std::string& path);

}  // namespace lull
