// Writes comparisons: as JSON for programs, as a page for people.
#pragma once

#include "renderer/lab/comparison/comparison.h"
#include "renderer/pages/html_page.h"

namespace lull {

// Contents of a report of a comparison.
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

}  // namespace lull
