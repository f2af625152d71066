// Writes the page of a bench.
#pragma once

#include "renderer/lab/comparison/bench.h"
#include "renderer/results/report.h"

namespace lull {

// Returns the page: curves of error against effort, and the reference. The first of `samplers` has
// full lines. Visible differences are those on the display.
std::string MakeBenchPage(const std::string& title, const Provenance&,
                          const std::vector<BenchPoint>&, const std::vector<std::string>& samplers,
                          const RgbImage& reference, const DisplayModel&,
                          const std::vector<std::string>& notes);

}  // namespace lull
