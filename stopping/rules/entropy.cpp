#include "stopping/rules/entropy.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/base/state.h"
#include "stopping/rules/votes.h"
#include "stopping/signals/drop_history.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

constexpr uint32_t entropyTag = 0x31504445;  // "EDP1"

class EntropyCriterion final : public Criterion {
  public:
    EntropyCriterion(double threshold, const NoiseVisibility& visibility, int passSpp)
        : threshold(threshold), visibility(visibility), passSpp(passSpp) {}

    ViewNeed Need(int spp) const override {
        return Looks(spp) ? ViewNeed::Mean : ViewNeed::Nothing;
    }

    Decision Observe(const BlockView& view) override {
        CheckView(view, Need(view.spp));
        const bool judged = Looks(view.spp) && Look(view);
        return {.stop = judged && votes.Stops(),
                .judged = judged,
                .value = value,
                .threshold = threshold,
                .votes = votes.inRow};
    }

    std::vector<std::byte> Save() const override {
        StateWriter writer;
        writer.Put(entropyTag);
        writer.Put(int32_t(votes.inRow));
        writer.Put(value);
        history.Save(&writer);
        if (passSpp == 0) writer.Put(int32_t(looks.last));
        return std::move(writer.bytes);
    }
    void Restore(std::span<const std::byte> state) override {
        StateReader reader(state);
        reader.Expect(entropyTag);
        votes.inRow = reader.Get<int32_t>();
        value = reader.Get<double>();
        if (votes.inRow < 0 || !(value >= 0) || !std::isfinite(value))
            throw std::runtime_error("the saved state of the rule entropy is damaged");
        history.Restore(&reader, kEntropySubBlocks);
        if (passSpp == 0) looks.Restore(&reader);
        reader.Finish();
    }

  private:
    bool Looks(int spp) const {
        return passSpp == 0 ? looks.Looks(spp) : EntropyRuleLooks(spp, passSpp);
    }

    // Returns whether there was an earlier state to compare with.
    bool Look(const BlockView& view) {
        looks.last = view.spp;
        std::vector<double> h;
        for (const SvdEntropy& e : PictureEntropies(view, kEntropySubBlocks)) h.push_back(e.h);
        const auto visible = AddVisible(view.spp, h, MeasureLightness(view, kEntropySubBlocks),
                                        visibility, &history);
        if (!visible) return false;
        value = MeanVisible(*visible);
        votes.Cast(value < threshold ? 0 : 1);
        return true;
    }

    double threshold;
    NoiseVisibility visibility;
    int passSpp;
    FreeLooks looks;  // where passSpp is 0
    DropHistory history;
    VoteCounter votes;
    double value = 0;  // of the last look
};

}  // namespace

bool EntropyRuleLooks(int spp, int passSpp) {
    const int spacing = (40 + passSpp - 1) / passSpp * passSpp;
    return spp >= passSpp && (spp - passSpp) % spacing == 0;
}

double MeanVisible(std::span<const double> visibleDrops) {
    double sum = 0;
    for (const double v : visibleDrops) sum += v;
    return sum / double(visibleDrops.size());
}

std::unique_ptr<Criterion> MakeEntropyRule(double threshold, const NoiseVisibility& visibility,
                                           int passSpp) {
    return std::make_unique<EntropyCriterion>(threshold, visibility, passSpp);
}

}  // namespace lull
