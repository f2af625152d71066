#include "renderer/render/schedule.h"

#include "stopping/rules/small_blocks.h"

namespace lull {

namespace {

int CeilDiv(int a, int b) { return (a + b - 1) / b; }

}  // namespace

std::vector<Block> MakeBlocks(const PixelRect& region, const ScheduleOptions& options) {
    const int size = options.blockSize;
    std::vector<Block> blocks;
    for (int y = region.min.y(); y < region.max.y(); y += size)
        for (int x = region.min.x(); x < region.max.x(); x += size)
            blocks.push_back({.pixels = {{x, y},
                                         {std::min(x + size, region.max.x()),
                                          std::min(y + size, region.max.y())}}});

    std::vector<BlockSize> sizes;
    for (const Block& block : blocks)
        sizes.push_back({block.pixels.Width(), block.pixels.Height()});
    const std::vector<int> leaders =
        BlockLeaders(std::max(1, CeilDiv(region.Width(), size)), sizes, options.smallestSide);
    for (int i = 0; i < int(blocks.size()); ++i) {
        blocks[i].votes = leaders[i] == i;
        blocks[i].leader = blocks[i].votes ? -1 : leaders[i];
    }
    return blocks;
}

Schedule::Schedule(const PixelRect& region, const ScheduleOptions& options,
                   std::span<const BlockStart> starts)
    : options(options), blocks(MakeBlocks(region, options)), progress(blocks.size()) {
    for (size_t i = 0; i < starts.size(); ++i) {
        blocks[i].spp = starts[i].spp;
        if (starts[i].stopped) Stop(int(i), starts[i].stoppedByVote);
    }
    for (int i = 0; i < int(blocks.size()); ++i)
        if (blocks[i].leader >= 0)
            progress[blocks[i].leader].followers.push_back(i);
        else if (!blocks[i].stopped)
            GoOn(i);
    for (int i = 0; i < int(blocks.size()); ++i)
        if (blocks[i].leader >= 0) CatchUp(i);
}

// Starts the next pass of a block that nobody leads.
void Schedule::GoOn(int i) {
    StartPass(i, std::min(blocks[i].spp + options.passLength, options.cap));
}

int Schedule::TileCount(int block) const {
    const PixelRect& r = blocks[block].pixels;
    return CeilDiv(r.Width(), options.tileSize) * CeilDiv(r.Height(), options.tileSize);
}

void Schedule::StartPass(int block, int target) {
    Progress& pass = progress[block];
    pass.target = target;
    pass.tilesGiven = pass.tilesFinished = 0;
    pass.underWay = true;
    ready.insert({blocks[block].spp, block});
    readyTiles += TileCount(block);
}

std::optional<Tile> Schedule::Next() {
    if (ready.empty()) return {};
    const int i = ready.begin()->second;
    const Block& block = blocks[i];
    Progress& pass = progress[i];

    const int size = options.tileSize, columns = CeilDiv(block.pixels.Width(), size);
    const Vec2i min =
        block.pixels.min + size * Vec2i(pass.tilesGiven % columns, pass.tilesGiven / columns);
    const Vec2i max = (min + Vec2i(size, size)).cwiseMin(block.pixels.max);
    ++pass.tilesGiven;
    --readyTiles;
    if (pass.tilesGiven == TileCount(i)) ready.erase(ready.begin());
    return Tile{i, {min, max}, block.spp, pass.target - block.spp};
}

bool Schedule::Finish(const Tile& tile) {
    Progress& pass = progress[tile.block];
    if (++pass.tilesFinished < TileCount(tile.block)) return false;
    blocks[tile.block].spp = pass.target;
    pass.underWay = false;
    return true;
}

void Schedule::Decide(int i, bool stop) {
    const Block& block = blocks[i];
    if (block.leader >= 0) return CatchUp(i);

    stop &= block.votes;
    if (stop || block.spp >= options.cap)
        Stop(i, stop);
    else
        GoOn(i);
    for (const int follower : progress[i].followers) CatchUp(follower);
}

void Schedule::CatchUp(int follower) {
    const Block& block = blocks[follower];
    const Block& leader = blocks[block.leader];
    if (progress[follower].underWay || block.stopped) return;
    if (block.spp < leader.spp)
        StartPass(follower, std::min(block.spp + options.passLength, leader.spp));
    else if (leader.stopped)
        Stop(follower, leader.stoppedByVote);
}

void Schedule::Stop(int block, bool byVote) {
    blocks[block].stopped = true;
    blocks[block].stoppedByVote = byVote;
    ++stoppedBlocks;
}

int Schedule::MedianSpp() const {
    if (blocks.empty()) return 0;
    std::vector<int> spp;
    for (const Block& block : blocks) spp.push_back(block.spp);
    std::nth_element(spp.begin(), spp.begin() + spp.size() / 2, spp.end());
    return spp[spp.size() / 2];
}

int64_t Schedule::SamplesToCap() const {
    int64_t n = 0;
    for (const Block& block : blocks)
        if (!block.stopped) n += block.pixels.Area() * (options.cap - block.spp);
    return n;
}

}  // namespace lull
