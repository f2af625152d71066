// Writes comparisons: as JSON for programs, as a page for people.
#pragma once

#include "renderer/lab/comparison/comparison.h"
#include "renderer/lab/viewpoints/study.h"
#include "renderer/pages/html_page.h"
#include "renderer/results/report.h"
#include "stopping/lab/observers/observers.h"

namespace lull {

struct ComparisonReport {
    Comparison comparison;
    std::optional<Provenance> provenance;    // of the renders; none for images from files
    std::vector<BlockResult> decisions;      // of the automatic rule; may be empty
    std::vector<BlockHistory> histories;     // for their curves; may be empty
    std::optional<EstimateError> estimates;  // of the seconds to the cap
    std::vector<Verification> verifications;
    std::vector<CurvePoint> curvePoints;  // may be empty
    bool curvesShareReference = false;    // their samples: errors near the cap are understated
    std::map<std::string, int> warnings;
    std::vector<std::string> notes;  // for the reader, a sentence each
    std::string title;
};

// Returns all figures, without pictures. Seconds are of processors unless said otherwise; those to
// the cap are estimated for blocks that were not rendered that far.
Json ComparisonJson(const ComparisonReport&);

// Returns the estimated cost of the blocks up to the cap; a cap and costs must be known.
TotalCost CostAtCap(const Comparison&);

std::string MakeComparisonPage(const ComparisonReport&);

// Writes the page on which people say where they still see noise.

struct StudySettings {
    double repeats = 0.25;  // share of the blocks that are asked twice, [0, 1]
    double catches = 0.15;  // share that checks the observer, [0, 1)
};

// Returns the page, which contains everything and loads nothing.
std::string MakeStudyPage(const Study&, const StudySettings&);

// Returns the data of a study's page, with the pictures of the blocks at the last level in
// "references", as data URIs. Throws Error beginning with the path for anything else.
Json ReadStudyPage(const std::string& path);

// Writes the page of the observers' answers.

// `study` is the result of ReadStudyPage(), or null: then there are tables, but no image.
std::string MakeCollectedPage(const Collected&, const Json& study);

}  // namespace lull
