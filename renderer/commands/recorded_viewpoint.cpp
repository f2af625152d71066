#include "renderer/commands/recorded_viewpoint.h"

#include <fmt/format.h>

#include <filesystem>

#include "stopping/rules/small_blocks.h"

namespace lull {

void CheckRecordable(const std::vector<Block>& blocks, const ScheduleOptions& schedule) {
    for (const Block& block : blocks)
        if (std::min(block.pixels.Width(), block.pixels.Height()) < smallestVotingSide)
            throw Error(
                fmt::format("blocks of less than {} pixels a side cannot be recorded; "
                            "choose a --resolution that is a multiple of {}",
                            smallestVotingSide, schedule.blockSize));
}

std::vector<ViewpointRecording> ReadDatasetIfThere(const std::string& path) {
    if (!std::filesystem::exists(path)) return {};
    return ReadDataset(path);
}

ViewpointRecording MakeViewpoint(const std::string& name, const ScheduleOptions& schedule,
                                 const RenderIdentity& identity, size_t blockCount) {
    ViewpointRecording viewpoint;
    viewpoint.name = name;
    viewpoint.blockCount = int(blockCount);
    viewpoint.cap = schedule.cap;
    viewpoint.passSpp = schedule.passLength;
    for (const auto& [key, value] : identity)
        if (key != "stop" && key != "model" && key != "cap" && key != "pass" && key != "version")
            viewpoint.provenance[key] = value;
    return viewpoint;
}

void AddBlock(size_t i, BlockRecording recording, const BlockResult& result,
              ViewpointRecording* viewpoint) {
    viewpoint->blocks[int(i)] = std::move(recording);
    viewpoint->blockNotes[int(i)] =
        fmt::format("{:.0f} s of threads for {} spp, {:.0f} s for the recording", result.seconds,
                    result.block.spp, result.criterionSeconds);
}

std::string CheckViewpointName(const std::string& name) {
    return !name.empty() && name.find_first_of("/;\n") == std::string::npos
               ? ""
               : "a name has at least one character, and none of / and ;";
}

}  // namespace lull
