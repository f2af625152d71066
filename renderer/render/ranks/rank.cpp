#include "renderer/render/ranks/rank.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

Rank::Rank(const RenderOptions& options, tbb::task_arena* arena, RankHooks hooks)
    : executor(options, StartsOf(options),
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

namespace {

// Pause between looks for messages: an eighth of the time for which none has come, which bounds the
// delay, within limits that cost nothing.
constexpr std::chrono::microseconds kShortestNap{50}, kLongestNap{10000};

constexpr std::chrono::milliseconds kPatience{500};  // with ranks, to answer a Ping

}  // namespace

void RankChannel::Post(int to, std::vector<std::byte> message) {
    {
        std::lock_guard lock(mutex);
        outbox.emplace_back(to, std::move(message));
    }
    changed.notify_one();
}

void RankChannel::PostToAll(const std::vector<std::byte>& message) {
    for (int to = 0; to < Count(); ++to)
        if (to != Rank()) Post(to, message);
}

void RankChannel::Fail(std::exception_ptr exception) {
    std::lock_guard lock(mutex);
    if (!failure) failure = exception;
}

void RankChannel::AskForLife(const std::vector<int>& ranks) {
    silent.insert(ranks.begin(), ranks.end());
    silentSince = Clock::now();
    for (const int rank : ranks) Post(rank, Pack(RankWord::Ping));
}

void RankChannel::CheckLife() {
    if (silent.empty() || Clock::now() < silentSince + kPatience) return;
    if (onSilence) onSilence({silent.begin(), silent.end()});
    silent.clear();
}

std::vector<int> RankChannel::FindSilent(double quiet, double patience) {
    const auto now = Clock::now();
    const auto unseen = now - std::exchange(lastLook, now);
    const bool wasAway = unseen > std::chrono::duration<double>(quiet);
    std::vector<int> found;
    for (int rank = 0; rank < Count(); ++rank) {
        Life& life = lives[size_t(rank)];
        if (rank == Rank() || life.givenUp) continue;
        if (!life.asked && now - life.heard > std::chrono::duration<double>(quiet)) {
            life.asked = now;
            Post(rank, Pack(RankWord::Ping));
        }
        if (wasAway && life.asked) *life.asked += unseen;
        if (life.asked && now - *life.asked > std::chrono::duration<double>(patience))
            found.push_back(rank);
    }
    return found;
}

void RankChannel::GiveUp(int rank) {
    lives[size_t(rank)].givenUp = true;
    peers.GiveUp(rank);
}

void RankChannel::Exchange(const Handler& handle) {
    const bool hasSent = Send(), hasReceived = Receive(handle);
    CheckLife();
    if (hasSent || hasReceived)
        lastMessage = Clock::now();
    else
        Wait();
}

bool RankChannel::Send() {
    std::vector<std::pair<int, std::vector<std::byte>>> posted;
    {
        std::lock_guard lock(mutex);
        if (failure) std::rethrow_exception(failure);
        posted.swap(outbox);
    }
    for (auto& [to, message] : posted)
        if (!HasGivenUp(to)) peers.Send(to, std::move(message));
    return !posted.empty();
}

bool RankChannel::Receive(const Handler& handle) {
    bool any = false;
    while (const std::optional<PeerMessage> message = peers.Receive()) {
        Life& life = lives[size_t(message->from)];
        if (life.givenUp) continue;
        life.heard = Clock::now();
        life.asked.reset();
        StateReader reader(message->bytes, "a message of a rank");
        const RankWord word = reader.Get<RankWord>();
        if (word == RankWord::Ping)
            peers.Send(message->from, Pack(RankWord::Alive));
        else if (word == RankWord::Alive)
            silent.erase(message->from);
        else
            handle(message->from, word, reader);
        any = true;
    }
    return any;
}

void RankChannel::Wait() {
    const auto silence =
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - lastMessage);
    std::unique_lock lock(mutex);
    changed.wait_for(lock, std::clamp(silence / 8, kShortestNap, kLongestNap),
                     [&] { return !outbox.empty() || failure; });
}

namespace {

const float* PutTile(const float* from, const PixelRect& tile, const PixelRect& block, float* to) {
    for (int y = tile.min.y(); y < tile.max.y(); ++y, from += 3 * tile.Width())
        std::copy_n(from, 3 * tile.Width(),
                    to + 3 * (size_t(y - block.min.y()) * size_t(block.Width()) +
                              size_t(tile.min.x() - block.min.x())));
    return from;
}

}  // namespace

std::vector<std::byte> PackSplats(int plane, const SplatPlane& splats) {
    return Pack(RankWord::Splats, plane,
                [&](StateWriter* writer) { splats.Put(splats.Region(), writer); });
}

std::vector<std::byte> PackPixels(int block, const std::vector<PixelRect>& tiles,
                                  const Film& film) {
    return Pack(RankWord::Pixels, block, [&](StateWriter* writer) {
        for (const PixelRect& tile : tiles) PutPlanes(film, tile, writer);
    });
}

int GetBlock(StateReader& reader, size_t blocks) {
    const int block = reader.Get<int>();
    if (block < 0 || size_t(block) >= blocks)
        throw std::runtime_error("a message of a rank is about a block that there is not");
    return block;
}

void GetPixels(StateReader& reader, const std::vector<PixelRect>& tiles, Film* film) {
    for (const PixelRect& tile : tiles) GetPlanes(&reader, tile, film);
    reader.Finish();
}

std::vector<float> MeansOf(const std::vector<PixelRect>& tiles, ViewNeed need, const Film& film) {
    std::vector<float> values;
    if (need == ViewNeed::Nothing || need == ViewNeed::Measured) return values;
    const bool withHalf = need == ViewNeed::MeanAndHalf;
    std::vector<float> halves;
    FilmView view;
    for (const PixelRect& tile : tiles) {
        film.Extract(tile, withHalf, &view);
        values.insert(values.end(), view.mean.begin(), view.mean.end());
        halves.insert(halves.end(), view.halfMean.begin(), view.halfMean.end());
    }
    values.insert(values.end(), halves.begin(), halves.end());
    return values;
}

void PutMeans(const std::vector<float>& values, const std::vector<PixelRect>& tiles,
              const PixelRect& block, FilmView* view) {
    size_t size = 0;
    for (const PixelRect& tile : tiles) size += 3 * size_t(tile.Area());
    if (values.size() != size * (view->halfMean.empty() ? 1 : 2))
        throw std::runtime_error("a rank has sent another part of a block than was asked for");
    const float* from = values.data();
    for (std::vector<float>* to : {&view->mean, &view->halfMean})
        for (const PixelRect& tile : tiles)
            if (!to->empty()) from = PutTile(from, tile, block, to->data());
}

}  // namespace lull
