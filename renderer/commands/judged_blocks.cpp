#include "renderer/commands/judged_blocks.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"

namespace lull {

std::vector<ViewpointRecording> ReadDatasets(const std::vector<std::string>& paths) {
    std::vector<ViewpointRecording> all;
    for (const std::string& path : paths)
        for (const ViewpointRecording& viewpoint : ReadDataset(path)) try {
                AddToDataset(viewpoint, &all);
            } catch (const std::runtime_error& error) {
                throw Error(path + ": " + error.what());
            }
    return all;
}

std::vector<JudgedBlock> ReadJudgedBlocks(const std::vector<ViewpointRecording>& viewpoints,
                                          const std::string& human,
                                          const std::vector<std::string>& without) try {
    std::vector<ThresholdsRow> rows = ReadThresholds(human);
    for (const std::string& name : without)
        if (std::erase_if(rows, [&](const ThresholdsRow& row) { return row.name == name; }) == 0 &&
            std::ranges::find(viewpoints, name, &ViewpointRecording::name) == viewpoints.end())
            throw Error(fmt::format("--without: there is no viewpoint '{}'", name));
    std::vector<std::string> unknown;
    std::vector<JudgedBlock> blocks = JoinHuman(viewpoints, rows, &unknown);
    for (const std::string& name : unknown)
        if (std::ranges::find(without, name) == without.end())
            fmt::print(stderr, "lull: {} has no thresholds for '{}'\n", human, name);
    if (blocks.empty()) throw Error("no block is left that was recorded and judged by people");
    return blocks;
} catch (const std::invalid_argument& error) {
    throw Error(human + ": " + error.what());
}

}  // namespace lull
