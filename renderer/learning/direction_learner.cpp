#include "renderer/learning/direction_learner.h"

#include <array>
#include <utility>

#include "renderer/learning/learner_state.h"

namespace lull {

namespace {

// Samples per pixel of the first two rounds of `on`; each of the others has twice the last one's.
constexpr int kFirstRound = 4;
// Learning ends when so many paths, or samples per pixel, were recorded: more do not make a better
// guide. With a clock it ends earlier.
constexpr int64_t kPathsEnough = 16 << 20;
constexpr int kMost = 500, kMostWithClock = 60;
constexpr int kMostRounds = 23;

// A leaf is cut when it has seen more vertices, times the square root of the millions of paths that
// were recorded: so a guide gets finer in place and surer in direction alike (Müller 2017, section
// 5.3).
constexpr double kLeafVertices = 4000;

// Of auto: how many paths a round has, in samples per pixel at least and at most; and the rounds
// that can go by before it begins.
constexpr int64_t kPathsOfRound = 1 << 20;
constexpr int kShortest = 4, kLongest = 16, kLeadOfAuto = 16;

// Cells that the first round has to record in.
constexpr int kFirstDepth = 9, kFirstQuadDepth = 3;

constexpr const char* kGuideDamaged = "its guide is damaged";
constexpr const char* kGuideForeign = "its guide is of another image";

void PutGuide(const Guide& guide, StateWriter* writer) {
    PutSpaceTree(guide.space, writer);
    writer->PutVector(guide.leaves);
    writer->PutVector(guide.quads);
}

void CheckQuadtree(const Guide& guide, const GuideLeaf& leaf) {
    Require(leaf.nodeCount > 0 && leaf.nodeCount <= guide.quads.size() &&
                leaf.firstNode <= guide.quads.size() - leaf.nodeCount,
            kGuideDamaged);
    for (uint32_t i = 0; i < leaf.nodeCount; ++i) {
        const QuadNode& node = guide.quads[leaf.firstNode + i];
        int sum = 0;
        for (const uint16_t share : node.share) {
            Require(share > 0, kGuideDamaged);
            sum += share;
        }
        Require(sum == QuadNode::kWhole && node.isCut <= 0b1111, kGuideDamaged);
        Require(!node.isCut || (node.children > i && node.Child(4) <= leaf.nodeCount),
                kGuideDamaged);
    }
}

// Finds indices that would take a walk through the trees out of bounds.
void CheckSaved(const Guide& guide) {
    if (guide.space.nodes.empty())
        return Require(guide.leaves.empty() && guide.quads.empty(), kGuideDamaged);
    Require(guide.space.IsValid(guide.leaves.size()), kGuideDamaged);
    for (const GuideLeaf& leaf : guide.leaves) {
        Require(leaf.fraction >= 0 && leaf.fraction < 1 && leaf.depth <= SpaceTree::kMaxDepth,
                kGuideDamaged);
        CheckQuadtree(guide, leaf);
    }
}

Guide GetGuide(StateReader* reader) {
    Guide guide;
    guide.space = GetSpaceTree(reader, kGuideDamaged);
    guide.leaves = reader->GetVector<GuideLeaf>(kGuideDamaged);
    guide.quads = reader->GetVector<QuadNode>(kGuideDamaged);
    CheckSaved(guide);
    if (!guide.space.nodes.empty()) guide.space.Index();
    return guide;
}

void PutFigures(const GuideFigures& f, StateWriter* writer) {
    writer->Put(uint8_t(f.isUsed));
    writer->PutVector(std::vector<char>(f.why.begin(), f.why.end()));
    writer->Put(std::array<int32_t, 4>{f.rounds, f.from, f.samples, f.leaves});
    writer->Put(f.bytes);
}

GuideFigures GetFigures(StateReader* reader) {
    GuideFigures f;
    f.isUsed = reader->Get<uint8_t>() != 0;
    const auto why = reader->GetVector<char>(kGuideDamaged);
    f.why.assign(why.begin(), why.end());
    const auto counts = reader->Get<std::array<int32_t, 4>>();
    f.rounds = counts[0];
    f.from = counts[1];
    f.samples = counts[2];
    f.leaves = counts[3];
    f.bytes = reader->Get<int64_t>();
    return f;
}

}  // namespace

DirectionLearner::DirectionLearner(const Scene& scene, const LearningOptions& options,
                                   int64_t pixels)
    : scene(&scene),
      options(options),
      pace(int(
          std::clamp<int64_t>(kPathsOfRound / std::max<int64_t>(1, pixels), kShortest, kLongest))) {
    figures.why = "no block took enough samples";
    rounds.end = RoundLength(0);
}

int DirectionLearner::RoundLength(int round) const {
    if (options.mode == GuideMode::On) return kFirstRound << std::max(0, round - 1);
    if (round == 0) return options.isShort ? kFirstRound : kLeadOfAuto * pace;
    return decided > 0 ? pace << (round - decided) : pace;
}

SampleSpread* DirectionLearner::SpreadOf(Film* film, const PixelRect& tile) {
    if (!IsTrial()) return nullptr;
    if (rounds.round == 1) return &trial.tally.unguided[film->TileAt(tile.min)];
    if (rounds.round >= kFirstDecision) return &trial.tally.guided[film->TileAt(tile.min)];
    return nullptr;
}

void DirectionLearner::EndRound(Film* film, const lull::RoundEnd& ended) {
    if (!ended.goesOn || ended.spp != rounds.end) return;
    const int64_t taken = film->SampleCount();
    if (rounds.round > 0) {
        paths += taken - samples;
        figures.samples += RoundLength(rounds.round);
        figures.rounds = rounds.round;
    }
    const bool goesOn = rounds.round == 0 ? BeginToRecord(*film) : Learn(*film);
    ++rounds.round;
    samples = taken;
    if (goesOn) rounds.end += RoundLength(rounds.round);
}

// Returns false if learning is done; so does Learn().
bool DirectionLearner::BeginToRecord(const Film& film) {
    usual = MeanLuminance(film);
    if (!(usual > 0 && usual < double(kInfinity)))
        return Finish(false, "the first samples found no light");
    state.guide = Guide(scene->shapes.bounds, kFirstDepth, kFirstQuadDepth);
    state.record = GuideRecord(state.guide);
    figures.from = rounds.end;
    if (options.mode == GuideMode::Auto) trial.Begin(film);
    return true;
}

bool DirectionLearner::Learn(const Film& film) {
    if (IsTrial() && rounds.round >= kFirstDecision) {
        const Verdict verdict = trial.Decide(film, 0, kCosts.guidedVertex);
        if (verdict == Verdict::Pays)
            decided = rounds.round;
        else if (verdict == Verdict::DoesNotPay || rounds.round >= kLastDecision)
            return Finish(false,
                          "variance times work is not significantly below that without guiding");
    }
    const bool isUsed = options.mode == GuideMode::On || decided > 0;
    const int most = options.isShort ? kMostWithClock : kMost;
    const bool isLast = isUsed && (paths >= kPathsEnough || figures.samples >= most);
    // The old state and the new exist at the same time. The best fraction of guided paths is known
    // only for a guide that has been used.
    const double millions = double(paths) / double(1 << 20);
    const RefineOptions refine{.leafVertices = kLeafVertices * std::sqrt(std::max(1., millions)),
                               .maxBytes = (size_t(options.megabytes) << 20) / 2,
                               .knowsFractions = rounds.round > 1};
    if (isLast)
        guide = FreezeGuide(state, refine);
    else
        state = Refine(state, refine);
    const Guide& next = isLast ? guide : state.guide;
    figures.isUsed = isUsed;
    figures.bytes = int64_t(next.Bytes());
    figures.leaves = int(next.leaves.size());
    figures.why = options.mode == GuideMode::On ? "as asked for"
                  : isUsed ? "variance times work is below that without guiding"
                           : "too few samples to decide";
    return !isLast || Finish(true, figures.why);
}

bool DirectionLearner::Finish(bool isUsed, const std::string& why) {
    figures.isUsed = isUsed;
    figures.why = why;
    state = {};
    trial.End();
    rounds.end = kNoRoundEnd;
    return false;
}

void DirectionLearner::Apply(PathOptions* paths, PathRecords* records) {
    if (rounds.IsDone()) {
        if (figures.isUsed) paths->guide = &guide;
    } else if (rounds.round > 0) {
        paths->guide = &state.guide;
        records->directions = &state.record;
        records->usualForDirections = float(usual);
    }
}

void DirectionLearner::Describe(GuideFigures* of) const {
    const GuideFigures before = *of;
    *of = figures;
    of->comparison = trial.comparison;
    of->seconds = before.seconds;
    of->directLight = before.directLight;
    of->usesDirectLight = before.usesDirectLight;
}

void DirectionLearner::Put(StateWriter* writer) const {
    PutRounds(rounds, writer);
    writer->Put(int32_t(decided));
    writer->Put(usual);
    writer->Put(std::array<int64_t, 2>{paths, samples});
    PutFigures(figures, writer);
    PutGuide(guide, writer);
    PutGuide(state.guide, writer);
    writer->PutVector(state.record.sums);
    writer->PutVector(state.record.leaves);
    trial.Put(writer);
}

void DirectionLearner::Get(StateReader* reader, const Film& film) {
    DirectionLearner taken = *this;
    taken.rounds = GetRounds(reader, kMostRounds, kGuideDamaged);
    taken.decided = reader->Get<int32_t>();
    taken.usual = reader->Get<double>();
    const auto counts = reader->Get<std::array<int64_t, 2>>();
    taken.paths = counts[0];
    taken.samples = counts[1];
    taken.figures = GetFigures(reader);
    taken.guide = GetGuide(reader);
    taken.state.guide = GetGuide(reader);
    GuideRecord& record = taken.state.record;
    record.sums = reader->GetVector<uint64_t>(kGuideDamaged);
    record.leaves = reader->GetVector<GuideRecord::LeafSums>(kGuideDamaged);
    taken.trial = {};
    const bool pays = options.mode == GuideMode::Auto && taken.decided > 0;
    taken.trial.Get(reader, taken.IsTrial(), pays, film.TileCount(), kGuideDamaged, kGuideForeign);
    const Guide& recorded = taken.state.guide;
    Require(
        record.sums.size() == 4 * recorded.quads.size() &&
            record.leaves.size() == recorded.leaves.size() &&
            taken.rounds.Record() != recorded.space.nodes.empty() &&
            (taken.rounds.IsDone() && taken.figures.isUsed) != taken.guide.space.nodes.empty() &&
            taken.decided >= 0 && taken.decided <= taken.rounds.round &&
            (!taken.rounds.Record() || taken.usual > 0),
        kGuideDamaged);
    *this = std::move(taken);
}

}  // namespace lull
