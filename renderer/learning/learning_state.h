// Packs the parts of learning that guides of directions and of lights share. Get...()
// throw std::runtime_error(damaged).
#pragma once

#include "renderer/guiding/space_tree.h"
#include "renderer/learning/guide_tally.h"
#include "stopping/base/state.h"

namespace lull {

void PutSpaceTree(const SpaceTree&, StateWriter*);
// Returns a tree whose nodes may be anything, and that has to be indexed.
SpaceTree GetSpaceTree(StateReader*, const char* damaged);

void PutTally(const GuideTally&, StateWriter*);
GuideTally GetTally(StateReader*, const char* damaged);

// Returns the noise of tiles, which PutVector() has written: finite.
std::vector<TileNoise> GetNoise(StateReader*, const char* damaged);

}  // namespace lull
