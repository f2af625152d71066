#include <algorithm>

#include "renderer/render/rank_deal.h"
#include "renderer/render/rank_executor_internal.h"

namespace lull {

namespace {

// How long nobody looks for messages: an eighth of the time for which none has come, so that none
// is late by more than that, within what costs nothing.
constexpr std::chrono::microseconds shortest{50}, longest{10000};

bool ComesBefore(const PixelRect& a, const PixelRect& b) {
    return std::pair(a.min.y(), a.min.x()) < std::pair(b.min.y(), b.min.x());
}

}  // namespace

RankExecutor::RankExecutor(const SampleSource& source, const RenderOptions& options, Film* film,
                           const RenderState* interrupted, std::span<const BlockStart> starts,
                           tbb::task_arena* arena)
    : Executor(source, options, film, interrupted, starts,
               {options.peers->Rank(), EvenDeal(options.peers->Count())}),
      peers(*options.peers),
      ranks(options.peers->Count()),
      arena(arena) {}

std::vector<PixelRect> RankExecutor::TilesOfRank(int block, int rank) const {
    return TilesOf(schedule.Blocks()[size_t(block)].pixels, block, options.schedule.tileSize,
                   {rank, share.deal});
}

std::vector<PixelRect> RankExecutor::NewTilesOfRank(int block, int rank,
                                                    const std::vector<int>& before) const {
    std::vector<PixelRect> tiles = TilesOfRank(block, rank);
    if (before.empty()) return tiles;
    const std::vector<PixelRect> old = TilesOf(schedule.Blocks()[size_t(block)].pixels, block,
                                               options.schedule.tileSize, {rank, before});
    std::erase_if(tiles, [&](const PixelRect& tile) {
        return std::ranges::binary_search(old, tile, ComesBefore);
    });
    return tiles;
}

Executor::Effort RankExecutor::TakeEffort() {
    std::lock_guard lock(mutex);
    Effort taken = std::exchange(effort, {});
    taken.seconds /= arena->max_concurrency();
    return taken;
}

void RankExecutor::AskForLife(const std::vector<int>& others) {
    silent.insert(others.begin(), others.end());
    silentSince = Seconds();
    for (const int rank : others) Post(rank, Pack(RankWord::Ping));
}

void RankExecutor::CheckLife() {
    if (silent.empty() || Seconds() < silentSince + patienceWithRanks) return;
    if (options.onSilence) options.onSilence({silent.begin(), silent.end()});
    silent.clear();
}

void RankExecutor::Post(int to, std::vector<std::byte> message) {
    {
        std::lock_guard lock(outboxMutex);
        outbox.emplace_back(to, std::move(message));
    }
    changed.notify_one();
}

void RankExecutor::PostToAll(const std::vector<std::byte>& message) {
    for (int to = 0; to < ranks; ++to)
        if (to != share.rank) Post(to, message);
}

bool RankExecutor::TakeException(std::exception_ptr exception) {
    std::lock_guard lock(outboxMutex);
    if (!failure) failure = exception;
    pausing = true;
    return true;
}

void RankExecutor::Enqueue(std::function<void()> work) {
    {
        std::lock_guard lock(worksMutex);
        works.push_back(std::move(work));
    }
    workTask.order.Leave();
    arena->enqueue(group.defer(std::ref(workTask)));
}

void RankExecutor::WorkTask::operator()() {
    order.Enter();
    executor->task.order.Enter();
    std::function<void()> work;
    {
        std::lock_guard lock(executor->worksMutex);
        work = std::move(executor->works.front());
        executor->works.pop_front();
    }
    try {
        work();
    } catch (...) {
        executor->TakeException(std::current_exception());
    }
    executor->task.order.Leave();
}

void RankExecutor::EnqueueTiles() {
    Enqueue([this] {
        int count = 0;
        {
            std::lock_guard lock(mutex);
            count = schedule.ReadyTiles();
        }
        Spawn(count);
    });
}

void RankExecutor::Quiesce() {
    pausing = true;
    group.wait();
    task.order.Enter();
}

void RankExecutor::Exchange() {
    std::vector<std::pair<int, std::vector<std::byte>>> posted;
    {
        std::lock_guard lock(outboxMutex);
        if (failure) std::rethrow_exception(failure);
        posted.swap(outbox);
    }
    for (auto& [to, message] : posted) peers.Send(to, std::move(message));
    bool any = !posted.empty();
    while (const std::optional<PeerMessage> message = peers.Receive()) {
        StateReader reader(message->bytes);
        const RankWord word = reader.Get<RankWord>();
        if (word == RankWord::Ping)
            peers.Send(message->from, Pack(RankWord::Alive));
        else if (word == RankWord::Alive)
            silent.erase(message->from);
        else
            Handle(message->from, word, reader);
        any = true;
    }
    CheckLife();
    if (any)
        lastMessage = Clock::now();
    else
        Wait();
}

void RankExecutor::Wait() {
    const auto silence =
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - lastMessage);
    std::unique_lock lock(outboxMutex);
    changed.wait_for(lock, std::clamp(silence / 8, shortest, longest),
                     [&] { return !outbox.empty() || failure; });
}

}  // namespace lull
