#include "stopping/rules/learned.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "stopping/base/input_file.h"
#include "stopping/features/model_inputs.h"
#include "stopping/rules/rule.h"

namespace lull {

namespace {

constexpr uint32_t kLearnedTag = 0x324e524c;  // "LRN2"

Checks VotesOf(const ModelSettings& settings, int passSpp) {
    if (passSpp == 0 && settings.spacing == Spacing::Geometric)
        return {.every = settings.n, .any = true};
    const int first = passSpp > 0 ? passSpp : settings.n;
    return {.first = first, .every = settings.voteSpacing > 0 ? settings.voteSpacing : first};
}

// Returns when it checks a block, also for the steps of windows between which there is no vote.
Checks ChecksOf(const ModelSettings& settings, int passSpp) {
    Checks checks = VotesOf(settings, passSpp);
    checks.every = std::gcd(checks.every, settings.n);
    return checks;
}

class LearnedStatistic final : public Statistic {
  public:
    LearnedStatistic(std::shared_ptr<const Model> model, int passSpp)
        : model(std::move(model)),
          votes(VotesOf(this->model->settings, passSpp)),
          isToldNoiseOnly(LooksAtNoiseOnly(this->model->settings)),
          memory(this->model->settings) {}

    // There is a number if a vote is due at this spp and the window is full.
    std::optional<double> Add(int spp, Signals signals) override {
        memory.Add(std::get<BlockMeasures>(std::move(signals)));
        if (!votes.AreDue(spp)) return {};
        const std::optional<Eigen::MatrixXf> window = memory.WindowAt(spp);
        if (!window) return {};
        if (isToldNoiseOnly) noise = NoiseOfInput((*window)(0, window->cols() - 1));
        return NoisyProbability(model->network, *window);
    }
    std::optional<double> Noise() const override { return noise; }

    void Save(StateWriter* writer) const override { memory.Save(writer); }
    void Restore(StateReader* reader) override { memory.Restore(reader); }

  private:
    std::shared_ptr<const Model> model;
    Checks votes;
    bool isToldNoiseOnly;
    BlockMemory memory;
    std::optional<double> noise;
};

void CheckFits(const Model& model, int passSpp) {
    const ModelSettings& settings = model.settings;
    CheckSettings(settings);
    CheckNetwork(model.network);
    if (model.network.lstm.front().Inputs() != InputCount(settings))
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
        throw std::invalid_argument("the model checks a block every " + std::to_string(settings.n) +
                                    " spp (and votes every " +
                                    std::to_string(settings.voteSpacing) +
                                    "; 0: each pass), which must be multiples of the pass of " +
                                    std::to_string(passSpp) + " spp");
}

}  // namespace

double NoisyProbability(const Network& network, const Eigen::MatrixXf& window) {
    const double p = RunNetwork(network, window)[0];
    return std::isfinite(p) ? std::clamp(p, 0.0, 1.0) : 1;
}

Rule LearnedRule(std::shared_ptr<const Model> model, int passSpp) {
    CheckFits(*model, passSpp);
    return {.tag = kLearnedTag,
            .checks = ChecksOf(model->settings, passSpp),
            .threshold = 0.5,
            .votes = model->settings.votes,
            .peak = {.most = model->settings.peakLimit / model->settings.caution,
                     .visibility = model->settings.visibility},
            .need = ViewNeed::Mean,
            .inputs = model->settings,
            .makeStatistic = [=] { return std::make_unique<LearnedStatistic>(model, passSpp); },
            .valueBefore = 1,  // noisy until there is a vote
            .spacing = model->settings.n};
}

std::string ModelPath(const std::string& argument, const std::string& models) {
    const std::string name = argument.empty() ? kDefaultModelName : argument;
    if (name.ends_with(".h5") || IsThere(name)) return name;
    const std::filesystem::path path = std::filesystem::path(models) / (name + ".h5");
    if (IsThere(path.string())) return path.string();
    if (name == "paper-full")
        throw std::runtime_error(
            "there is no model 'paper-full': the paper's network of 512, 128 and 32 units would be "
            "a file of 6 MB, and its authors' weights are not among lull's files. Make it by lull "
            "train DATA.h5 --human H.csv --preset paper -o paper-full.h5, and name that file");
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

Rule ReadLearned(const std::string& argument, const RuleContext& context) {
    const std::string path = ModelPath(argument, context.models);
    const auto model = std::make_shared<const Model>(ReadModelFor(path, context));
    // A model that does not fit is an error before anything is rendered.
    Rule rule;
    try {
        rule = LearnedRule(model, context.passSpp);
    } catch (const std::invalid_argument& error) {
        throw std::runtime_error(path + ": " + error.what());
    }
    rule.checksum = model->checksum;
    rule.trend = TrendOf(*model);
    return rule;
}

namespace {

constexpr uint32_t kEntropyTag = 0x32504445;  // "EDP2"
constexpr int kCheckSpacing = 40;             // spp

class EntropyStatistic final : public Statistic {
  public:
    explicit EntropyStatistic(const NoiseVisibility& visibility) : visibility(visibility) {}

    // There is a number where there is an earlier state to compare with.
    std::optional<double> Add(int spp, Signals signals) override {
        const BlockMeasures& measures = std::get<BlockMeasures>(signals);
        AddEntropies(spp, measures.Of(Feature::H), &history);
        const auto visible = LatestVisibleDrop(history, measures.lightness, visibility);
        if (!visible) return {};
        return MeanVisible(*visible);
    }

    void Save(StateWriter* writer) const override { history.Save(writer); }
    void Restore(StateReader* reader) override {
        history.Restore(reader, size_t(kEntropySubBlocks));
    }

  private:
    NoiseVisibility visibility;
    History<float> history;
};

}  // namespace

Checks EntropyChecks(int passSpp) {
    if (passSpp == 0) return {.every = kCheckSpacing, .any = true};
    return {.first = passSpp, .every = (kCheckSpacing + passSpp - 1) / passSpp * passSpp};
}

double MeanVisible(std::span<const double> visibleDrops) {
    double sum = 0;
    for (const double v : visibleDrops) sum += v;
    return sum / double(visibleDrops.size());
}

Rule EntropyRule(double threshold, const NoiseVisibility& visibility, int passSpp) {
    return {.tag = kEntropyTag,
            .checks = EntropyChecks(passSpp),
            .threshold = threshold,
            .votes = 3,
            .need = ViewNeed::Mean,
            .inputs = ModelSettings{.m = kEntropySubBlocks, .features = {Feature::VisibleDrop}},
            .makeStatistic = [=] { return std::make_unique<EntropyStatistic>(visibility); }};
}

Rule ReadEntropy(const std::string& argument, const RuleContext& context) {
    const double threshold = ParseThreshold(argument) / context.caution;
    const NoiseVisibility visibility = VisibilityAt(context.cap, {});
    Rule rule = EntropyRule(threshold, visibility, context.passSpp);
    rule.trend = TrendOfFalls(visibility);
    rule.peak = {.most = kPeakOverThreshold * threshold, .visibility = visibility};
    return rule;
}

}  // namespace lull
