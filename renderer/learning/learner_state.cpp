#include "renderer/learning/learner_state.h"

#include <array>
#include <stdexcept>

namespace lull {

void Require(bool condition, const char* otherwise) {
    if (!condition) throw std::runtime_error(otherwise);
}

void PutSpaceTree(const SpaceTree& tree, StateWriter* writer) {
    writer->Put(std::array<float, 4>{tree.lower.x(), tree.lower.y(), tree.lower.z(), tree.side});
    writer->PutVector(tree.nodes);
}

SpaceTree GetSpaceTree(StateReader* reader, const char* damaged) {
    SpaceTree tree;
    const auto cube = reader->Get<std::array<float, 4>>();
    tree.lower = Vec3f(cube[0], cube[1], cube[2]);
    tree.side = cube[3];
    tree.nodes = reader->GetVector<uint32_t>(damaged);
    return tree;
}

void PutRounds(const Rounds& rounds, StateWriter* writer) {
    writer->Put(std::array<int32_t, 2>{rounds.round, rounds.end});
}

Rounds GetRounds(StateReader* reader, int most, const char* damaged) {
    const auto values = reader->Get<std::array<int32_t, 2>>();
    const Rounds rounds{values[0], values[1]};
    Require(rounds.round >= 0 && rounds.round <= most && rounds.end > 0, damaged);
    return rounds;
}

}  // namespace lull
