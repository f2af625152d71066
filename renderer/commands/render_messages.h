// Prints how a render goes on and ended: in words, or as JSON events.
#pragma once

#include <functional>

#include "renderer/commands/render_settings.h"
#include "renderer/files/outputs.h"
#include "renderer/progress/progress.h"
#include "renderer/render/provenance.h"
#include "renderer/results/denoised_image.h"

namespace lull {

// Prints the summary of a render, of whose samples `rejected` were rejected.
void PrintResult(const RenderSettings&, const Provenance&, const RenderResult&, int64_t rejected);

using ProgressListener = std::function<void(const RenderProgress&)>;

// Returns a listener that forwards all progress and warns, once and as early as possible, where the
// first sample of all `pixels` will take longer than the time that is left.
ProgressListener WarnOfFirstSamples(int64_t pixels, const Messages&, ProgressListener listener);

// Returns a listener that forwards progress. Once a render without denoising is predicted to take
// more than ten minutes, it prints a note on --denoise, one time.
ProgressListener AdviseDenoising(int64_t pixels, const Messages&, ProgressListener listener);

// Returns a callback that prints the stop of a block, as JSON.
std::function<void(int index, const Block&)> StopEvents(RuleTrend::Kind);

// Prints as JSON which files there are and, as the last object, how the render ended.
void SayEnd(const ResultFiles&, const RenderResult&, int64_t rejected);

// DenoiseImage() that reports on stderr how far it is.
template <typename Picture>
DenoisedImage DenoiseWithReports(Picture picture, const PixelRect& region,
                                 const std::vector<Block>& blocks, ProgressStyle style,
                                 DenoiserOptions options = {}) {
    StepPrinter printer("denoising", style, stderr);
    constexpr double kFilter = 0.85;  // of the time: 0.9, or 0.79 of the largest pictures
    options.onShare = [&](double share) { printer.Print(kFilter * share); };
    return DenoiseImage(std::move(picture), region, blocks, options);
}

// Prints how long denoising took and how clean the picture is, unless `quiet`.
void PrintDenoised(const DenoisedImage&, double seconds, bool quiet, const Messages& = {},
                   double accepted = kAcceptedDifference);

// Prints the path of a sample, bounce by bounce. Throws UsageError for a pixel outside the image.
void PrintPath(const Vec2i& pixel, int sample, const RenderSettings&, const Description&,
               const Scene&);

}  // namespace lull
