// Writes the page of the observers' answers.
#pragma once

#include "renderer/results/report_json.h"
#include "stopping/lab/observers/observers.h"

namespace lull {

// Returns the page. `study` is the result of ReadStudyPage() for the viewpoint, or null: then there
// are tables, but no image.
std::string MakeCollectedPage(const Collected&, const Json& study);

}  // namespace lull
