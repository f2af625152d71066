#include "renderer/render/ranks/rank.h"

#include <algorithm>
#include <numeric>

namespace lull {

namespace {

constexpr int kDealsARank = 16;  // entries of a sequence for each rank: how finely speeds are told
constexpr double kSlowest = 1.0 / 64;  // of the fastest; who is slower is still asked now and then

}  // namespace

std::vector<int> EvenDeal(int ranks) {
    std::vector<int> deal(static_cast<size_t>(ranks));
    std::iota(deal.begin(), deal.end(), 0);
    return deal;
}

std::vector<int> DealBySpeed(const std::vector<double>& speeds) {
    const size_t ranks = speeds.size();
    const double fastest = *std::ranges::max_element(speeds);
    std::vector<double> shares;
    for (const double speed : speeds) shares.push_back(std::max(speed, kSlowest * fastest));
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    const int length = kDealsARank * int(ranks);

    // Each entry is for the rank that lags furthest behind its share.
    std::vector<int> deal, given(ranks, 0);
    for (int i = 0; i < length; ++i) {
        size_t next = 0;
        const auto lag = [&](size_t r) { return shares[r] / all * (i + 1) - given[r]; };
        for (size_t r = 1; r < ranks; ++r)
            if (lag(r) > lag(next)) next = r;
        ++given[next];
        deal.push_back(int(next));
    }
    for (size_t r = 0; r < ranks; ++r)
        if (given[r] == 0) deal.push_back(int(r));
    return deal;
}

void RankSpeeds::Add(int rank, int64_t samples, double seconds) {
    efforts[size_t(rank)].samples += samples;
    efforts[size_t(rank)].seconds += seconds;
}

void RankSpeeds::Forget() { std::ranges::fill(efforts, Effort()); }

std::vector<double> RankSpeeds::Speeds(double leastSeconds) const {
    std::vector<double> speeds;
    double most = 0;
    for (const Effort& e : efforts) {
        if (e.samples == 0) return {};
        most = std::max(most, e.seconds);
        speeds.push_back(double(e.samples) / std::max(e.seconds, 1e-9));
    }
    return most < leastSeconds ? std::vector<double>() : speeds;
}

double GainOfDealing(const std::vector<double>& speeds, const std::vector<int>& deal) {
    const double all = std::accumulate(speeds.begin(), speeds.end(), 0.0);
    double slowestPace = 1;
    for (size_t r = 0; r < speeds.size(); ++r) {
        const double share = double(std::ranges::count(deal, int(r))) / double(deal.size());
        slowestPace = std::max(slowestPace, share * all / speeds[r]);
    }
    return slowestPace;
}

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
