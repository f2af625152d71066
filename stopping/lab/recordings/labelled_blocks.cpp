#include "stopping/lab/recordings/labelled_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "stopping/base/input_file.h"

namespace lull {

std::vector<ViewpointRecording> ReadDatasets(const std::vector<std::string>& paths) {
    std::vector<ViewpointRecording> all;
    for (const std::string& path : paths)
        for (const ViewpointRecording& viewpoint : ReadDataset(path)) try {
                AddToDataset(viewpoint, &all);
            } catch (const std::runtime_error& error) {
                throw std::runtime_error(path + ": " + error.what());
            }
    return all;
}

std::vector<LabelledBlock> ReadLabelledBlocks(const std::vector<ViewpointRecording>& viewpoints,
                                              const std::string& human,
                                              const std::vector<std::string>& without,
                                              const WarningSink& warn) try {
    std::vector<ThresholdsRow> rows = ReadThresholds(human);
    for (const std::string& name : without)
        if (std::erase_if(rows, [&](const ThresholdsRow& row) { return row.name == name; }) == 0 &&
            std::ranges::find(viewpoints, name, &ViewpointRecording::name) == viewpoints.end())
            throw std::runtime_error(
                fmt::format("--without: there is no viewpoint '{}'", Printable(name)));
    std::vector<std::string> unknown;
    std::vector<LabelledBlock> blocks = JoinHuman(viewpoints, rows, &unknown);
    for (const std::string& name : unknown)
        if (std::ranges::find(without, name) == without.end())
            warn(fmt::format("{} has no thresholds for '{}'", human, Printable(name)));
    if (blocks.empty())
        throw std::runtime_error(human + ": has thresholds for none of the recorded blocks");
    return blocks;
} catch (const std::invalid_argument& error) {
    throw std::runtime_error(human + ": " + error.what());
}

std::vector<LabelledBlock> KeepRecorded(const std::vector<LabelledBlock>& judged,
                                        const ModelSettings& settings, const WarningSink& warn) {
    if (!Needs(settings, Feature::Attributes26)) return judged;
    std::vector<LabelledBlock> blocks;
    for (const LabelledBlock& block : judged)
        if (!block.recording->absent[ChannelIndex("attributes26")]) blocks.push_back(block);
    if (blocks.empty()) throw std::runtime_error("no block was recorded with attributes26");
    if (blocks.size() < judged.size())
        warn(fmt::format("{} of {} blocks were recorded without attributes26",
                         judged.size() - blocks.size(), judged.size()));
    return blocks;
}

}  // namespace lull
