#include "renderer/schedule/schedule.h"

#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

// How many times the samples of another block may be before that one goes first.
constexpr int kLargestLead = 16;

int CeilDiv(int a, int b) { return (a + b - 1) / b; }

int CountTiles(const PixelRect& r, int tileSize) {
    return CeilDiv(r.Width(), tileSize) * CeilDiv(r.Height(), tileSize);
}

PixelRect TileAt(const PixelRect& block, int tileSize, int tile) {
    const int columns = CeilDiv(block.Width(), tileSize);
    const Vec2i min = block.min + tileSize * Vec2i(tile % columns, tile / columns);
    return {min, (min + Vec2i(tileSize, tileSize)).cwiseMin(block.max)};
}

}  // namespace

std::vector<PixelRect> EyesOf(const PixelRect& region, int eyeWidth) {
    if (eyeWidth == 0) return {region};
    const int middle = region.min.x() + eyeWidth;
    return {{region.min, {middle, region.max.y()}}, {{middle, region.min.y()}, region.max}};
}

std::vector<Block> MakeBlocks(const PixelRect& region, const ScheduleOptions& options) {
    if (options.eyeWidth > 0) {
        ScheduleOptions ofEye = options;
        ofEye.eyeWidth = 0;
        const Vec2i across(options.eyeWidth, 0);
        std::vector<Block> blocks = MakeBlocks(EyesOf(region, options.eyeWidth)[0], ofEye);
        const int count = int(blocks.size());
        for (int i = 0; i < count; ++i) {
            Block right = blocks[size_t(i)];
            right.pixels = {right.pixels.min + across, right.pixels.max + across};
            if (right.leader >= 0) right.leader += count;
            right.partner = i;
            blocks[size_t(i)].partner = count + i;
            blocks.push_back(right);
        }
        return blocks;
    }
    const BlockGrid grid =
        CutIntoBlocks(region.Width(), region.Height(), options.blockSize, options.smallestSide);
    std::vector<Block> blocks;
    for (size_t i = 0; i < grid.blocks.size(); ++i) {
        const BlockRect& rect = grid.blocks[i];
        const Vec2i min = region.min + Vec2i(rect.x, rect.y);
        const bool votes = grid.leaders[i] == int(i);
        blocks.push_back({.pixels = {min, min + Vec2i(rect.width, rect.height)},
                          .votes = votes,
                          .leader = votes ? -1 : grid.leaders[i]});
    }
    return blocks;
}

int PassEndAfter(int spp, const ScheduleOptions& options) {
    const int pass = options.passLength;
    int end = (spp / pass + 1) * pass;
    // A step that would leave less than itself to the pass is all that is left of it.
    const bool inSteps = options.inSteps || options.worstFirst;
    if (const int step = std::max(1, 2 * spp); inSteps && 2 * step <= pass) end = step;
    if (spp < options.roundEnd) end = std::min(end, options.roundEnd);
    return std::min(end, options.cap);
}

bool IsPassEnd(int spp, const ScheduleOptions& options) {
    return spp % options.passLength == 0 || spp >= options.cap;
}

std::vector<PixelRect> TilesOf(const PixelRect& block, int index, int tileSize,
                               const RankTiles& share) {
    std::vector<PixelRect> tiles;
    for (int i = 0; i < CountTiles(block, tileSize); ++i)
        if (share.Has(index, i)) tiles.push_back(TileAt(block, tileSize, i));
    return tiles;
}

Schedule::Schedule(const PixelRect& region, const ScheduleOptions& options,
                   std::span<const BlockStart> starts, const RankTiles& share)
    : options(options), share(share), blocks(MakeBlocks(region, options)), progress(blocks.size()) {
    for (size_t i = 0; i < blocks.size(); ++i)
        for (int t = 0; t < CountTiles(blocks[i].pixels, options.tileSize); ++t)
            progress[i].tiles += share.Has(int(i), t);
    for (size_t i = 0; i < starts.size(); ++i) {
        blocks[i].spp = progress[i].decidedSpp = starts[i].spp;
        blocks[i].noise = starts[i].noise;
        progress[i].mustEnd = starts[i].passEnd > 0;
        progress[i].hasVoted = starts[i].hasVoted;
        if (starts[i].stopped) Stop(int(i), starts[i].stoppedByVote);
    }
    for (int i = 0; i < int(blocks.size()); ++i)
        if (blocks[i].leader >= 0)
            progress[blocks[i].leader].followers.push_back(i);
        else if (!blocks[i].stopped && !IsAhead(i))
            GoOn(i, progress[i].mustEnd ? starts[size_t(i)].passEnd
                                        : PassEndAfter(blocks[i].spp, options));
    for (int i = 0; i < int(blocks.size()); ++i)
        if (blocks[i].leader >= 0) CatchUp(i);
}

// Starts the next pass of a block that nobody leads, unless it has to wait for the next round.
void Schedule::GoOn(int block, int target) {
    if (blocks[block].spp < options.roundEnd) StartPass(block, std::min(target, options.roundEnd));
}

int Schedule::LeastSpp() const {
    int least = kNoRoundEnd;
    for (const Block& block : blocks)
        if (!block.stopped) least = std::min(least, block.spp);
    return Done() ? 0 : least;
}

bool Schedule::NoPassUnderWay() const {
    return std::ranges::none_of(progress, &Progress::underWay);
}

