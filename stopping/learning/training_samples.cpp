#include "stopping/learning/training_samples.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "stopping/network/block_memory.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

const char* const needed = ": recordings have H for m = 4, 25, 100 and 400, H1 and H2 for m = 100";

std::string EntropyChannel(Feature feature, int m) {
    if (feature == Feature::H && (m == 4 || m == 25 || m == 100 || m == 400))
        return std::string("h").append(std::to_string(m));
    if (feature == Feature::H1 && m == 100) return "h1";
    if (feature == Feature::H2 && m == 100) return "h2";
    throw std::invalid_argument(FeatureNames({&feature, 1}) + " with m = " + std::to_string(m) +
                                needed);
}

}  // namespace

SubBlockLightness LightnessOf(const BlockRecording& recording, int i) {
    const std::span<const float> mean = recording.Values(i, "lightness");
    const std::span<const float> deviation = recording.Values(i, "deviation");
    return {.mean = {mean.begin(), mean.end()}, .deviation = {deviation.begin(), deviation.end()}};
}

BlockMeasures MeasuresOf(const BlockRecording& recording, int i, const ModelSettings& settings) {
    BlockMeasures measures{.spp = recording.spp[size_t(i)]};
    for (Feature feature : settings.features) {
        if (feature == Feature::LogSpp) continue;
        if (IsDrop(feature)) {
            const Feature entropy = EntropyOf(feature);
            const std::span<const float> values =
                recording.Values(i, EntropyChannel(entropy, settings.m));
            measures.Of(entropy).assign(values.begin(), values.end());
            if (feature == Feature::VisibleDrop) measures.lightness = LightnessOf(recording, i);
            continue;
        }
        if (feature == Feature::DetailMaskedNoise) {
            measures.Of(feature) =
                DetailMaskedNoise(recording.Values(i, "half_noise"),
                                  recording.Values(i, "deviation"), recording.Values(i, "texture"));
            continue;
        }
        // Other features have the names of their channels.
        const std::span<const float> values =
            recording.Values(i, IsEntropy(feature) ? EntropyChannel(feature, settings.m)
                                                   : FeatureNames({&feature, 1}));
        measures.Of(feature).assign(values.begin(), values.end());
    }
    return measures;
}

std::vector<JudgedBlock> KeepRecorded(std::span<const JudgedBlock> blocks,
                                      const ModelSettings& settings) {
    std::vector<JudgedBlock> kept;
    for (const JudgedBlock& block : blocks)
        if (std::ranges::find(settings.features, Feature::Attributes26) ==
                settings.features.end() ||
            !block.recording->absent[ChannelIndex("attributes26")])
            kept.push_back(block);
    return kept;
}

std::vector<JudgedBlock> JoinHuman(std::span<const ViewpointRecording> viewpoints,
                                   std::span<const ThresholdsRow> human,
                                   std::vector<std::string>* unknown) {
    std::vector<JudgedBlock> blocks;
    std::set<std::string> names;
    for (const ViewpointRecording& viewpoint : viewpoints) {
        const std::string& name = viewpoint.name;
        if (!names.insert(name).second)
            throw std::invalid_argument("the viewpoint " + name + " comes twice");
        const auto row = std::find_if(human.begin(), human.end(),
                                      [&](const ThresholdsRow& r) { return r.name == name; });
        if (row == human.end()) {
            if (unknown) unknown->push_back(name);
            continue;
        }
        if (row->spp.size() != size_t(viewpoint.blockCount))
            throw std::invalid_argument("the viewpoint " + name + " has " +
                                        std::to_string(viewpoint.blockCount) + " blocks and " +
                                        std::to_string(row->spp.size()) + " human thresholds");
        for (const auto& [number, recording] : viewpoint.blocks)
            blocks.push_back({name, number, row->spp.at(size_t(number)), viewpoint.cap,
                              viewpoint.passSpp, &recording});
        if (!blocks.empty() && blocks.front().passSpp != viewpoint.passSpp)
            throw std::invalid_argument("the viewpoint " + name + " was recorded in passes of " +
                                        std::to_string(viewpoint.passSpp) + " spp, not of " +
                                        std::to_string(blocks.front().passSpp));
    }
    return blocks;
}

TrainingSamples MakeSamples(std::span<const JudgedBlock> blocks, const ModelSettings& settings) {
    CheckSettings(settings);
    TrainingSamples samples{.settings = settings, .windowSize = settings.k * InputCount(settings)};
    std::map<std::string, int> viewpoints;
    for (const JudgedBlock& block : blocks) {
        const int viewpoint =
            viewpoints.try_emplace(block.viewpoint, int(viewpoints.size())).first->second;
        const BlockRecording& recording = *block.recording;
        BlockMemory memory(settings);
        int expected = block.passSpp;  // the next spp of the grid
        for (int i = 0; i < recording.Count(); ++i) {
            const int spp = recording.spp[size_t(i)];
            if (spp < expected) continue;
            // The last pass of a recording may be off the grid.
            if (spp > expected && i + 1 < recording.Count())
                throw std::invalid_argument(
                    "block " + std::to_string(block.block) + " of " + block.viewpoint +
                    " is not recorded at " + std::to_string(expected) +
                    " spp; n = " + std::to_string(settings.n) + " does not fit");
            if (spp > expected) break;
            expected += settings.n;
            memory.Add(MeasuresOf(recording, i, settings));
            const std::optional<Eigen::MatrixXf> window = memory.WindowAt(spp);
            if (!window) continue;
            samples.windows.insert(samples.windows.end(), window->data(),
                                   window->data() + window->size());
            samples.noisy.push_back(block.human > spp);
            samples.viewpoint.push_back(viewpoint);
        }
    }
    return samples;
}

}  // namespace lull
