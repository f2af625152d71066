// Builds the next guide from a record.
#pragma once

#include "renderer/guiding/guide_record.h"

namespace lull {

struct RefineOptions {
    double leafVertices = 4000;   // a leaf over space that has seen more is cut
    float quadrantShare = 0.02f;  // a quadrant with more of its tree's light is cut
    size_t maxBytes = 32u << 20;  // of guide and record; leaves are made coarser until they fit
    bool knowsFractions = true;   // else leaves get fraction 0.5, as their cost says nothing yet
};

struct GuideState {
    Guide guide;
    GuideRecord record;  // of all that has been found so far
};

// Returns a guide with the densities of the record, and with trees that have been refined and
// coarsened to suit them. It keeps the recorded light, to which later records add, but not the
// recorded costs, which belong to the old guide.
GuideState Refine(const GuideState& state, const RefineOptions& options);

// Returns the guide alone, with trees no finer than the record.
Guide FreezeGuide(const GuideState& state, const RefineOptions& options);

}  // namespace lull
