#include "renderer/render/graded_criterion.h"

#include <algorithm>

#include "stopping/base/state.h"

namespace lull {

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
