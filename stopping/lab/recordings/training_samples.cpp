#include "stopping/lab/recordings/training_samples.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "stopping/features/block_memory.h"

namespace lull {

RecordedValues ValuesOf(const BlockRecording& recording, int i) {
    return [&recording, i](std::string_view channel) { return recording.Values(i, channel); };
}

BlockMeasures MeasuresOf(const BlockRecording& recording, int i, const ModelSettings& settings) {
    return RecordedMeasures(recording.spp[size_t(i)], ValuesOf(recording, i), settings);
}

std::vector<LabelledBlock> KeepRecorded(std::span<const LabelledBlock> blocks,
                                        const ModelSettings& settings) {
    std::vector<LabelledBlock> kept;
    for (const LabelledBlock& block : blocks)
        if (std::ranges::find(settings.features, Feature::Attributes26) ==
                settings.features.end() ||
            !block.recording->absent[ChannelIndex("attributes26")])
            kept.push_back(block);
    return kept;
}

std::vector<LabelledBlock> JoinHuman(std::span<const ViewpointRecording> viewpoints,
                                     std::span<const ThresholdsRow> human,
                                     std::vector<std::string>* unknown) {
    std::vector<LabelledBlock> blocks;
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

TrainingSamples MakeSamples(std::span<const LabelledBlock> blocks, const ModelSettings& settings) {
    CheckSettings(settings);
    TrainingSamples samples{.settings = settings, .windowSize = settings.k * InputCount(settings)};
    std::map<std::string, int> viewpoints;
    for (const LabelledBlock& block : blocks) {
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
