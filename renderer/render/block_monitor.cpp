#include "renderer/render/block_monitor.h"

#include <algorithm>

#include "renderer/base/clocks.h"
#include "stopping/base/state.h"
#include "stopping/rules/baselines.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

constexpr uint32_t kMonitorTag = 0x3153424f;  // "OBS1"
constexpr int kCurveSubBlocks = 100;
constexpr int kSmallestCurveSide = 10;  // pixels: one to each row of sub-blocks

double MeanEntropy(const BlockView& view) {
    double sum = 0;
    for (const SvdEntropy& e : PictureEntropies(view, kCurveSubBlocks)) sum += e.h;
    return sum / kCurveSubBlocks;
}

Snapshot TakeSnapshot(const BlockView& view, bool withNoise) {
    Snapshot snapshot{.mean = {view.mean.begin(), view.mean.end()}, .noise = {}};
    if (withNoise) snapshot.noise = ComputeLightnessNoise(view).noise;
    return snapshot;
}

constexpr const char* kDamaged = "the saved observations are damaged";

}  // namespace

BlockMonitor::BlockMonitor(std::vector<std::unique_ptr<Criterion>> rules,
                           const MonitorOptions& options, BlockHistory* history)
    : rules(std::move(rules)), options(options), history(history) {
    *history = {};
    history->stops.resize(this->rules.size());
}

ViewNeed BlockMonitor::Need(int spp) const {
    // A rule that only counts needs no view, but where it stops, the snapshot does.
    ViewNeed need = options.snapshots ? ViewNeed::Mean : ViewNeed::Nothing;
    if (options.curves || (options.snapshots && options.noise)) need = ViewNeed::MeanAndHalf;
    for (const std::unique_ptr<Criterion>& rule : rules)
        if (rule) need = std::max(need, rule->Need(spp));
    return need;
}

Decision BlockMonitor::ObserveRule(size_t i, const BlockView& view) {
    const double start = ThreadSeconds();
    const bool needsView = rules[i]->Need(view.spp) != ViewNeed::Nothing;
    const Decision decision = rules[i]->Observe(view);
    if (i == 0) networkNoise = rules[i]->NetworkNoise();
    RuleStop& stop = history->stops[i];
    stop.ruleSeconds += ThreadSeconds() - start + (needsView ? view.viewSeconds : 0);
    if (!decision.stop) return decision;

    stop.spp = view.spp;
    stop.seconds = view.seconds;
    rules[i].reset();
    if (options.snapshots && !history->snapshots.contains(view.spp))
        history->snapshots[view.spp] = TakeSnapshot(view, options.noise);
    return decision;
}

void BlockMonitor::AddToCurves(const BlockView& view) {
    BlockCurves& curves = history->curves;
    const bool isDue = curves.spp.empty() || view.spp >= 1.07 * curves.spp.back();
    if (!isDue || std::min(view.width, view.height) < kSmallestCurveSide) return;
    curves.spp.push_back(view.spp);
    curves.entropy.push_back(float(MeanEntropy(view)));
    curves.noise.push_back(float(VisibleNoise(view)));
}

Decision BlockMonitor::Observe(const BlockView& view) {
    Decision first;
    for (size_t i = 0; i < rules.size(); ++i) {
        if (!rules[i]) continue;
        const Decision decision = ObserveRule(i, view);
        if (i == 0) first = decision;
    }
    if (options.curves) AddToCurves(view);
    first.stop =
        !options.goesOn && std::ranges::none_of(rules, [](const auto& rule) { return bool(rule); });
    return first;
}

std::vector<std::byte> BlockMonitor::Save() const {
    StateWriter writer;
    writer.Put(kMonitorTag);
    writer.PutVector(history->stops);
    for (const std::unique_ptr<Criterion>& rule : rules)
        writer.PutVector(rule ? rule->Save() : std::vector<std::byte>());
    writer.Put(uint64_t(history->snapshots.size()));
    for (const auto& [spp, snapshot] : history->snapshots) {
        writer.Put(int32_t(spp));
        writer.PutVector(snapshot.mean);
        writer.PutVector(snapshot.noise);
    }
    writer.PutVector(history->curves.spp);
    writer.PutVector(history->curves.entropy);
    writer.PutVector(history->curves.noise);
    return std::move(writer.bytes);
}

