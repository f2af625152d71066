#include <algorithm>

#include "renderer/render/ranks/deal.h"
#include "renderer/render/ranks/rank.h"

namespace lull {

namespace {

bool ComesBefore(const PixelRect& a, const PixelRect& b) {
    return std::pair(a.min.y(), a.min.x()) < std::pair(b.min.y(), b.min.x());
}

// Passes exceptions of tasks to the channel, which throws them where messages are exchanged.
RankHooks WithFailures(RankHooks hooks, Rank* rank) {
    hooks.onException = [rank](std::exception_ptr exception) {
        rank->channel.Fail(exception);
        rank->executor.pausing = true;
    };
    return hooks;
}

}  // namespace

Rank::Rank(const RenderContext& context, const RenderOptions& options, tbb::task_arena* arena,
           RankHooks hooks)
    : executor(context, options, StartsOf(context, options),
               {options.peers->Rank(), EvenDeal(options.peers->Count())},
               WithFailures(std::move(hooks), this)),
      channel(options.peers, options.events.onSilence),
      tileSize(options.schedule.tileSize),
      arena(arena) {}

TileEffort Rank::TakeEffort() {
    TileEffort taken = executor.ledger.TakeEffort();
    taken.seconds /= arena->max_concurrency();
    return taken;
}

std::vector<PixelRect> Rank::NewTiles(int block, int rank, const std::vector<int>& before) const {
    std::vector<PixelRect> tiles = executor.schedule.TilesOfRank(block, rank);
    if (before.empty()) return tiles;
    const std::vector<PixelRect> old =
        TilesOf(executor.schedule.BlockAt(block).pixels, block, tileSize, {rank, before});
    std::erase_if(tiles, [&](const PixelRect& tile) {
        return std::ranges::binary_search(old, tile, ComesBefore);
    });
    return tiles;
}

}  // namespace lull
