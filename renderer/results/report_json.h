// JSON that reports have in common; for those .cpp files that write reports.
#pragma once

#include <nlohmann/json.hpp>

#include "renderer/results/report.h"

namespace lull {

using Json = nlohmann::ordered_json;

Json RectJson(const PixelRect&);
Json ProvenanceJson(const Provenance&);
// Lists decisions by column, which takes a tenth of the size of an object for each.
Json DecisionsJson(const std::vector<BlockDecision>&);
// Returns the report as JSON; MakeReport() writes it.
Json ReportJson(const Provenance&, const RenderResult&, int64_t rejectedSamples,
                const std::map<std::string, int>& warnings, const DenoisedImage*);

// Returns the text; bytes of file names that are not UTF-8 are replaced.
std::string Dump(const Json&);

}  // namespace lull