void BlockMonitor::Restore(std::span<const std::byte> state) {
    StateReader reader(state);
    reader.Expect(kMonitorTag);
    history->stops = reader.GetVector<RuleStop>(kDamaged);
    if (history->stops.size() != rules.size())
        throw std::runtime_error("the saved observations are of other rules");
    for (size_t i = 0; i < rules.size(); ++i) {
        const auto bytes = reader.GetVector<std::byte>(kDamaged);
        if (history->stops[i].spp > 0)
            rules[i].reset();
        else if (rules[i])
            rules[i]->Restore(bytes);
    }
    history->snapshots.clear();
    for (auto left = reader.Get<uint64_t>(); left > 0; --left) {
        Snapshot& snapshot = history->snapshots[reader.Get<int32_t>()];
        snapshot.mean = reader.GetVector<float>(kDamaged);
        snapshot.noise = reader.GetVector<float>(kDamaged);
    }
    history->curves.spp = reader.GetVector<int>(kDamaged);
    history->curves.entropy = reader.GetVector<float>(kDamaged);
    history->curves.noise = reader.GetVector<float>(kDamaged);
    if (history->curves.entropy.size() != history->curves.spp.size() ||
        history->curves.noise.size() != history->curves.spp.size())
        throw std::runtime_error(kDamaged);
    reader.Finish();
}

namespace {

constexpr uint32_t kGradedTag = 0x64617267;
constexpr const char* kDamagedState = "the saved state of a graded block is damaged";

struct GradedPixels {
    std::vector<float> mean, halfMean;
};

// The halves of the graded picture differ by as much as the graded halves.
GradedPixels GradePixels(const BlockView& view, const Grade& grade) {
    GradedPixels graded{{view.mean.begin(), view.mean.end()},
                        {view.halfMean.begin(), view.halfMean.end()}};
    std::vector<float> other(view.halfMean.size());
    for (size_t i = 0; i < other.size(); ++i)
        other[i] = std::max(0.f, 2 * view.mean[i] - view.halfMean[i]);
    for (std::vector<float>* rgb : {&graded.mean, &graded.halfMean, &other})
        ApplyGrade(grade, *rgb);
    for (size_t i = 0; i < other.size(); ++i)
        graded.halfMean[i] = graded.mean[i] + (graded.halfMean[i] - other[i]) / 2;
    return graded;
}

Decision ObserveGraded(const GradedJudge& judge, const BlockView& view) {
    if (judge.grade.IsPlain() || judge.criterion->Need(view.spp) == ViewNeed::Nothing)
        return judge.criterion->Observe(view);
    const GradedPixels pixels = GradePixels(view, judge.grade);
    BlockView shown = view;
    shown.mean = pixels.mean;
    shown.halfMean = pixels.halfMean;
    return judge.criterion->Observe(shown);
}

double OverThreshold(const Decision& decision) {
    return decision.threshold > 0 ? decision.value / decision.threshold : decision.value;
}

}  // namespace

GradedCriterion::GradedCriterion(std::vector<GradedJudge> given) : judges(std::move(given)) {}

ViewNeed GradedCriterion::Need(int spp) const {
    ViewNeed need = ViewNeed::Nothing;
    for (const GradedJudge& judge : judges)
        if (judge.criterion) need = std::max(need, judge.criterion->Need(spp));
    return need;
}

Decision GradedCriterion::Observe(const BlockView& view) {
    std::optional<Decision> farthest;
    for (GradedJudge& judge : judges) {
        if (!judge.criterion) continue;
        const Decision decision = ObserveGraded(judge, view);
        const bool isFarther =
            !farthest || farthest->stop > decision.stop ||
            (farthest->stop == decision.stop && OverThreshold(decision) > OverThreshold(*farthest));
        if (isFarther) {
            farthest = decision;
            networkNoise = judge.criterion->NetworkNoise();
        }
        if (decision.stop) judge.criterion.reset();
    }
    return farthest.value();
}

std::vector<std::byte> GradedCriterion::Save() const {
    StateWriter writer;
    writer.Put(kGradedTag);
    for (const GradedJudge& judge : judges) {
        writer.Put(uint8_t(judge.criterion != nullptr));
        writer.PutVector(judge.criterion ? judge.criterion->Save() : std::vector<std::byte>());
    }
    return std::move(writer.bytes);
}

void GradedCriterion::Restore(std::span<const std::byte> state) {
    StateReader reader(state);
    reader.Expect(kGradedTag);
    for (GradedJudge& judge : judges) {
        const bool isThere = reader.Get<uint8_t>() != 0;
        const auto bytes = reader.GetVector<std::byte>(kDamagedState);
        if (isThere)
            judge.criterion->Restore(bytes);
        else
            judge.criterion.reset();
    }
    reader.Finish();
    if (std::ranges::none_of(judges, [](const GradedJudge& j) { return bool(j.criterion); }))
        throw std::runtime_error(kDamagedState);
}

}  // namespace lull
