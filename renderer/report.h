// Writes down what a render did and from what it was made.
#pragma once

#include <map>
#include <string>

#include "renderer/render.h"

namespace lull {

// Says from what an image was made.
struct Provenance {
    std::string version;
    std::string scene;  // the file, as given
    uint64_t seed = 0;
    SamplerKind sampler = SamplerKind::Sobol;
    Estimator estimator = Estimator::Combined;
    std::string criterion, checksum;  // the stopping rule and that of its file, if any
    ScheduleOptions schedule;
    int maxDepth = 0;
    int threads = 0;  // 0: all
    bool substitute = false;
    Vec2i resolution = {0, 0};
    PixelRect crop;
};

std::string NameOf(SamplerKind);
std::string NameOf(Estimator);

// Compares what a render took with what it would have taken with every block at the cap.
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

// Returns the report as a JSON text. `warnings` are counts by kind.
std::string MakeReport(const Provenance&, const RenderResult&, int64_t rejectedSamples,
                       const std::map<std::string, int>& warnings);

}  // namespace lull
