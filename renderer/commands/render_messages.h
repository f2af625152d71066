// Prints how a render ended: in words, or as JSON events.
#pragma once

#include <functional>

#include "renderer/commands/render_settings.h"
#include "renderer/commands/time_options.h"
#include "renderer/files/outputs.h"
#include "renderer/render/provenance.h"

namespace lull {

// Prints the summary of a render, of whose samples `rejected` were rejected.
void PrintResult(const RenderSettings&, const Provenance&, const RenderResult&, int64_t rejected);

// Returns a listener that forwards progress. Once a render without denoising is predicted to take
// more than ten minutes, it prints a note on --denoise, one time.
ProgressListener AdviseDenoising(int64_t pixels, const Messages&, ProgressListener listener);

// Returns a callback that prints the stop of a block, as JSON.
std::function<void(int index, const Block&)> StopEvents(RuleTrend::Kind);

// Prints as JSON which files there are and, as the last object, how the render ended.
void SayEnd(const ResultFiles&, const RenderResult&, int64_t rejected);

}  // namespace lull
