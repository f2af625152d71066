// Compares forecasts with the stops of recorded blocks, from which their ranges come.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

#include "renderer/progress/forecast.h"
#include "stopping/lab/evaluation/simulation.h"
#include "stopping/rules/rule_table.h"

namespace lull::recorded_forecasts_test {
namespace {

constexpr int kCap = 10000, kFirstSpp = 60;  // spp
constexpr double kTail = 0.09;               // share of exponents below a range, and above it
constexpr const char* kRules[] = {"learned", "entropy", "lnoise"};

struct Forecast {
    std::string rule, scene;
    double spp = 0;  // samples per pixel when it is made, of the blocks at work
    double taken = 0, left = 0, truth = 0;  // samples of all blocks: taken, predicted, in the end
    bool isHeld = false;                    // by the range that other scenes give

    double Exponent() const { return std::log(truth / taken) / std::log1p(left / taken); }
};

// A block that its rule has stopped, or that is recorded to the cap.
struct Replayed {
    std::vector<int> spp;
    std::vector<Decision> decisions = {};
    std::vector<std::optional<double>> noise = {};
    int stop = 0;
};

Replayed ReplayOf(const LabelledBlock& block, const Rule& rule) {
    Replayed made{.spp = block.recording->spp};
    made.decisions = ReplayRule(block, rule, &made.noise);
    const auto stop = std::ranges::find(made.decisions, true, &Decision::stop);
    if (stop != made.decisions.end())
        made.stop = made.spp[size_t(stop - made.decisions.begin())];
    else if (made.spp.back() >= kCap)
        made.stop = kCap;
    return made;
}

// Adds the forecasts of a viewpoint, 41 % more spp each.
void AddForecasts(const Rule& rule, const std::vector<Replayed>& blocks, Forecast forecast,
                  std::vector<Forecast>* forecasts) {
    for (double spp = kFirstSpp; spp < kCap; spp *= std::sqrt(2)) {
        std::vector<StopTrend> trends(blocks.size(), StopTrend(rule.trend));
        std::vector<Block> live;
        forecast.taken = forecast.truth = forecast.left = 0;
        for (size_t i = 0; i < blocks.size(); ++i) {
            const Replayed& block = blocks[i];
            for (size_t k = 0; k < block.spp.size() && block.spp[k] <= spp; ++k)
                if (block.decisions[k].checked)
                    trends[i].Add(block.spp[k], block.decisions[k], block.noise[k]);
            live.push_back({.pixels = {{0, 0}, {200, 200}},
                            .spp = std::min(block.stop, int(spp) / 20 * 20),
                            .stopped = block.stop <= spp});
            forecast.taken += live.back().spp;
            forecast.truth += block.stop;
        }
        if (std::ranges::all_of(live, &Block::stopped)) break;
        const auto stops = PredictStops(trends, live, kCap);
        if (!stops) continue;
        for (size_t i = 0; i < live.size(); ++i) forecast.left += (*stops)[i] - live[i].spp;
        forecast.spp = spp;
        if (forecast.left > 0) forecasts->push_back(forecast);
    }
}

std::vector<Forecast> ForecastsOfRecordings() {
    const std::string folder = LULL_SCENES_DIR "/../stopping/data/";
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".h5") files.push_back(entry.path().string());
    std::ranges::sort(files);
    const std::vector<ViewpointRecording> recordings = ReadDatasets(files);
    const std::vector<LabelledBlock> blocks =
        ReadLabelledBlocks(recordings, folder + "human.csv", {}, [](const std::string&) {});
    std::vector<Forecast> forecasts;
    for (const char* name : kRules) {
        const Rule rule =
            ParseRule(name, {.cap = kCap, .models = LULL_SCENES_DIR "/../stopping/models"});
        std::map<std::string, std::vector<Replayed>> viewpoints;
        for (const LabelledBlock& block : blocks)
            if (Replayed made = ReplayOf(block, rule); made.stop > 0)
                viewpoints[block.viewpoint].push_back(std::move(made));
        for (const auto& [viewpoint, replayed] : viewpoints)
            // Views of one scene have its name in front.
            AddForecasts(rule, replayed,
                         {.rule = name, .scene = viewpoint.substr(0, viewpoint.find('-'))},
                         &forecasts);
    }
    return forecasts;
}

// Returns the quantile of exponents, of which each scene has the same weight with each rule.
double QuantileOf(const std::vector<Forecast>& forecasts, double share,
                  const std::string& without = "") {
    std::map<std::string, int> counts;
    std::vector<std::pair<double, std::string>> exponents;
    for (const Forecast& f : forecasts)
        if (f.scene != without) {
            ++counts[f.rule + f.scene];
            exponents.emplace_back(f.Exponent(), f.rule + f.scene);
        }
    std::ranges::sort(exponents);
    double sum = 0;
    for (const auto& [exponent, group] : exponents)
        if ((sum += 1.0 / counts[group]) >= share * double(counts.size())) return exponent;
    return exponents.back().first;
}

template <typename Which>
int PercentHeld(const std::vector<Forecast>& forecasts, const Which& which) {
    int all = 0, held = 0;
    for (const Forecast& f : forecasts)
        if (which(f)) {
            ++all;
            held += f.isHeld;
        }
    return all > 0 ? int(std::lround(100. * held / all)) : 0;
}

// The exponents of RangeOfRest() are these quantiles, and those of other scenes hold a scene as
// often as tests/measurements/models.md says.
TEST(RecordedForecasts, AreHeldByTheirRanges) {
    std::vector<Forecast> forecasts = ForecastsOfRecordings();
    const auto [least, most] =
        RangeOfRest(1, std::exp(1.) - 1, RuleTrend().exponents);  // e^exponent - 1
    EXPECT_NEAR(std::log1p(least), QuantileOf(forecasts, kTail), 0.01);
    EXPECT_NEAR(std::log1p(most), QuantileOf(forecasts, 1 - kTail), 0.01);

    std::map<std::string, std::array<double, 2>> ranges;  // of exponents, from the other scenes
    for (const Forecast& f : forecasts)
        if (!ranges.contains(f.scene))
            ranges[f.scene] = {QuantileOf(forecasts, kTail, f.scene),
                               QuantileOf(forecasts, 1 - kTail, f.scene)};
    for (Forecast& f : forecasts) {
        const auto& [low, high] = ranges.at(f.scene);
        f.isHeld = low <= f.Exponent() && f.Exponent() <= high;
    }
    std::string table;
    for (const std::string rule : kRules) {
        const auto heldFrom = [&](double from, double to) {
            return PercentHeld(forecasts, [&](const Forecast& f) {
                return f.rule == rule && from <= f.spp && f.spp < to;
            });
        };
        table += fmt::format("{} {} |", rule, heldFrom(0, kCap));
        for (const double from : {60., 120., 240., 480., 960.})
            table += fmt::format(" {}", heldFrom(from, 2 * from));
        table += fmt::format(" {}\n", heldFrom(1920, kCap));
    }
    for (const auto& [scene, range] : ranges)
        table += fmt::format("{} {}\n", scene, PercentHeld(forecasts, [&](const Forecast& f) {
                                 return f.scene == scene;
                             }));
    EXPECT_NEAR(PercentHeld(forecasts, [](const Forecast&) { return true; }), 81, 2) << table;
}

}  // namespace
}  // namespace lull::recorded_forecasts_test
