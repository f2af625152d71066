// The remaining error of denoised images, and messages of the commands that denoise.
#pragma once

#include <string>
#include <vector>

#include "renderer/commands/command.h"
#include "renderer/denoise/visible_error.h"
#include "renderer/image/grade.h"
#include "renderer/progress/progress.h"
#include "renderer/render/render.h"
#include "renderer/results/denoised_image.h"
#include "stopping/rules/rule.h"

namespace lull {

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

// Sets the visible error of blocks that the rule `denoised` has stopped to that by which it did.
// Theirs are still the same samples, which the picture in the end filters more carefully: its own
// estimate, equally rough, may be above the threshold.
void KeepDecisions(const RenderResult&, DenoisedImage*);

// Removes the error estimates of blocks with too few samples for one, and sets the error of their
// pixels to the largest. Returns the number of these blocks.
int RemoveUnknownErrors(const RenderResult&, const PixelRect& region, DenoisedImage*);

// Prints how long denoising took and how clean the picture is, unless `quiet`.
void PrintDenoised(const DenoisedImage&, double seconds, bool quiet, const Messages& = {},
                   double accepted = kAcceptedDifference);

// Shows the denoiser and the rules a render as graded pictures do.

// Returns the grades for the denoiser.
std::vector<Grading> GradingsOf(const std::vector<Grade>&);

// Returns them in words, with semicolons between them.
std::string NamesOf(const std::vector<Grade>&);

// Returns the maker of criteria that see blocks as the grades show them, unless the rule sees to
// that itself, or only counts.
CriterionMaker MakeGradedCriteria(const Rule&, const std::vector<Grade>&);

}  // namespace lull
