#include "renderer/learning/learning_state.h"

#include <stdexcept>

namespace lull {

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

void PutTally(const GuideTally& tally, StateWriter* writer) {
    writer->PutVector(tally.unguided);
    writer->PutVector(tally.guided);
}

GuideTally GetTally(StateReader* reader, const char* damaged) {
    GuideTally tally;
    tally.unguided = reader->GetVector<SampleSpread>(damaged);
    tally.guided = reader->GetVector<SampleSpread>(damaged);
    return tally;
}

std::vector<TileNoise> GetNoise(StateReader* reader, const char* damaged) {
    std::vector<TileNoise> noise = reader->GetVector<TileNoise>(damaged);
    for (const TileNoise& tile : noise)
        if (!(tile.unguided >= 0 && tile.guided >= 0 && tile.unguided + tile.guided < kInfinity))
            throw std::runtime_error(damaged);
    return noise;
}

}  // namespace lull
