// Writes the page on which people say where they still see noise.
#pragma once

#include "renderer/lab/viewpoints/study.h"
#include "renderer/results/report.h"
#include "stopping/lab/observers/observers.h"

namespace lull {

struct StudySettings {
    double repeats = 0.25;  // share of the blocks that are asked twice, [0, 1]
    double catches = 0.15;  // share that checks the observer, [0, 1)
};

// Returns the page, which contains everything and loads nothing.
std::string MakeStudyPage(const Study&, const StudySettings&);

// Returns the data of a study's page, with the pictures of the blocks at the last level in
// "references", as data URIs. Throws Error beginning with the path for anything that is not such a
// page.
Json ReadStudyPage(const std::string& path);

// Writes the page of the observers' answers.

// Returns the page. `study` is the result of ReadStudyPage() for the viewpoint, or null: then there
// are tables, but no image.
std::string MakeCollectedPage(const Collected&, const Json& study);

}  // namespace lull
