#include "stopping/rules/learned.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "stopping/base/input_file.h"
#include "stopping/features/block_memory.h"

namespace lull {

namespace {

constexpr uint32_t learnedTag = 0x314e524c;  // "LRN1"

VoteSchedule MakeSchedule(const ModelSettings& settings, int passSpp) {
    if (passSpp == 0) passSpp = settings.n;
    return {.firstSpp = passSpp,
            .n = settings.n,
            .voteSpacing = settings.voteSpacing > 0 ? settings.voteSpacing : passSpp};
}

class LearnedGauge final : public Gauge {
  public:
    LearnedGauge(std::shared_ptr<const Model> model, int passSpp)
        : model(std::move(model)),
          schedule(MakeSchedule(this->model->settings, passSpp)),
          isFree(passSpp == 0 && this->model->settings.spacing == Spacing::Geometric),
          looksAtNoiseOnly(LooksAtNoiseOnly(this->model->settings)),
          looks{.spacing = this->model->settings.n},
          memory(this->model->settings) {
        value = 1;  // noisy until there is a vote
    }

    bool Looks(int spp) const override { return isFree ? looks.Looks(spp) : schedule.Records(spp); }

    // There is a number if a vote is due at this spp and the window is full.
    bool Add(int spp, Signals signals) override {
        looks.last = spp;
        memory.Add(std::get<BlockMeasures>(std::move(signals)));
        if (!isFree && !schedule.Votes(spp)) return false;
        const std::optional<Eigen::MatrixXf> window = memory.WindowAt(spp);
        if (!window) return false;
        value = NoisyProbability(model->network, *window);
        if (looksAtNoiseOnly)
            noise = NoiseOfInput((*window)(0, window->cols() - 1), model->settings);
        return true;
    }
    std::optional<double> Noise() const override { return noise; }

    void Save(StateWriter* writer) const override {
        writer->Put(value);
        memory.Save(writer);
        if (isFree) writer->Put(int32_t(looks.last));
    }
    void Restore(StateReader* reader) override {
        value = reader->Get<double>();
        if (!(value >= 0 && value <= 1))
            throw std::runtime_error("the saved state of a learned rule is damaged");
        memory.Restore(reader);
        if (isFree) looks.Restore(reader);
    }

  private:
    std::shared_ptr<const Model> model;
    VoteSchedule schedule;
    bool isFree;  // states come at any spp
    bool looksAtNoiseOnly;
    FreeLooks looks;
    BlockMemory memory;
    std::optional<double> noise;
};

// Throws std::invalid_argument.
void CheckFits(const Model& model, int passSpp) {
    const ModelSettings& settings = model.settings;
    CheckSettings(settings);
    CheckNetwork(model.network);
    if (!Takes(model.network, InputCount(settings), settings.k))
        throw std::invalid_argument("the network does not take " + std::to_string(settings.k) +
                                    " steps of " + std::to_string(InputCount(settings)) +
                                    " values, as its settings have it");
    const auto& dense = model.network.dense;
    const Eigen::Index outputs =
        dense.empty() ? model.network.lstm.back().Units() : dense.back().bias.size();
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
}

}  // namespace

double NoisyProbability(const Network& network, const Eigen::MatrixXf& window) {
    const double p = RunNetwork(network, window)[0];
    return std::isfinite(p) ? std::clamp(p, 0.0, 1.0) : 1;
}

VotingRule LearnedRule(std::shared_ptr<const Model> model, int passSpp) {
    CheckFits(*model, passSpp);
    return {.threshold = 0.5,
            .votes = model->settings.votes,
            .tag = learnedTag,
            .need = NeedOf(model->settings),
            .measure = [model](const BlockView& view,
                               const BlockInfo&) { return MeasureBlock(view, model->settings); },
            .recall =
                [model](int spp, const RecordedValues& values) {
                    return RecordedMeasures(spp, values, model->settings);
                },
            .makeGauge =
                [=](const BlockInfo&) { return std::make_unique<LearnedGauge>(model, passSpp); },
            .spacing = model->settings.n};
}

std::string ModelPath(const std::string& argument, const std::string& models) {
    const std::string name = argument.empty() ? defaultModelName : argument;
    if (name.ends_with(".h5") || std::filesystem::exists(name)) return name;
    const std::filesystem::path path = std::filesystem::path(models) / (name + ".h5");
    if (std::filesystem::exists(path)) return path.string();
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(models, none))
        if (entry.path().extension() == ".h5") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    std::string known;
    for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
    throw std::runtime_error("there is no model '" + Printable(name) + "' in '" + models + "'; " +
                             (known.empty() ? "there are none" : "there are " + known) +
                             ". Name a file, learned:MODEL.h5, or choose another rule");
}

Model ReadModelFor(const std::string& path, const RuleContext& context) {
    Model model = ReadModel(path);
    ModelSettings& settings = model.settings;
    if (context.caution != 1 && !std::ranges::any_of(settings.features, IsNoise))
        throw std::runtime_error(path +
                                 ": is not given visible noise that caution could scale, but " +
                                 FeatureNames(settings.features));
    settings.caution = context.caution;
    settings.visibility = VisibilityAt(context.cap, settings.visibility);
    return model;
}

CriterionFactory ReadLearned(const std::string& argument, const RuleContext& context) {
    const std::string path = ModelPath(argument, context.models);
    const auto model = std::make_shared<const Model>(ReadModelFor(path, context));
    // A model that does not fit is an error before anything is rendered.
    CriterionFactory factory;
    try {
        factory = FactoryOf(LearnedRule(model, context.passSpp));
    } catch (const std::invalid_argument& error) {
        throw std::runtime_error(path + ": " + error.what());
    }
    // Noise falls with the root of the spp: a caution of X takes X^2 times as many.
    factory.logRatios = model->logRatios;
    for (double& ratio : factory.logRatios) ratio -= 2 * std::log(context.caution);
    factory.checksum = model->checksum;
    factory.trend = TrendOf(*model);
    return factory;
}

}  // namespace lull
