#include "stopping/features/block_memory.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lull {

BlockMemory::BlockMemory(const ModelSettings& settings) : settings(settings) {
    CheckSettings(settings);
}

void BlockMemory::Add(BlockMeasures measures) {
    if (Complete(&measures))
        AddInputs(measures.spp, InputVector(measures, settings), settings, &inputs);
}

bool BlockMemory::Complete(BlockMeasures* measures) {
    if (!Needs(settings, Feature::VisibleDrop)) return true;
    AddEntropies(measures->spp, measures->Of(Feature::H), &entropies);
    std::optional<std::vector<double>> drop =
        LatestVisibleDrop(entropies, measures->lightness, settings.visibility);
    if (drop) measures->Of(Feature::VisibleDrop) = std::move(*drop);
    return drop.has_value();
}

void BlockMemory::Save(StateWriter* writer) const {
    writer->Put(uint32_t(InputCount(settings)));
    inputs.Save(writer);
    entropies.Save(writer);
}

void BlockMemory::Restore(StateReader* reader) {
    const uint32_t count = uint32_t(InputCount(settings));
    if (reader->Get<uint32_t>() != count)
        throw std::runtime_error("the saved state belongs to a model with other inputs");
    inputs.Restore(reader, count);
    entropies.Restore(reader, size_t(settings.m));
}

namespace {

const BlockState<double>* FindStep(const History<double>& history, const ModelSettings& settings,
                                   int spp, int stepsBefore) {
    if (settings.spacing == Spacing::Fixed) {
        const int64_t at = int64_t(spp) - int64_t(stepsBefore) * settings.n;
        return at > 0 ? history.At(int(at)) : nullptr;
    }
    const auto& states = history.States();
    if (states.empty() || states.back().spp != spp) return nullptr;
    if (stepsBefore == 0) return &states.back();
    // So near that no step is nearer to another place of the window.
    return history.Nearest(spp / std::pow(settings.ratio, stepsBefore), std::sqrt(settings.ratio));
}

}  // namespace

Eigen::ArrayXd Normalize(const Eigen::ArrayXd& values) {
    const double min = values.minCoeff(), max = values.maxCoeff();
    return (values - min) / (max - min + std::numeric_limits<double>::epsilon());
}

void AddInputs(int spp, std::vector<double> inputs, const ModelSettings& settings,
               History<double>* history) {
    if (inputs.size() != size_t(InputCount(settings)))
        throw std::invalid_argument("inputs of " + std::to_string(InputCount(settings)) +
                                    " values are needed");
    history->Add({spp, std::move(inputs)});
    if (settings.spacing == Spacing::Geometric)
        history->Thin(std::pow(settings.ratio, settings.k - 1));
    else
        history->ForgetBelow(int64_t(spp) - int64_t(settings.k - 1) * settings.n);
}

std::optional<Eigen::MatrixXf> WindowOf(const History<double>& history,
                                        const ModelSettings& settings, int spp) {
    const int count = InputCount(settings);
    Eigen::ArrayXXd window(count, settings.k);
    for (int step = 0; step < settings.k; ++step) {
        const BlockState<double>* state = FindStep(history, settings, spp, settings.k - 1 - step);
        if (!state) return {};
        window.col(step) = Eigen::Map<const Eigen::ArrayXd>(state->values.data(), count);
    }
    // Normalise in double: late in a rendering the values of a window differ by little.
    for (const InputRange& range : InputRanges(settings))
        if (settings.snorm && IsNormalized(range.feature))
            for (int i = range.begin; i < range.begin + range.count; ++i)
                window.row(i) = Normalize(window.row(i).transpose()).transpose();
    return window.matrix().cast<float>();
}

}  // namespace lull
