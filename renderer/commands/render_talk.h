// Prints how a render ended: in words, or as JSON events.
#pragma once

#include <functional>

#include "renderer/commands/render_settings.h"
#include "renderer/files/result_files.h"
#include "renderer/render/provenance.h"

namespace lull {

// Prints what came of a render, as far as it is to be said; of its samples so many were `rejected`.
void PrintResult(const RenderSettings&, const Provenance&, const RenderResult&, int64_t rejected);

// Returns what says of a block that it has stopped, as JSON.
std::function<void(int index, const Block&)> StopEvents(RuleTrend::Kind);

// Prints as JSON which files there are and, as the last object, how the render ended.
void SayEnd(const ResultFiles&, const RenderResult&, int64_t rejected);

}  // namespace lull
