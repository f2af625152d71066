#include "renderer/learning/light_learner.h"

#include <array>

#include "renderer/learning/learner_state.h"

namespace lull {

namespace {

constexpr std::array kRoundEnds = {16, 24, 32, 48, 64};  // samples per pixel
constexpr int kWithout = 1, kCompared = 4;               // rounds

// Cells that the first round records in: 2^kEnvironmentDepth a side of surfaces.
constexpr int kEnvironmentDepth = 6;

constexpr const char* kLightDamaged = "its learned direct light is damaged";
constexpr const char* kLightForeign = "its learned direct light is of another image";

const TileShares& PowerOf(const Scene& scene) {
    return std::get<InfiniteLight>(scene.lights[scene.lights.Environment()]).Tiles()->Shares();
}

void CheckEnvironment(const EnvironmentState& environment, bool isDone) {
    const EnvironmentGuide& guide = environment.guide;
    for (const SpaceTree& tree : guide.trees)
        Require(guide.IsEmpty() ? tree.nodes.empty() : tree.IsValid(guide.leaves.size()),
                kLightDamaged);
    for (const TileShares& leaf : guide.leaves) Require(IsValid(leaf), kLightDamaged);
    const size_t sums = isDone ? 0 : guide.leaves.size() * TileShares::kCount;
    Require(environment.record.sums.size() == sums, kLightDamaged);
}

}  // namespace

bool LearnsEnvironment(const Scene& scene) { return scene.lights.Environment() >= 0; }

bool LearnsLights(const Scene& scene) {
    return scene.lights.Count() > 1 && scene.lights.IsChosenByPlace();
}

LightLearner::LightLearner(const Scene& scene, const LearningOptions&, int64_t)
    : scene(&scene), rounds{.end = kRoundEnds[0]} {}

// Returns false if there is nothing to learn from.
bool LightLearner::BeginToRecord(const Film& film) {
    const double mean = MeanLuminance(film);
    if (!(mean > 0 && mean < double(kInfinity))) return false;
    usual = mean;
    if (LearnsLights(*scene)) {
        choices = LightChoiceGuide(scene->shapes.bounds, scene->lights.Count());
        choiceRecord = LightChoiceRecord(choices);
    }
    if (LearnsEnvironment(*scene)) {
        environment.guide =
            EnvironmentGuide(scene->shapes.bounds, kEnvironmentDepth, PowerOf(*scene));
        environment.record = EnvironmentRecord(environment.guide);
    }
    trial.Begin(film);
    return true;
}

void LightLearner::Learn() {
    if (LearnsLights(*scene)) choices = lull::Learn(choices, choiceRecord, scene->lights);
    if (LearnsEnvironment(*scene)) environment = Refine(environment, PowerOf(*scene), {});
}

// Frees records, and guides that are not used.
void LightLearner::Finish() {
    rounds.end = kNoRoundEnd;
    trial.End();
    choiceRecord = {};
    environment.record = {};
    if (isUsed) return;
    choices = {};
    environment = {};
}

void LightLearner::EndRound(Film* film, const lull::RoundEnd& ended) {
    if (!ended.goesOn || ended.spp != rounds.end) return;
    const int round = rounds.round++;
    if (round < kCompared) rounds.end = kRoundEnds[size_t(rounds.round)];
    if (round == 0) {
        if (!BeginToRecord(*film)) Finish();
        return;
    }
    const double cost = LearnsEnvironment(*scene) ? kCosts.environment : kCosts.lights;
    if (round == kCompared) isUsed = trial.Decide(*film, cost, 0) == Verdict::Pays;
    if (round < kCompared || isUsed) Learn();
    if (round == kCompared) Finish();
}

SampleSpread* LightLearner::SpreadOf(Film* film, const PixelRect& tile) {
    if (rounds.IsDone()) return nullptr;
    if (rounds.round == kWithout) return &trial.tally.unguided[film->TileAt(tile.min)];
    if (rounds.round == kCompared) return &trial.tally.guided[film->TileAt(tile.min)];
    return nullptr;
}

void LightLearner::Apply(PathOptions* paths, PathRecords* records) {
    LearnedLight& learned = paths->learned;
    if (!choices.IsEmpty()) {
        learned.choices = &choices;
        if (!rounds.IsDone()) records->choices = &choiceRecord;
        records->usualForLights = float(usual);
    }
    if (!environment.guide.IsEmpty()) {
        learned.environment = &environment.guide;
        if (rounds.IsDone()) return;
        records->environment = &environment.record;
        records->environmentGuide = &environment.guide;
    }
}

void LightLearner::Describe(GuideFigures* figures) const {
    if (!rounds.IsDone()) return;
    figures->usesDirectLight = isUsed;
    figures->directLight = trial.comparison;
}

void LightLearner::Put(StateWriter* writer) const {
    PutRounds(rounds, writer);
    writer->Put(uint8_t(isUsed));
    writer->Put(usual);
    trial.Put(writer);
    writer->PutVector(choices.sums);
    writer->PutVector(choiceRecord.sums);
    for (const SpaceTree& tree : environment.guide.trees) PutSpaceTree(tree, writer);
    writer->PutVector(environment.guide.leaves);
    writer->PutVector(environment.record.sums);
}

void LightLearner::Get(StateReader* reader, const Film& film) {
    LightLearner taken(*scene, {}, 0);
    taken.rounds = GetRounds(reader, int(kRoundEnds.size()), kLightDamaged);
    taken.isUsed = reader->Get<uint8_t>() != 0;
    taken.usual = reader->Get<double>();
    const bool isDone = taken.rounds.IsDone();
    const auto round = size_t(taken.rounds.round);
    Require(isDone || (round < kRoundEnds.size() && taken.rounds.end == kRoundEnds[round]),
            kLightDamaged);
    Require((isDone || !taken.isUsed) && taken.usual > 0 && taken.usual < double(kInfinity),
            kLightDamaged);
    taken.trial.Get(reader, taken.rounds.Record(), taken.isUsed, film.TileCount(), kLightDamaged,
                    kLightForeign);
    auto sums = reader->GetVector<float>(kLightDamaged);
    taken.choiceRecord.sums = reader->GetVector<SquareSum>(kLightDamaged);
    Require(taken.choiceRecord.sums.size() == (isDone ? 0 : sums.size()), kLightDamaged);
    EnvironmentGuide& guide = taken.environment.guide;
    for (SpaceTree& tree : guide.trees) tree = GetSpaceTree(reader, kLightDamaged);
    guide.leaves = reader->GetVector<TileShares>(kLightDamaged);
    taken.environment.record.sums = reader->GetVector<SquareSum>(kLightDamaged);
    CheckEnvironment(taken.environment, isDone);
    if (!guide.IsEmpty())
        for (SpaceTree& tree : guide.trees) tree.Index();
    Require(guide.IsEmpty() != (taken.HasGuides() && LearnsEnvironment(*scene)) &&
                sums.empty() != (taken.HasGuides() && LearnsLights(*scene)),
            kLightForeign);
    if (!sums.empty()) {
        taken.choices = LightChoiceGuide(scene->shapes.bounds, scene->lights.Count());
        taken.choices.sums = std::move(sums);
        Require(IsValid(taken.choices), kLightForeign);
    }
    *this = std::move(taken);
}

}  // namespace lull
