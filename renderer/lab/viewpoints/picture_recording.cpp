#include "renderer/lab/viewpoints/picture_recording.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "stopping/base/parallel.h"

namespace lull {

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
        throw Error(fmt::format("{}: has no block of {} pixels a side or more to record",
                                folder.files.begin()->second, kSmallestVotingSide));
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
