#include "stopping/rules/learned.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "stopping/base/state.h"
#include "stopping/network/block_memory.h"
#include "stopping/rules/votes.h"

namespace lull {

namespace {

constexpr uint32_t learnedTag = 0x314e524c;  // "LRN1"

VoteSchedule MakeSchedule(const ModelSettings& settings, int passSpp) {
    if (passSpp == 0) passSpp = settings.n;
    return {.firstSpp = passSpp,
            .n = settings.n,
            .voteSpacing = settings.voteSpacing > 0 ? settings.voteSpacing : passSpp};
}

class LearnedCriterion final : public Criterion {
  public:
    LearnedCriterion(std::shared_ptr<const Model> model, int passSpp)
        : model(std::move(model)),
          schedule(MakeSchedule(this->model->settings, passSpp)),
          isFree(passSpp == 0 && this->model->settings.spacing == Spacing::Geometric),
          looksAtNoiseOnly(LooksAtNoiseOnly(this->model->settings)),
          looks{.spacing = this->model->settings.n},
          memory(this->model->settings),
          votes{.needed = this->model->settings.votes} {}

    ViewNeed Need(int spp) const override {
        return Looks(spp) ? NeedOf(model->settings) : ViewNeed::Nothing;
    }

    Decision Observe(const BlockView& view) override {
        CheckView(view, Need(view.spp));
        bool judged = false;
        if (Looks(view.spp)) {
            looks.last = view.spp;
            memory.Add(MeasureBlock(view, model->settings));
            judged = Vote(view.spp);
        }
        return {.stop = judged && votes.Stops(),
                .judged = judged,
                .value = probability,
                .threshold = 0.5,
                .votes = votes.inRow,
                .noise = judged ? noise : std::nullopt};
    }

    std::vector<std::byte> Save() const override {
        StateWriter writer;
        writer.Put(learnedTag);
        writer.Put(int32_t(votes.inRow));
        writer.Put(probability);
        memory.Save(&writer);
        if (isFree) writer.Put(int32_t(looks.last));
        return std::move(writer.bytes);
    }

    void Restore(std::span<const std::byte> state) override {
        StateReader reader(state);
        reader.Expect(learnedTag);
        votes.inRow = reader.Get<int32_t>();
        probability = reader.Get<double>();
        if (votes.inRow < 0 || !(probability >= 0 && probability <= 1))
            throw std::runtime_error("the saved state of a learned rule is damaged");
        memory.Restore(&reader);
        if (isFree) looks.Restore(&reader);
        reader.Finish();
    }

  private:
    bool Looks(int spp) const { return isFree ? looks.Looks(spp) : schedule.Records(spp); }

    // Votes if a vote is due at this spp and the window is full. Returns whether it did.
    bool Vote(int spp) {
        if (!isFree && !schedule.Votes(spp)) return false;
        const std::optional<Eigen::MatrixXf> window = memory.WindowAt(spp);
        if (!window) return false;
        probability = NoisyProbability(model->network, *window);
        if (looksAtNoiseOnly)
            noise = NoiseOfInput((*window)(0, window->cols() - 1), model->settings);
        votes.Cast(probability);
        return true;
    }

    std::shared_ptr<const Model> model;
    VoteSchedule schedule;
    bool isFree;  // states come at any spp
    bool looksAtNoiseOnly;
    FreeLooks looks;
    BlockMemory memory;
    VoteCounter votes;
    double probability = 1;  // of the last vote; noisy until there is one
    std::optional<double> noise;
};

}  // namespace

double NoisyProbability(const Network& network, const Eigen::MatrixXf& window) {
    const double p = RunNetwork(network, window)[0];
    return std::isfinite(p) ? std::clamp(p, 0.0, 1.0) : 1;
}

double UndecidedNoise(const Model& model) {
    const ModelSettings& settings = model.settings;
    if (!LooksAtNoiseOnly(settings)) return 0;
    // A step before the last had more noise; at fixed spacing, as much but for few spp.
    const double stepBefore =
        settings.spacing == Spacing::Geometric ? std::sqrt(settings.ratio) : 1.0;
    const auto isNoisy = [&](double noise) {
        Eigen::MatrixXf window(1, settings.k);
        for (int step = settings.k - 1; step >= 0; --step, noise *= stepBefore)
            window(0, step) = float(InputOfNoise(noise, settings));
        return NoisyProbability(model.network, window) >= 0.5;
    };
    double clean = 1e-3, noisy = 1e3;
    if (isNoisy(clean) || !isNoisy(noisy)) return 0;
    while (noisy / clean > 1.0001) {
        const double middle = std::sqrt(clean * noisy);
        (isNoisy(middle) ? noisy : clean) = middle;
    }
    return noisy;
}

std::unique_ptr<Criterion> MakeLearned(std::shared_ptr<const Model> model, int passSpp) {
    const ModelSettings& settings = model->settings;
    CheckSettings(settings);
    CheckNetwork(model->network);
    if (!Takes(model->network, InputCount(settings), settings.k))
        throw std::invalid_argument("the network does not take " + std::to_string(settings.k) +
                                    " steps of " + std::to_string(InputCount(settings)) +
                                    " values, as its settings have it");
    const auto& dense = model->network.dense;
    const Eigen::Index outputs =
        dense.empty() ? model->network.lstm.back().Units() : dense.back().bias.size();
    if (outputs != 1)
        throw std::invalid_argument("the network has " + std::to_string(outputs) +
                                    " outputs; one, the probability of noise, is needed");
    if (passSpp < 0 ||
        (passSpp > 0 && (settings.n % passSpp != 0 || settings.voteSpacing % passSpp != 0)))
        throw std::invalid_argument("the model looks at a block every " +
                                    std::to_string(settings.n) + " spp (and votes every " +
                                    std::to_string(settings.voteSpacing) +
                                    "; 0: each pass), which must be multiples of the pass of " +
                                    std::to_string(passSpp) + " spp");
    return std::make_unique<LearnedCriterion>(std::move(model), passSpp);
}

}  // namespace lull
