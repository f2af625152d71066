#include "renderer/lab/viewpoints/recorded_viewpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "renderer/files/outputs.h"
#include "renderer/render/peers.h"
#include "stopping/base/block_view.h"
#include "stopping/base/input_file.h"
#include "stopping/base/parallel.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

int64_t SamplesUpTo(const std::vector<int>& limits, const std::vector<Block>& blocks,
                    const ScheduleOptions& schedule) {
    int64_t samples = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
        const int pass = schedule.passLength;
        const int spp = std::min((limits[i] + pass - 1) / pass * pass, schedule.cap);
        samples += spp * blocks[i].pixels.Area();
    }
    return samples;
}

RenderState Beginning(const std::vector<Block>& blocks, const std::vector<int>& limits) {
    RenderState state;
    state.criteria.resize(blocks.size());
    for (size_t i = 0; i < blocks.size(); ++i) {
        BlockResult& result = state.blocks.emplace_back();
        result.block = blocks[i];
        result.block.stopped = limits[i] == 0;
    }
    return state;
}

}  // namespace

void CheckRecordable(const std::vector<Block>& blocks, const ScheduleOptions& schedule) {
    for (const Block& block : blocks)
        if (std::min(block.pixels.Width(), block.pixels.Height()) < kSmallestVotingSide)
            throw Error(
                "blocks of less than {} pixels a side cannot be recorded; choose a --resolution "
                "that is a multiple of {}",
                kSmallestVotingSide, schedule.blockSize);
}

std::string CheckViewpointName(const std::string& name) {
    return !name.empty() && name.find_first_of("/;\n") == std::string::npos
               ? ""
               : "a name has at least one character, and none of / and ;";
}

std::vector<ViewpointRecording> ReadDatasetIfThere(const std::string& path) {
    if (!IsThere(path)) return {};
    return ReadDataset(path);
}

void AddToDatasetFile(const ViewpointRecording& viewpoint, const std::string& path,
                      const std::function<void()>& onWait) {
    const FileLock lock = FileLock::Wait(path, onWait);
    std::vector<ViewpointRecording> dataset = ReadDatasetIfThere(path);
    AddToDataset(viewpoint, &dataset);
    WriteFileAtomically(path, EncodeDataset(dataset));
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

std::vector<int> RecordingLimits(size_t blockCount, const std::vector<int>& chosen, int cap) {
    std::vector<int> limits(blockCount, chosen.empty() ? cap : 0);
    for (const int block : chosen) {
        if (size_t(block) >= blockCount)
            throw Error("--blocks: there is no block {}, the last of the image is {}", block,
                        blockCount - 1);
        limits[size_t(block)] = cap;
    }
    return limits;
}

void LimitByHuman(const std::string& human, const std::string& viewpoint, double past,
                  std::vector<int>* limits) {
    const std::vector<ThresholdsRow> rows = ReadThresholds(human);
    const auto row = std::ranges::find(rows, viewpoint, &ThresholdsRow::name);
    if (row == rows.end()) throw Error("{}: has no row '{}'", human, viewpoint);
    if (row->spp.size() != limits->size())
        throw Error("{}: '{}' has {} blocks, the image {}", human, viewpoint, row->spp.size(),
                    limits->size());
    for (size_t i = 0; i < limits->size(); ++i)
        (*limits)[i] = std::min((*limits)[i], int(std::ceil(past * row->spp[i])));
}

RenderResult RecordBlocks(RenderOptions options, const std::vector<int>& limits,
                          ViewpointRecording* viewpoint) {
    const ScheduleOptions& schedule = options.schedule;
    const std::vector<Block> blocks = MakeBlocks(options.film->Region(), schedule);
    std::vector<BlockRecording> recordings(blocks.size());
    options.makeCriterion = [&](const BlockInfo& info) {
        const size_t i = size_t(info.index);
        return std::make_unique<BlockRecorder>(schedule.passLength, schedule.cap, limits[i],
                                               &recordings[i]);
    };
    const int64_t wanted = SamplesUpTo(limits, blocks, schedule);
    if (auto& onProgress = options.events.onProgress)
        onProgress = [wanted, tell = onProgress](RenderProgress progress) {
            progress.samplesToCap = wanted - progress.samples;
            tell(progress);
        };
    const RenderState beginning = Beginning(blocks, limits);
    if (!options.interrupted) options.interrupted = &beginning;
    RenderResult result = Render(options);
    if (result.cancelled || (options.peers && options.peers->Rank() > 0)) return result;
    for (size_t i = 0; i < blocks.size(); ++i)
        if (limits[i] > 0) AddBlock(i, std::move(recordings[i]), result.blocks[i], viewpoint);
    return result;
}

namespace {

bool IsLargeEnough(const Block& block) {
    return std::min(block.pixels.Width(), block.pixels.Height()) >= kSmallestVotingSide;
}

}  // namespace

ViewpointRecording DescribePictures(const PictureFolder& folder, int blockSize) {
    ViewpointRecording viewpoint;
    viewpoint.name = folder.name;
    viewpoint.blockCount = int(MakeBlocks(folder.Region(), {.blockSize = blockSize}).size());
    viewpoint.cap = folder.files.rbegin()->first;
    viewpoint.passSpp = PassOfPictures(folder.Spp());
    viewpoint.provenance = {{"renderer", "another"},
                            {"resolution", fmt::format("{}x{}", folder.width, folder.height)},
                            {"block", std::to_string(blockSize)}};
    return viewpoint;
}

ViewpointRecording RecordPictures(const PictureFolder& folder,
                                  const PictureRecordingOptions& options) {
    ViewpointRecording viewpoint = DescribePictures(folder, options.blockSize);
    const std::vector<Block> blocks = MakeBlocks(folder.Region(), {.blockSize = options.blockSize});
    const auto limitOf = [&](size_t i) {
        return options.limits.empty() ? viewpoint.cap : options.limits[i];
    };
    std::vector<size_t> recorded;
    for (size_t i = 0; i < blocks.size(); ++i)
        if (IsLargeEnough(blocks[i]) && limitOf(i) > 0) recorded.push_back(i);
    if (recorded.empty())
        throw Error("{}: has no block of {} pixels a side or more to record",
                    folder.files.begin()->second, kSmallestVotingSide);
    std::vector<BlockRecording> recordings(blocks.size());
    int read = 0;
    for (const int spp : folder.Spp()) {
        if (options.onPicture) options.onPicture(read++, int(folder.files.size()));
        const auto isOpen = [&](size_t i) {
            return recordings[i].spp.empty() || recordings[i].spp.back() < limitOf(i);
        };
        if (std::ranges::none_of(recorded, isOpen)) break;
        const RgbImage picture = ReadPicture(folder, spp);
        ForEachIndex(int(recorded.size()), [&](int k) {
            const size_t i = recorded[size_t(k)];
            if (!isOpen(i)) return;
            const PixelRect& rect = blocks[i].pixels;
            const std::vector<float> pixels = CutPixels(picture.values, picture.width, rect);
            AddPicture({.width = rect.Width(), .height = rect.Height(), .spp = spp, .mean = pixels},
                       &recordings[i]);
        });
    }
    for (const size_t i : recorded) {
        viewpoint.blocks[int(i)] = std::move(recordings[i]);
        viewpoint.blockNotes[int(i)] = "pictures of another renderer";
    }
    return viewpoint;
}

}  // namespace lull
