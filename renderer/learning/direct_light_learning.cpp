#include "renderer/learning/direct_light_learning.h"

#include <array>
#include <stdexcept>

#include "renderer/learning/learning_state.h"

namespace lull {

namespace {

constexpr std::array kRoundEnds = {16, 24, 32, 48, 64};  // samples per pixel
constexpr int kWithout = 1, kCompared = 4;               // rounds

// Cells that the first round records in: 2^kEnvironmentDepth a side of surfaces.
constexpr int kEnvironmentDepth = 6;

// Cost of a sample, learned / without, where there is an environment map, and where there are
// lights alone: finding the probabilities, and shadow rays that are no longer occluded early.
constexpr double kCostOfEnvironment = 1.25, kCostOfLights = 1.15;

constexpr const char* kDirectLightDamaged = "its learned direct light is damaged";

bool LearnsEnvironment(const Scene& scene) { return scene.lights.Environment() >= 0; }

bool LearnsLights(const Scene& scene) {
    return scene.lights.Count() > 1 && scene.lights.IsChosenByPlace();
}

const TileShares& PowerOf(const Scene& scene) {
    return std::get<InfiniteLight>(scene.lights[scene.lights.Environment()]).Tiles()->Shares();
}

// Returns false if there is nothing to learn from.
bool BeginToRecord(const Scene& scene, const Film& film, DirectLightLearning* learning) {
    learning->usual = MeanLuminance(film);
    if (!(learning->usual > 0 && learning->usual < double(kInfinity))) return false;
    if (LearnsLights(scene)) {
        learning->lights = LightChoiceGuide(scene.shapes.bounds, scene.lights.Count());
        learning->lightRecord = LightChoiceRecord(learning->lights);
    }
    if (LearnsEnvironment(scene)) {
        learning->environment.guide =
            EnvironmentGuide(scene.shapes.bounds, kEnvironmentDepth, PowerOf(scene));
        learning->environment.record = EnvironmentRecord(learning->environment.guide);
    }
    learning->tally.unguided = learning->tally.guided = std::vector<SampleSpread>(film.TileCount());
    return true;
}

void Learn(const Scene& scene, DirectLightLearning* learning) {
    if (LearnsLights(scene))
        learning->lights = Learn(learning->lights, learning->lightRecord, scene.lights);
    if (LearnsEnvironment(scene))
        learning->environment = Refine(learning->environment, PowerOf(scene), {});
}

void Decide(const Scene& scene, const Film& film, DirectLightLearning* learning) {
    std::vector<TileNoise> noise = learning->tally.Noise(film);
    const GuideComparison c = learning->comparison = learning->tally.Compare(noise);
    learning->isUsed = (c.variance + 2 * c.error) *
                           (LearnsEnvironment(scene) ? kCostOfEnvironment : kCostOfLights) <
                       1;
    if (learning->isUsed) learning->noise = std::move(noise);
}

// Frees records, and guides that are not used.
void Finish(DirectLightLearning* learning) {
    learning->end = kNoRoundEnd;
    learning->tally = {};
    learning->lightRecord = {};
    learning->environment.record = {};
    if (learning->isUsed) return;
    learning->lights = {};
    learning->environment = {};
}

}  // namespace

bool LearnsDirectLight(const Scene& scene, Estimator estimator) {
    return estimator == Estimator::Combined && MaxDepth(scene.integrator) > 0 &&
           !IsBidirectional(scene.integrator) && (LearnsEnvironment(scene) || LearnsLights(scene));
}

DirectLightLearning BeginDirectLight() {
    DirectLightLearning learning;
    learning.end = kRoundEnds[0];
    return learning;
}

void EndDirectLightRound(const Scene& scene, const Film& film, DirectLightLearning* learning) {
    const int round = learning->round++;
    if (round < kCompared) learning->end = kRoundEnds[size_t(learning->round)];
    if (round == 0) {
        if (!BeginToRecord(scene, film, learning)) Finish(learning);
        return;
    }
    if (round == kCompared) Decide(scene, film, learning);
    if (round < kCompared || learning->isUsed) Learn(scene, learning);
    if (round == kCompared) Finish(learning);
}

std::vector<SampleSpread>* SpreadsOf(DirectLightLearning* learning) {
    if (learning->IsDone()) return nullptr;
    return learning->round == kWithout    ? &learning->tally.unguided
           : learning->round == kCompared ? &learning->tally.guided
                                          : nullptr;
}

void SetDirectLight(DirectLightLearning* learning, LearnedLight* learned) {
    const bool records = !learning->IsDone();
    if (!learning->lights.IsEmpty()) {
        learned->lights = &learning->lights;
        if (records) learned->lightRecord = &learning->lightRecord;
        learned->usual = float(learning->usual);
    }
    if (!learning->environment.guide.IsEmpty()) {
        learned->environment = &learning->environment.guide;
        if (records) learned->environmentRecord = &learning->environment.record;
    }
}

void PutDirectLight(const DirectLightLearning& learning, StateWriter* writer) {
    writer->Put(std::array<int32_t, 2>{learning.round, learning.end});
    writer->Put(uint8_t(learning.isUsed));
    writer->Put(learning.comparison);
    writer->Put(learning.usual);
    writer->PutVector(learning.lights.sums);
    writer->PutVector(learning.lightRecord.sums);
    for (const SpaceTree& tree : learning.environment.guide.trees) PutSpaceTree(tree, writer);
    writer->PutVector(learning.environment.guide.leaves);
    writer->PutVector(learning.environment.record.sums);
    PutTally(learning.tally, writer);
    writer->PutVector(learning.noise);
}

DirectLightLearning GetDirectLight(StateReader* reader) {
    DirectLightLearning learning;
    const auto refuse = [] { throw std::runtime_error(kDirectLightDamaged); };
    const auto round = reader->Get<std::array<int32_t, 2>>();
    learning.round = round[0];
    learning.end = round[1];
    learning.isUsed = reader->Get<uint8_t>() != 0;
    learning.comparison = reader->Get<GuideComparison>();
    learning.usual = reader->Get<double>();
    learning.lights.sums = reader->GetVector<float>(kDirectLightDamaged);
    learning.lightRecord.sums = reader->GetVector<SquareSum>(kDirectLightDamaged);
    EnvironmentGuide& guide = learning.environment.guide;
    for (SpaceTree& tree : guide.trees) tree = GetSpaceTree(reader, kDirectLightDamaged);
    guide.leaves = reader->GetVector<TileShares>(kDirectLightDamaged);
    learning.environment.record.sums = reader->GetVector<SquareSum>(kDirectLightDamaged);
    learning.tally = GetTally(reader, kDirectLightDamaged);
    learning.noise = GetNoise(reader, kDirectLightDamaged);
    for (SpaceTree& tree : guide.trees) {
        if (guide.IsEmpty() ? !tree.nodes.empty() : !tree.IsValid(guide.leaves.size())) refuse();
        if (!guide.IsEmpty()) tree.Index();
    }
    for (const TileShares& leaf : guide.leaves)
        if (!IsValid(leaf)) refuse();
    const bool isDone = learning.IsDone();
    if (learning.round < 0 || size_t(learning.round) > kRoundEnds.size() ||
        (!isDone && (size_t(learning.round) == kRoundEnds.size() ||
                     learning.end != kRoundEnds[size_t(learning.round)])) ||
        (learning.isUsed && !isDone) ||
        learning.lightRecord.sums.size() != (isDone ? 0 : learning.lights.sums.size()) ||
        learning.environment.record.sums.size() !=
            (isDone ? 0 : guide.leaves.size() * TileShares::kCount) ||
        !(learning.usual > 0 && learning.usual < double(kInfinity)))
        refuse();
    return learning;
}

bool Complete(const Scene& scene, bool learns, size_t tiles, DirectLightLearning* learning) {
    const bool hasBegun = learning->round > 0 || !learning->IsDone();
    const bool hasGuides = learning->IsDone() ? learning->isUsed : learning->round > 0;
    const size_t spreads = !learning->IsDone() && learning->round > 0 ? tiles : 0;
    if (hasBegun != learns || learning->tally.unguided.size() != spreads ||
        learning->tally.guided.size() != spreads ||
        learning->noise.size() != (learning->isUsed ? tiles : 0) ||
        learning->environment.guide.IsEmpty() == (hasGuides && LearnsEnvironment(scene)) ||
        learning->lights.IsEmpty() == (hasGuides && LearnsLights(scene)))
        return false;
    if (learning->lights.IsEmpty()) return true;
    LightChoiceGuide lights(scene.shapes.bounds, scene.lights.Count());
    lights.sums = std::move(learning->lights.sums);
    learning->lights = std::move(lights);
    return IsValid(learning->lights);
}

}  // namespace lull
