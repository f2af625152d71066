#include "renderer/learning/guide_learning_state.h"

#include <stdexcept>

#include "renderer/learning/learning_state.h"

namespace lull {

namespace {

constexpr uint32_t kTag = 0x36756c67;

constexpr const char* kDamaged = "its guide is damaged";

[[noreturn]] void Refuse() { throw std::runtime_error(kDamaged); }

void PutGuide(const Guide& guide, StateWriter* writer) {
    PutSpaceTree(guide.space, writer);
    writer->PutVector(guide.leaves);
    writer->PutVector(guide.quads);
}

void CheckQuadtree(const Guide& guide, const GuideLeaf& leaf) {
    if (leaf.nodeCount == 0 || leaf.nodeCount > guide.quads.size() ||
        leaf.firstNode > guide.quads.size() - leaf.nodeCount)
        Refuse();
    for (uint32_t i = 0; i < leaf.nodeCount; ++i) {
        const QuadNode& node = guide.quads[leaf.firstNode + i];
        int sum = 0;
        for (const uint16_t share : node.share) {
            if (share == 0) Refuse();
            sum += share;
        }
        if (sum != QuadNode::kWhole || node.isCut > 0b1111) Refuse();
        if (node.isCut && (node.children <= i || node.Child(4) > leaf.nodeCount)) Refuse();
    }
}

// Finds indices that would take a walk through the trees out of bounds.
void CheckGuide(const Guide& guide) {
    if (guide.space.nodes.empty()) {
        if (!guide.leaves.empty() || !guide.quads.empty()) Refuse();
        return;
    }
    if (!guide.space.IsValid(guide.leaves.size())) Refuse();
    for (const GuideLeaf& leaf : guide.leaves) {
        if (!(leaf.fraction >= 0 && leaf.fraction < 1) || leaf.depth > SpaceTree::kMaxDepth)
            Refuse();
        CheckQuadtree(guide, leaf);
    }
}

Guide GetGuide(StateReader* reader) {
    Guide guide;
    guide.space = GetSpaceTree(reader, kDamaged);
    guide.leaves = reader->GetVector<GuideLeaf>(kDamaged);
    guide.quads = reader->GetVector<QuadNode>(kDamaged);
    CheckGuide(guide);
    if (!guide.space.nodes.empty()) guide.space.Index();
    return guide;
}

void PutFigures(const GuideFigures& f, StateWriter* writer) {
    writer->Put(uint8_t(f.isUsed));
    writer->PutVector(std::vector<char>(f.why.begin(), f.why.end()));
    writer->Put(std::array<int32_t, 4>{f.rounds, f.from, f.samples, f.leaves});
    writer->Put(f.bytes);
    writer->Put(f.seconds);
    writer->Put(f.comparison);
    writer->Put(std::array<uint8_t, 2>{f.directLight.has_value(), f.usesDirectLight});
    writer->Put(f.directLight.value_or(GuideComparison()));
}

GuideFigures GetFigures(StateReader* reader) {
    GuideFigures f;
    f.isUsed = reader->Get<uint8_t>() != 0;
    const auto why = reader->GetVector<char>(kDamaged);
    f.why.assign(why.begin(), why.end());
    const auto counts = reader->Get<std::array<int32_t, 4>>();
    f.rounds = counts[0];
    f.from = counts[1];
    f.samples = counts[2];
    f.leaves = counts[3];
    f.bytes = reader->Get<int64_t>();
    f.seconds = reader->Get<double>();
    f.comparison = reader->Get<GuideComparison>();
    const auto directLight = reader->Get<std::array<uint8_t, 2>>();
    const auto compared = reader->Get<GuideComparison>();
    if (directLight[0]) f.directLight = compared;
    f.usesDirectLight = directLight[1];
    return f;
}

}  // namespace

std::vector<std::byte> SaveLearning(const Learning& learning) {
    StateWriter writer;
    writer.Put(kTag);
    writer.Put(std::array<int32_t, 3>{learning.round, learning.decided, learning.end});
    writer.Put(learning.usual);
    writer.Put(std::array<int64_t, 2>{learning.paths, learning.samples});
    PutFigures(learning.figures, &writer);
    PutGuide(learning.guide, &writer);
    PutGuide(learning.state.guide, &writer);
    writer.PutVector(learning.state.record.sums);
    writer.PutVector(learning.state.record.leaves);
    PutTally(learning.tally, &writer);
    writer.PutVector(learning.noise);
    PutDirectLight(learning.directLight, &writer);
    return std::move(writer.bytes);
}

Learning RestoreLearning(std::span<const std::byte> bytes) {
    StateReader reader(bytes);
    Learning learning;
    if (reader.Get<uint32_t>() != kTag) Refuse();
    const auto round = reader.Get<std::array<int32_t, 3>>();
    learning.round = round[0];
    learning.decided = round[1];
    learning.end = round[2];
    learning.usual = reader.Get<double>();
    const auto counts = reader.Get<std::array<int64_t, 2>>();
    learning.paths = counts[0];
    learning.samples = counts[1];
    learning.figures = GetFigures(&reader);
    learning.guide = GetGuide(&reader);
    GuideState& state = learning.state;
    state.guide = GetGuide(&reader);
    state.record.sums = reader.GetVector<uint64_t>(kDamaged);
    state.record.leaves = reader.GetVector<GuideRecord::LeafSums>(kDamaged);
    learning.tally = GetTally(&reader, kDamaged);
    learning.noise = GetNoise(&reader, kDamaged);
    learning.directLight = GetDirectLight(&reader);
    reader.Finish();
    const bool records = !learning.IsDone() && learning.round > 0;
    const bool fits =
        state.record.sums.size() == 4 * state.guide.quads.size() &&
        state.record.leaves.size() == state.guide.leaves.size() &&
        records == !state.guide.space.nodes.empty() &&
        (learning.IsDone() && learning.figures.isUsed) == !learning.guide.space.nodes.empty();
    if (!fits || learning.round < 0 || learning.round >= 24 || learning.end <= 0 ||
        learning.decided < 0 || learning.decided > learning.round ||
        (records && !(learning.usual > 0)))
        Refuse();
    return learning;
}

}  // namespace lull
