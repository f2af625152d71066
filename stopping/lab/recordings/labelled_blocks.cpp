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

BlockSplit LeaveOut(std::span<const LabelledBlock> blocks, std::span<const std::string> names) {
    BlockSplit split;
    for (const std::string& name : names) {
        if (std::ranges::find(blocks, name, &LabelledBlock::viewpoint) == blocks.end())
            throw std::invalid_argument("--leave-out: there is no viewpoint '" + Printable(name) +
                                        "'");
        split.name.append(split.name.empty() ? "" : ", ").append(name);
    }
    for (const LabelledBlock& block : blocks) {
        const bool isOut = std::ranges::find(names, block.viewpoint) != names.end();
        (isOut ? split.test : split.training).push_back(block);
    }
    return split;
}

std::vector<BlockSplit> LeaveEachOut(std::span<const LabelledBlock> blocks,
                                     std::span<const std::string> together) {
    // Of each part that is left out, the names of its viewpoints; `together` first.
    std::vector<std::vector<std::string>> parts(together.size());
    for (const LabelledBlock& block : blocks) {
        const auto group = std::ranges::find_if(together, [&](const std::string& beginning) {
            return block.viewpoint.starts_with(beginning);
        });
        if (group == together.end() &&
            (parts.size() == together.size() || parts.back().front() != block.viewpoint))
            parts.emplace_back();
        std::vector<std::string>& part =
            group == together.end() ? parts.back() : parts[size_t(group - together.begin())];
        if (part.empty() || part.back() != block.viewpoint) part.push_back(block.viewpoint);
    }
    std::vector<BlockSplit> splits;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].empty())
            throw std::invalid_argument("--together: no viewpoint's name begins with '" +
                                        Printable(together[i]) + "'");
        splits.push_back(LeaveOut(blocks, parts[i]));
    }
    if (splits.size() < 2)
        throw std::invalid_argument(
            "--cross-validate: two viewpoints are needed, to leave each out in turn");
    return splits;
}

void KeepListed(std::span<const ThresholdsRow> rows, BlockSplit* split) {
    std::vector<LabelledBlock> kept;
    for (const LabelledBlock& block : split->training) {
        const auto row = std::ranges::find(rows, block.viewpoint, &ThresholdsRow::name);
        if (row == rows.end())
            throw std::invalid_argument("has no row '" + Printable(block.viewpoint) + "'");
        const bool isListed = std::ranges::find(row->spp, block.block) != row->spp.end();
        (isListed ? kept : split->test).push_back(block);
    }
    split->training = std::move(kept);
}

std::vector<LabelledBlock> TestBlocks(std::span<const LabelledBlock> blocks,
                                      std::span<const ThresholdsRow> rows) {
    BlockSplit split{.training = {blocks.begin(), blocks.end()}};
    KeepListed(rows, &split);
    if (split.test.empty())
        throw std::invalid_argument("lists all blocks, so that none is left to judge by");
    return std::move(split.test);
}

}  // namespace lull
