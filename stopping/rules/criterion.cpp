#include "stopping/rules/criterion.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "stopping/base/checksum.h"
#include "stopping/network/model_file.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/entropy.h"
#include "stopping/rules/learned.h"
#include "stopping/rules/lnoise.h"
#include "stopping/rules/thresholds.h"
#include "stopping/rules/votes.h"

namespace lull {

namespace {

constexpr const char* ruleForms =
    "fixed:N, dammertz[:T[:area]], cycles:T, luxtile:T, lnoise[:T], entropy[:T], "
    "thresholds:FILE[:NAME] and learned[:NAME|:MODEL.h5]";

// Parses all of `text` as a number > 0, finite.
template <typename T>
T ParsePositive(const std::string& text, const std::string& needed) {
    T value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || rest != end || !(value > 0) || !std::isfinite(double(value)))
        throw std::invalid_argument("'" + text + "' is not " + needed);
    return value;
}

double ParseThreshold(const std::string& text) {
    return ParsePositive<double>(text, "a threshold; a number > 0 is needed");
}

CriterionFactory Fixed(const std::string& argument) {
    const int spp = ParsePositive<int>(argument, "a number of samples per pixel, at least 1");
    return {.make = [spp](const BlockInfo&) { return MakeFixed(spp); }};
}

CriterionFactory Dammertz(const std::string& argument) {
    const std::string suffix = ":area";
    const bool byArea = argument.ends_with(suffix);
    const double threshold =
        ParseThreshold(byArea ? argument.substr(0, argument.size() - suffix.size()) : argument);
    return {.smallestSide = smallestVotingSide, .make = [=](const BlockInfo& block) {
                return MakeDammertz(threshold, byArea ? std::sqrt(block.areaFraction) : 1);
            }};
}

CriterionFactory Cycles(const std::string& argument) {
    const double threshold = ParseThreshold(argument);
    return {.smallestSide = smallestVotingSide,
            .make = [threshold](const BlockInfo&) { return MakeCycles(threshold); }};
}

CriterionFactory LuxTile(const std::string& argument) {
    const double threshold = ParseThreshold(argument);
    return {.smallestSide = smallestVotingSide,
            .make = [threshold](const BlockInfo&) { return MakeLuxTile(threshold); }};
}

CriterionFactory LNoise(const std::string& argument, const RuleContext& context) {
    const double threshold = ParseThreshold(argument) / context.caution;
    return {.smallestSide = smallestVotingSide,
            .make = [threshold](const BlockInfo&) { return MakeLightnessNoise(threshold); }};
}

// What people compared with: nothing is noise there. Where the cap is larger, that is the picture
// at the cap; a smaller cap does not change what they saw.
NoiseVisibility VisibilityIn(const RuleContext& context, NoiseVisibility visibility) {
    visibility.reference = std::max(visibility.reference, context.cap);
    return visibility;
}

// Returns the reference of a trend: noise vanishes there with the root of 1/n - 1/N where that is
// how near the picture is to it (see NoiseVisibility).
int ReferenceOf(const NoiseVisibility& visibility) {
    return visibility.nearness == 0.5 ? visibility.reference : 0;
}

CriterionFactory Entropy(const std::string& argument, const RuleContext& context) {
    const double threshold = ParseThreshold(argument) / context.caution;
    const NoiseVisibility visibility = VisibilityIn(context, {});
    return {.trend = {.reference = ReferenceOf(visibility), .saturates = true},
            .smallestSide = smallestVotingSide,
            .make = [=](const BlockInfo&) {
                return MakeEntropyRule(threshold, visibility, context.passSpp);
            }};
}

// Returns the rule with the threshold that it has where none is given.
std::string WithThreshold(const std::string& rule) {
    if (rule == "dammertz") return "dammertz:0.02";
    if (rule == "lnoise") return "lnoise:0.65";
    if (rule == "entropy") return "entropy:0.64";
    return rule;
}

// Chooses the row of a thresholds file: the one asked for, else the scene's, else the only one.
const ThresholdsRow& ChooseRow(const std::vector<ThresholdsRow>& rows, const std::string& path,
                               const std::string& name, const std::string& sceneName) {
    auto find = [&](const std::string& wanted) {
        return std::find_if(rows.begin(), rows.end(),
                            [&](const ThresholdsRow& row) { return row.name == wanted; });
    };
    auto row = find(name.empty() ? sceneName : name);
    if (row == rows.end() && name.empty() && rows.size() == 1) row = rows.begin();
    if (row != rows.end()) return *row;
    if (rows.empty()) throw std::runtime_error(path + ": has no rows");
    const std::string example = "such as '" + rows.front().name + "'";
    if (!name.empty())
        throw std::runtime_error(path + ": has no row '" + name + "', but rows " + example);
    throw std::runtime_error(path + ": has several rows; name one, " + example);
}

CriterionFactory Thresholds(const std::string& argument, const RuleContext& context) {
    if (argument.empty()) throw std::invalid_argument("the name of a thresholds file is missing");
    // Take all of it for the file if there is one of that name: paths may have colons in them.
    std::string path = argument, name;
    const size_t colon = argument.rfind(':');
    if (colon != std::string::npos && !std::filesystem::exists(path)) {
        path = argument.substr(0, colon);
        name = argument.substr(colon + 1);
    }
    const ThresholdsRow row = ChooseRow(ReadThresholds(path), path, name, context.sceneName);
    if (context.blockCount > 0 && int(row.spp.size()) != context.blockCount)
        throw std::runtime_error(path + ": '" + row.name + "' has thresholds for " +
                                 std::to_string(row.spp.size()) + " blocks, the image has " +
                                 std::to_string(context.blockCount));
    return {.checksum = FileChecksum(path), .make = [row](const BlockInfo& block) {
                if (block.index < 0 || block.index >= int(row.spp.size()))
                    throw std::invalid_argument("'" + row.name + "' has no threshold for block " +
                                                std::to_string(block.index));
                return MakeFixed(row.spp[size_t(block.index)]);
            }};
}

CriterionFactory Learned(const std::string& argument, const RuleContext& context) {
    const std::string path = ModelPath(argument, context.models);
    const auto model = std::make_shared<const Model>(ReadModelFor(path, context));
    // Make one now, so that a model that does not fit is an error before anything is rendered.
    try {
        MakeLearned(model, context.passSpp);
    } catch (const std::invalid_argument& error) {
        throw std::runtime_error(path + ": " + error.what());
    }
    // Noise falls with the root of the spp: a caution of X takes X^2 times as many.
    std::vector<double> logRatios = model->logRatios;
    for (double& ratio : logRatios) ratio -= 2 * std::log(context.caution);
    const double undecided = UndecidedNoise(*model);
    // Otherwise its odds are followed, whatever it sees.
    const bool followsDrops = undecided > 0 && Needs(model->settings, Feature::VisibleDrop);
    return {.checksum = model->checksum,
            .logRatios = std::move(logRatios),
            .trend = {.kind = RuleTrend::Probability,
                      .votes = model->settings.votes,
                      .undecided = undecided,
                      .reference = followsDrops ? ReferenceOf(model->settings.visibility) : 0,
                      .saturates = followsDrops},
            .smallestSide = smallestVotingSide,
            .make = [model, passSpp = context.passSpp](const BlockInfo&) {
                return MakeLearned(model, passSpp);
            }};
}

// Only these have a threshold of visible noise.
void CheckCaution(const std::string& kind, double caution) {
    if (!(caution > 0) || !std::isfinite(caution))
        throw std::invalid_argument("caution must be above 0");
    if (caution != 1 && kind != "entropy" && kind != "lnoise" && kind != "learned")
        throw std::invalid_argument(
            "caution divides a threshold of visible noise, and this rule has none; entropy, lnoise "
            "and learned have one");
}

CriterionFactory MakeFactory(const std::string& kind, const std::string& argument,
                             const RuleContext& context) {
    if (kind == "fixed") return Fixed(argument);
    if (kind == "dammertz") return Dammertz(argument);
    if (kind == "cycles") return Cycles(argument);
    if (kind == "luxtile") return LuxTile(argument);
    if (kind == "lnoise") return LNoise(argument, context);
    if (kind == "entropy") return Entropy(argument, context);
    if (kind == "thresholds") return Thresholds(argument, context);
    if (kind == "learned") return Learned(argument, context);
    throw std::invalid_argument("there is no such rule; there are " + std::string(ruleForms));
}

}  // namespace

