// Estimates what a render whose time was up still lacks.
#pragma once

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// Holds a block that has not stopped.
struct NoisyBlock {
    int block;             // its index in the list of all
    double noise;          // visible, in lightness of 0 to 100
    int neededSpp;         // at which it would probably stop; at most the cap
    double neededSeconds;  // of processors, until then
};

// Returns the blocks that have not stopped, the noisiest first. Rules that count samples say where
// a block will stop; otherwise noise is taken to fall as 1 / sqrt(spp), to the threshold of
// `lnoise`, or to the median noise of the blocks that the rule has stopped, or to the default of
// `lnoise` if there are none. For results of a render with a clock.
std::vector<NoisyBlock> FindShortfall(const Provenance&, const RenderResult&);

// Returns the wall-clock seconds that all of them need, at the speed of the render.
double NeededSeconds(const std::vector<NoisyBlock>&, const RenderResult&);

}  // namespace lull
