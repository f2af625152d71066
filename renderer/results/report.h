// Reports the decisions and the cost of a render.
#pragma once

#include <nlohmann/json.hpp>

#include <map>
#include <string>

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"
#include "renderer/results/denoised_image.h"

namespace lull {

// Compares the cost of a render with the cost of every block at one sample count, such as the cap.
struct Savings {
    int64_t samples = 0, samplesAtCount = 0;
    double seconds = 0;           // of processors, the criteria's included
    double criterionSeconds = 0;  // of processors, spent on the criteria
    double secondsAtCount = 0;    // estimated from each block's seconds per sample

    // Return the share that was saved, in [0, 1] (seconds: can be negative).
    double SampleShare() const { return Share(double(samples), double(samplesAtCount)); }
    double SecondShare() const { return Share(seconds, secondsAtCount); }

  private:
    static double Share(double taken, double whole) { return whole > 0 ? 1 - taken / whole : 0; }
};

Savings ComputeSavings(const RenderResult&, int spp);

// Writes the stops of the blocks of a render: files next to its image.

// All write a file whole or not at all, and throw Error.

// Writes a picture of the samples per pixel of each block, in false colours.
void WriteSppMap(const std::string& file, const Provenance&, const RenderResult&);

// Writes a thresholds file (stopping/rules/thresholds.h) with the row of a scene's file.
void WriteThresholdsOf(const std::string& file, const std::string& scene, std::vector<int> spp);

std::vector<int> ThresholdsOf(const Provenance&, const RenderResult&);

// JSON that reports have in common; for those .cpp files that write reports.

using Json = nlohmann::ordered_json;

Json RectJson(const PixelRect&);
Json ProvenanceJson(const Provenance&);
// Lists decisions by column, which takes a tenth of the size of an object for each.
Json DecisionsJson(const std::vector<BlockDecision>&);
// `warnings` are counts by kind; `denoised` is null where the image is the mean of the samples.
Json ReportJson(const Provenance&, const RenderResult&, int64_t rejectedSamples,
                const std::map<std::string, int>& warnings, const DenoisedImage*);

// Returns the text; bytes of file names that are not UTF-8 are replaced.
std::string Dump(const Json&);

}  // namespace lull
