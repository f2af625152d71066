// Carries out a schedule together with other ranks (peers.h).
#pragma once

#include <tbb/task_arena.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <set>

#include "renderer/render/executor_internal.h"
#include "renderer/render/peers.h"
#include "renderer/render/rank_messages_internal.h"

namespace lull {

// The calling thread speaks with the other ranks, and those of the arena do the work.
class RankExecutor : public Executor {
  public:
    // Runs `body`; what it throws leaves no task at work.
    template <typename Body>
    RenderResult Guarded(const Body& body) try {
        return body();
    } catch (...) {
        Quiesce();
        throw;
    }

  protected:
    RankExecutor(const SampleSource&, const RenderOptions&, Film*, const RenderState* interrupted,
                 std::span<const BlockStart> starts, tbb::task_arena*);

    static constexpr double patienceWithRanks = 0.5;  // seconds to answer a Ping

    // Leaves a message to be sent. From any thread.
    void Post(int to, std::vector<std::byte> message);
    void PostToAll(const std::vector<std::byte>& message);
    // Sends what was posted and handles what has arrived, or waits a little if there is neither.
    // Throws what a task has thrown.
    void Exchange();
    virtual void Handle(int from, RankWord, StateReader&) = 0;

    // Runs `work` on a thread of the arena; what it throws, Exchange() throws.
    void Enqueue(std::function<void()> work);
    void EnqueueTiles();
    // Lets no more tiles begin, and waits for those under way.
    void Quiesce();

    std::vector<PixelRect> TilesOfRank(int block, int rank) const;
    // Returns those that another deal did not give it; all where that is empty.
    std::vector<PixelRect> NewTilesOfRank(int block, int rank,
                                          const std::vector<int>& before) const;
    // Returns what the tiles here took since the last call, in samples and seconds a thread.
    Effort TakeEffort();
    // Asks whether the ranks are there, and tells options.onSilence of those that are not.
    void AskForLife(const std::vector<int>& ranks);
    void CheckLife();
    bool TakeException(std::exception_ptr) override;

    Peers& peers;
    const int ranks;
    tbb::task_arena* arena;

  private:
    void Wait();

    // Does the oldest of `works`. The thread sanitizer sees the order that a mutex gives, but not
    // that of what oneTBB hands over, so that the first thing it reads is `order`.
    struct WorkTask {
        RankExecutor* executor;
        TaskOrder order = {};
        void operator()();
    };
    WorkTask workTask{this};
    std::mutex worksMutex;  // guards `works`
    std::deque<std::function<void()>> works;

    std::mutex outboxMutex;  // guards `outbox` and `failure`
    std::condition_variable changed;
    std::vector<std::pair<int, std::vector<std::byte>>> outbox;
    std::exception_ptr failure;
    Clock::time_point lastMessage = Clock::now();
    std::set<int> silent;    // have been asked, and have not answered
    double silentSince = 0;  // seconds
};

// Run a render as rank 0, which decides, and as another; the arena has no place for the caller.
// There is no display.
RenderResult LeadRanks(const SampleSource&, const RenderOptions&, Film*,
                       const RenderState* interrupted, tbb::task_arena*);
RenderResult FollowRanks(const SampleSource&, const RenderOptions&, Film*, tbb::task_arena*);

}  // namespace lull
