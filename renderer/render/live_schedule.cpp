#include "renderer/render/executor_internal.h"

#include <utility>

#include "renderer/render/light_rounds.h"

namespace lull {

namespace {

ScheduleOptions ScheduleFor(const RenderOptions& options) {
    ScheduleOptions schedule = options.schedule;
    schedule.worstFirst = bool(options.secondsLeft);
    schedule.roundEnd = LightRoundEnd(options);
    return schedule;
}

}  // namespace

int LightRoundEnd(const RenderOptions& options) {
    return options.lightRounds ? options.lightRounds->End() : kNoRoundEnd;
}

LiveSchedule::LiveSchedule(const RenderOptions& options, std::span<const BlockStart> starts,
                           RankTiles given)
    : options(options),
      share(std::move(given)),
      hasClock(options.secondsLeft),
      schedule(options.film->Region(), ScheduleFor(options), starts, share) {
    ShowStops();
}

void LiveSchedule::Restart(std::span<const BlockStart> starts, RankTiles given) {
    std::lock_guard lock(mutex);
    share = std::move(given);
    schedule = Schedule(options.film->Region(), ScheduleFor(options), starts, share);
    if (timeCalled) schedule.CallTime();
    undo.clear();
}

// Of several ranks, the first has the clock, and looks at it by itself.
std::optional<Tile> LiveSchedule::Next() {
    if (hasClock && !options.peers && !(options.secondsLeft() > 0)) CallTime();
    std::lock_guard lock(mutex);
    const std::optional<Tile> tile = schedule.Next();
    if (tile && hasClock && !undo.contains(tile->block)) Keep(tile->block);
    return tile;
}

bool LiveSchedule::Finish(const Tile& tile) {
    std::lock_guard lock(mutex);
    return schedule.Finish(tile);
}

int LiveSchedule::Decide(int block, const BlockAnswer& answer) {
    std::lock_guard lock(mutex);
    const int readyBefore = schedule.ReadyTiles();
    schedule.Decide(block, answer.stop, answer.noise);
    ShowStops();
    undo.erase(block);
    return schedule.ReadyTiles() - readyBefore;
}

int LiveSchedule::ReadyTiles() {
    std::lock_guard lock(mutex);
    return schedule.ReadyTiles();
}

void LiveSchedule::CallTime() {
    std::lock_guard lock(mutex);
    schedule.CallTime();
    timeCalled = true;
}

bool LiveSchedule::IsOver() {
    std::lock_guard lock(mutex);
    return schedule.Done() || (timeCalled && !schedule.MustGoOn());
}

bool LiveSchedule::IsRoundOver() {
    std::lock_guard lock(mutex);
    return schedule.IsRoundOver();
}

void LiveSchedule::BeginRound(int end) {
    std::lock_guard lock(mutex);
    schedule.BeginRound(end);
}

void LiveSchedule::Keep(int block) {
    const std::vector<PixelRect> tiles = TilesOfRank(block, share.rank);
    StateWriter writer;
    for (const PixelRect& tile : tiles) PutPlanes(*options.film, tile, &writer);
    undo[block] = {tiles, std::move(writer.bytes)};
}

std::vector<int> LiveSchedule::Undo() {
    std::vector<int> blocks;
    for (const auto& [block, before] : undo) {
        StateReader reader(before.planes);
        for (const PixelRect& tile : before.tiles) GetPlanes(&reader, tile, options.film);
        blocks.push_back(block);
    }
    undo.clear();
    return blocks;
}

std::vector<PixelRect> LiveSchedule::TilesOfRank(int block, int rank) const {
    return TilesOf(BlockAt(block).pixels, block, options.schedule.tileSize, {rank, share.deal});
}

void LiveSchedule::ShowStops() {
    const std::span<const Block> blocks = schedule.Blocks();
    shownStops.resize(blocks.size());
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (!blocks[i].stopped || std::exchange(shownStops[i], true)) continue;
        if (options.display) options.display->ShowStop(blocks[i].pixels);
        if (options.events.onStop) options.events.onStop(int(i), blocks[i]);
    }
}

}  // namespace lull
