// Writes the stops of the blocks of a render: files next to its image.
#pragma once

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// All write a file whole or not at all, and throw Error.

// Writes a picture of the samples per pixel of each block, in false colours.
void WriteSppMap(const std::string& file, const Provenance&, const RenderResult&);

// Writes a thresholds file (stopping/rules/thresholds.h) with the row of a scene, which is given as
// its file.
void WriteThresholdsOf(const std::string& file, const std::string& scene, std::vector<int> spp);

// Returns the thresholds that repeat a render.
std::vector<int> ThresholdsOf(const Provenance&, const RenderResult&);

}  // namespace lull