void Criterion::Restore(std::span<const std::byte> state) {
    if (!state.empty())
        throw std::runtime_error("the saved state belongs to another stopping rule");
}

CriterionFactory MakeCriterionFactory(const std::string& given, const RuleContext& context) {
    const std::string rule = WithThreshold(given);
    const size_t colon = rule.find(':');
    const std::string kind = rule.substr(0, colon);
    const std::string argument = colon == std::string::npos ? "" : rule.substr(colon + 1);
    try {
        CheckCaution(kind, context.caution);
        CriterionFactory factory = MakeFactory(kind, argument, context);
        factory.rule = rule;
        if (context.caution != 1) {
            char text[32];
            const auto end = std::to_chars(text, text + sizeof(text), context.caution).ptr;
            factory.rule.append(", caution ").append(text, end);
        }
        if (kind == "fixed" || kind == "thresholds") factory.trend.kind = RuleTrend::Samples;
        if (kind == "lnoise" || kind == "entropy") factory.trend.votes = VoteCounter().needed;
        return factory;
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("stopping rule '" + rule + "': " + error.what());
    }
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
    throw std::runtime_error("there is no model '" + name + "' in '" + models + "'; " +
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
    settings.visibility = VisibilityIn(context, settings.visibility);
    return model;
}

}  // namespace lull