void Schedule::BeginRound(int end) {
    options.roundEnd = end;
    for (int i = 0; i < int(blocks.size()); ++i)
        if (blocks[i].leader < 0 && !blocks[i].stopped && !progress[i].underWay)
            GoOn(i, PassEndAfter(blocks[i].spp, options));
}

void Schedule::StartPass(int block, int target) {
    Progress& pass = progress[block];
    pass.target = target;
    pass.tilesGiven = pass.tilesFinished = pass.next = 0;
    pass.underWay = true;
    pass.mustEnd |= blocks[block].spp == 0;
    if ((timeCalled && !pass.mustEnd) || pass.tiles == 0) return;
    MakeReady(block);
    readyTiles += pass.tiles;
}

std::tuple<double, int, int> Schedule::ByNoise(int block) const {
    return {-blocks[block].noise, blocks[block].spp, block};
}

void Schedule::MakeReady(int block) {
    ready.insert({blocks[block].spp, block});
    if (options.worstFirst) readyByNoise.insert(ByNoise(block));
}

void Schedule::MakeUnready(int block) {
    ready.erase({blocks[block].spp, block});
    readyByNoise.erase(ByNoise(block));
    if (current == block) current = -1;
}

int Schedule::NextBlock() const {
    const auto [fewest, first] = *ready.begin();
    if (!options.worstFirst) return first;
    if (current >= 0) return current;
    const auto [noise, spp, worst] = *readyByNoise.begin();
    return int64_t(fewest) * kLargestLead < spp ? first : worst;
}

bool Schedule::MustGoOn() const {
    for (int i = 0; i < int(blocks.size()); ++i)
        if (!blocks[i].stopped && (blocks[i].spp == 0 || progress[i].mustEnd)) return true;
    return false;
}

void Schedule::CallTime() {
    if (timeCalled) return;
    timeCalled = true;
    for (int i = 0; i < int(blocks.size()); ++i) {
        if (progress[i].mustEnd || !ready.contains({blocks[i].spp, i})) continue;
        readyTiles -= progress[i].tiles - progress[i].tilesGiven;
        MakeUnready(i);
    }
}

std::optional<Tile> Schedule::Next() {
    if (ready.empty()) return {};
    const int i = NextBlock();
    if (options.worstFirst) current = i;
    const Block& block = blocks[i];
    Progress& pass = progress[i];

    const PixelRect pixels = TakeTile(i);
    --readyTiles;
    if (pass.tilesGiven == pass.tiles) MakeUnready(i);
    return Tile{i, pixels, block.spp, pass.target - block.spp};
}

PixelRect Schedule::TakeTile(int block) {
    Progress& pass = progress[block];
    while (!share.Has(block, pass.next)) ++pass.next;
    ++pass.tilesGiven;
    return TileAt(blocks[block].pixels, options.tileSize, pass.next++);
}

bool Schedule::Finish(const Tile& tile) {
    Progress& pass = progress[tile.block];
    if (++pass.tilesFinished < pass.tiles) return false;
    blocks[tile.block].spp = pass.target;
    return true;
}

void Schedule::Decide(int i, bool stop, double noise) {
    Block& block = blocks[i];
    block.noise = noise;
    progress[i].underWay = progress[i].mustEnd = false;
    block.spp = progress[i].decidedSpp = progress[i].target;
    if (block.leader >= 0) return CatchUp(i);

    stop &= block.votes;
    progress[i].hasVoted |= stop;
    if (block.partner >= 0)
        DecidePair(i);
    else if (stop || block.spp >= options.cap)
        Stop(i, stop);
    else
        GoOn(i, PassEndAfter(block.spp, options));
    for (const int follower : progress[i].followers) CatchUp(follower);
}

bool Schedule::IsAhead(int block) const {
    const int partner = blocks[block].partner;
    return partner >= 0 && blocks[partner].spp < blocks[block].spp;
}

// Once both blocks of a pair have come to the end of a pass: stops them if both have voted for it,
// now or before, or at the cap, and else begins the next of both.
void Schedule::DecidePair(int block) {
    const int partner = blocks[block].partner;
    if (progress[partner].underWay || blocks[partner].spp != blocks[block].spp) return;
    const bool stop = progress[block].hasVoted && progress[partner].hasVoted;
    for (const int i : {std::min(block, partner), std::max(block, partner)}) {
        if (stop || blocks[i].spp >= options.cap)
            Stop(i, stop);
        else
            GoOn(i, PassEndAfter(blocks[i].spp, options));
        if (i == partner)
            for (const int follower : progress[i].followers) CatchUp(follower);
    }
}

void Schedule::CatchUp(int follower) {
    const Block& block = blocks[follower];
    const Block& leader = blocks[block.leader];
    if (progress[follower].underWay || block.stopped) return;
    const int leaderSpp = progress[block.leader].decidedSpp;
    if (block.spp < leaderSpp)
        StartPass(follower, std::min(PassEndAfter(block.spp, options), leaderSpp));
    else if (leader.stopped)
        Stop(follower, leader.stoppedByVote);
}

void Schedule::Stop(int block, bool byVote) {
    blocks[block].stopped = true;
    blocks[block].stoppedByVote = byVote;
    ++stoppedBlocks;
    blocksAtCap += !byVote;
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
