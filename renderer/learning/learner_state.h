// Packs and checks what learners have in common.
#pragma once

#include "renderer/guiding/space_tree.h"
#include "renderer/learning/rounds.h"
#include "stopping/base/state.h"

namespace lull {

// Throws std::runtime_error(otherwise) unless the condition holds.
void Require(bool condition, const char* otherwise);

void PutSpaceTree(const SpaceTree&, StateWriter*);
// Returns a tree whose nodes may be anything, and that has to be indexed. Throws
// std::runtime_error(damaged).
SpaceTree GetSpaceTree(StateReader*, const char* damaged);

// Write and read rounds, of which there are at most `most`.
void PutRounds(const Rounds&, StateWriter*);
Rounds GetRounds(StateReader*, int most, const char* damaged);

}  // namespace lull
