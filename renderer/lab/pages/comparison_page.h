// Writes comparisons: as JSON for programs, as a page for people.
#pragma once

#include "renderer/lab/comparison/verification.h"
#include "renderer/pages/html_page.h"

namespace lull {

// What a report of a comparison contains.
struct ComparisonReport {
    Comparison comparison;
    std::optional<Provenance> provenance;    // of what was rendered; none for images from files
    std::vector<BlockResult> decisions;      // of the automatic rule; may be empty
    std::vector<BlockHistory> histories;     // for their curves; may be empty
    std::optional<EstimateError> estimates;  // of the seconds to the cap
    std::vector<Verification> verifications;
    std::map<std::string, int> warnings;
    std::vector<std::string> notes;  // what a reader should know, a sentence each
    std::string title;
};

// Returns the figures of an image; what is infinite or not known is null.
Json FiguresJson(const ErrorFigures&);

// Returns the viewing conditions of visible differences, and the visibility threshold.
Json ViewingJson(const DisplayModel&);

// Returns all figures, without pictures. Seconds are of processors unless said otherwise; those to
// the cap are estimated for blocks that were not rendered that far.
Json ComparisonJson(const ComparisonReport&);

// Returns what the blocks would take up to the cap; a cap and costs must be known.
TotalCost CostAtCap(const Comparison&);

std::string MakeComparisonPage(const ComparisonReport&);

}  // namespace lull
