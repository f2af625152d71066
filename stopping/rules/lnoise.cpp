#include "stopping/rules/lnoise.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "stopping/base/state.h"
#include "stopping/rules/votes.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

constexpr uint32_t lightnessNoiseTag = 0x314e534c;  // "LSN1"
constexpr int subBlocks = 100;

class LightnessNoiseCriterion final : public Criterion {
  public:
    explicit LightnessNoiseCriterion(double threshold) : threshold(threshold) {}

    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }

    Decision Observe(const BlockView& view) override {
        const double value = VisibleNoise(view);
        votes.Cast(value < threshold ? 0 : 1);
        return {.stop = votes.Stops(),
                .judged = true,
                .value = value,
                .threshold = threshold,
                .votes = votes.inRow,
                .visibleNoise = value};
    }

    std::vector<std::byte> Save() const override {
        StateWriter writer;
        writer.Put(lightnessNoiseTag);
        writer.Put(int32_t(votes.inRow));
        return std::move(writer.bytes);
    }
    void Restore(std::span<const std::byte> state) override {
        StateReader reader(state);
        reader.Expect(lightnessNoiseTag);
        votes.inRow = reader.Get<int32_t>();
        reader.Finish();
        if (votes.inRow < 0) throw std::runtime_error("the saved state of lnoise is damaged");
    }

  private:
    double threshold;
    VoteCounter votes;
};

}  // namespace

double PooledRms(std::span<const float> subBlocks) {
    double sum = 0;
    for (float rms : subBlocks) sum += double(rms) * rms;
    return std::sqrt(sum / double(subBlocks.size()));
}

double VisibleNoise(const BlockView& view) {
    const LightnessNoise noise = ComputeLightnessNoise(view);
    return PooledRms(SubBlockStatistics(noise, view.width, view.height, subBlocks).maskedNoise);
}

std::unique_ptr<Criterion> MakeLightnessNoise(double threshold) {
    return std::make_unique<LightnessNoiseCriterion>(threshold);
}

}  // namespace lull
