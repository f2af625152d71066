#include "renderer/render/environment_learning.h"

#include <stdexcept>

#include "renderer/render/learning_state.h"

namespace lull {

namespace {

constexpr std::array kRoundEnds = {16, 24, 32, 48, 64};  // samples per pixel
constexpr int kByPower = 1, kCompared = 4;               // rounds

// Cells that the first round records in: 2^kEnvironmentDepth a side of surfaces.
constexpr int kEnvironmentDepth = 6;

// Cost of a sample, learned / by power (renderer/docs/guiding.md).
constexpr double kSampleCost = 1.25;

constexpr const char* kEnvironmentDamaged = "its learned environment is damaged";

const TileShares& PowerOf(const Scene& scene) {
    return std::get<InfiniteLight>(scene.lights[scene.lights.Environment()]).Tiles()->Shares();
}

void BeginToRecord(const Scene& scene, const Film& film, EnvironmentLearning* learning) {
    learning->state.guide =
        EnvironmentGuide(scene.shapes.bounds, kEnvironmentDepth, PowerOf(scene));
    learning->state.record = EnvironmentRecord(learning->state.guide);
    learning->tally.unguided = learning->tally.guided = std::vector<SampleSpread>(film.TileCount());
}

// Decides whether learned sampling pays. Returns false if it does not.
bool Decide(const Film& film, EnvironmentLearning* learning) {
    std::vector<TileNoise> noise = learning->tally.Noise(film);
    const GuideComparison c = learning->comparison = learning->tally.Compare(noise);
    learning->tally = {};
    learning->isUsed = (c.variance + 2 * c.error) * kSampleCost < 1;
    if (learning->isUsed) learning->noise = std::move(noise);
    return learning->isUsed;
}

}  // namespace

bool LearnsEnvironment(const Scene& scene, Estimator estimator) {
    return estimator == Estimator::Combined && scene.lights.Environment() >= 0 &&
           MaxDepth(scene.integrator) > 0 && !IsBidirectional(scene.integrator);
}

EnvironmentLearning BeginEnvironment() {
    EnvironmentLearning learning;
    learning.end = kRoundEnds[0];
    return learning;
}

void EndEnvironmentRound(const Scene& scene, const Film& film, EnvironmentLearning* learning) {
    const int round = learning->round++;
    learning->end = round == kCompared ? kNoRoundEnd : kRoundEnds[size_t(learning->round)];
    if (round == 0) {
        BeginToRecord(scene, film, learning);
    } else if (round < kCompared) {
        learning->state = Refine(learning->state, PowerOf(scene), {});
    } else if (Decide(film, learning)) {
        learning->state.guide = Refine(learning->state, PowerOf(scene), {}).guide;
        learning->state.record = {};
    } else {
        learning->state = {};
    }
}

std::vector<SampleSpread>* SpreadsOf(EnvironmentLearning* learning) {
    return learning->round == kByPower                           ? &learning->tally.unguided
           : learning->round == kCompared && !learning->IsDone() ? &learning->tally.guided
                                                                 : nullptr;
}

void SetEnvironment(EnvironmentLearning* learning, PathOptions* paths) {
    if (learning->state.guide.IsEmpty()) return;
    paths->environment = &learning->state.guide;
    if (!learning->IsDone()) paths->environmentRecord = &learning->state.record;
}

void PutEnvironment(const EnvironmentLearning& learning, StateWriter* writer) {
    writer->Put(std::array<int32_t, 2>{learning.round, learning.end});
    writer->Put(uint8_t(learning.isUsed));
    writer->Put(learning.comparison);
    for (const SpaceTree& tree : learning.state.guide.trees) PutSpaceTree(tree, writer);
    writer->PutVector(learning.state.guide.leaves);
    writer->PutVector(learning.state.record.sums);
    PutTally(learning.tally, writer);
    writer->PutVector(learning.noise);
}

EnvironmentLearning GetEnvironment(StateReader* reader) {
    EnvironmentLearning learning;
    const auto refuse = [] { throw std::runtime_error(kEnvironmentDamaged); };
    const auto round = reader->Get<std::array<int32_t, 2>>();
    learning.round = round[0];
    learning.end = round[1];
    learning.isUsed = reader->Get<uint8_t>() != 0;
    learning.comparison = reader->Get<GuideComparison>();
    EnvironmentGuide& guide = learning.state.guide;
    for (SpaceTree& tree : guide.trees) tree = GetSpaceTree(reader, kEnvironmentDamaged);
    guide.leaves = reader->GetVector<TileShares>(kEnvironmentDamaged);
    learning.state.record.sums = reader->GetVector<EnvironmentRecord::Sum>(kEnvironmentDamaged);
    learning.tally = GetTally(reader, kEnvironmentDamaged);
    learning.noise = GetNoise(reader, kEnvironmentDamaged);
    for (SpaceTree& tree : guide.trees) {
        if (guide.IsEmpty() ? !tree.nodes.empty() : !tree.IsValid(guide.leaves.size())) refuse();
        if (!guide.IsEmpty()) tree.Index();
    }
    for (const TileShares& leaf : guide.leaves)
        if (!IsValid(leaf)) refuse();
    const size_t recorded = learning.IsDone() ? 0 : guide.leaves.size() * TileShares::kCount;
    const bool isThere = learning.IsDone() ? learning.isUsed : learning.round > 0;
    if (learning.round < 0 || size_t(learning.round) > kRoundEnds.size() ||
        (!learning.IsDone() && (size_t(learning.round) == kRoundEnds.size() ||
                                learning.end != kRoundEnds[size_t(learning.round)])) ||
        guide.IsEmpty() == isThere || learning.state.record.sums.size() != recorded)
        refuse();
    return learning;
}

}  // namespace lull
