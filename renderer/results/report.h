// Reports the decisions and the cost of a render.
#pragma once

#include <map>
#include <string>

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"
#include "renderer/results/denoised_image.h"

namespace lull {

// Compares the cost of a render with the cost of every block at the cap.
struct Savings {
    int64_t samples = 0, samplesAtCap = 0;
    double seconds = 0;           // of processors, the criteria's included
    double criterionSeconds = 0;  // of processors, spent on the criteria
    double secondsAtCap = 0;      // estimated from each block's seconds per sample

    // Return the share that was saved, in [0, 1] (seconds: can be negative).
    double SampleShare() const { return Share(double(samples), double(samplesAtCap)); }
    double SecondShare() const { return Share(seconds, secondsAtCap); }

  private:
    static double Share(double taken, double atCap) { return atCap > 0 ? 1 - taken / atCap : 0; }
};

Savings ComputeSavings(const RenderResult&, int cap);

// Returns the report as a JSON text. `warnings` are counts by kind; `denoised` is null where the
// image is the mean of the samples.
std::string MakeReport(const Provenance&, const RenderResult&, int64_t rejectedSamples,
                       const std::map<std::string, int>& warnings, const DenoisedImage* denoised);

}  // namespace lull
