#include "renderer/render/rank_executor_internal.h"

namespace lull {

namespace {

// How long nobody looks for messages: short at first, then so long that it costs nothing.
constexpr std::chrono::microseconds shortest{50}, longest{1000};

}  // namespace

RankExecutor::RankExecutor(const SampleSource& source, const RenderOptions& options, Film* film,
                           const RenderState* interrupted, std::span<const BlockStart> starts,
                           tbb::task_arena* arena)
    : Executor(source, options, film, interrupted, starts,
               {options.peers->Rank(), options.peers->Count()}),
      peers(*options.peers),
      arena(arena) {}

std::vector<PixelRect> RankExecutor::TilesOfRank(int block, int rank) const {
    return TilesOf(schedule.Blocks()[size_t(block)].pixels, block, options.schedule.tileSize,
                   {rank, share.ranks});
}

void RankExecutor::Post(int to, std::vector<std::byte> message) {
    {
        std::lock_guard lock(outboxMutex);
        outbox.emplace_back(to, std::move(message));
    }
    changed.notify_one();
}

void RankExecutor::PostToAll(const std::vector<std::byte>& message) {
    for (int to = 0; to < share.ranks; ++to)
        if (to != share.rank) Post(to, message);
}

bool RankExecutor::TakeException(std::exception_ptr exception) {
    std::lock_guard lock(outboxMutex);
    if (!failure) failure = exception;
    pausing = true;
    return true;
}

void RankExecutor::Enqueue(std::function<void()> work) {
    task.order.Leave();
    arena->enqueue(group.defer([this, work = std::move(work)] {
        task.order.Enter();
        try {
            work();
        } catch (...) {
            TakeException(std::current_exception());
        }
        task.order.Leave();
    }));
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
        Handle(message->from, word, reader);
        any = true;
    }
    if (any)
        patience = shortest;
    else
        Wait();
}

void RankExecutor::Wait() {
    std::unique_lock lock(outboxMutex);
    changed.wait_for(lock, patience, [&] { return !outbox.empty() || failure; });
    patience = std::clamp(2 * patience, shortest, longest);
}

}  // namespace lull
