// Runs the tasks of a render: identical tasks for tiles, and single works such as decisions on
// blocks.
#pragma once

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>

#include "stopping/base/parallel.h"

namespace lull {

// The thread sanitizer sees the order that a mutex gives, but not the order of tasks within oneTBB:
// hence the first thing that a task reads is a TaskOrder.
class TaskSet {
  public:
    // Exceptions of tasks go to `take`, or where that is empty to Wait().
    TaskSet(std::function<void()> doTile, std::function<void(std::exception_ptr)> take)
        : doTile(std::move(doTile)), take(std::move(take)) {}

    // Spawns tasks of tiles, from within the arena.
    void Spawn(int count) {
        open += count;
        tileTask.order.Leave();
        for (int i = 0; i < count; ++i) group.run(std::ref(tileTask));
    }
    // Has `work` done in the arena, from another thread.
    void Enqueue(tbb::task_arena* arena, std::function<void()> work) {
        {
            std::lock_guard lock(worksMutex);
            works.push_back(std::move(work));
        }
        ++open;
        workTask.order.Leave();
        arena->enqueue(group.defer(std::ref(workTask)));
    }
    // Waits until there is no task any more.
    void Wait() {
        group.wait();
        tileTask.order.Enter();
    }
    // Returns whether there is none now.
    bool IsIdle() const { return open == 0; }

  private:
    // The work of all tasks of tiles.
    struct TileTask {
        TaskSet* set;
        TaskOrder order = {};
        void operator()() {
            order.Enter();
            set->Guarded(set->doTile);
            order.Leave();
        }
    };
    // Does the oldest of `works`.
    struct WorkTask {
        TaskSet* set;
        TaskOrder order = {};
        void operator()() {
            order.Enter();
            set->tileTask.order.Enter();
            std::function<void()> work;
            {
                std::lock_guard lock(set->worksMutex);
                work = std::move(set->works.front());
                set->works.pop_front();
            }
            set->Guarded(work);
            set->tileTask.order.Leave();
        }
    };

    void Guarded(const std::function<void()>& work) {
        struct Leaving {
            std::atomic<int>& open;
            ~Leaving() { --open; }
        } leaving{open};
        try {
            work();
        } catch (...) {
            if (!take) throw;
            take(std::current_exception());
        }
    }

    const std::function<void()> doTile;
    const std::function<void(std::exception_ptr)> take;
    TileTask tileTask{this};
    WorkTask workTask{this};
    std::atomic<int> open = 0;  // tasks that have not come to their end
    std::mutex worksMutex;      // guards `works`
    std::deque<std::function<void()>> works;
    tbb::task_group group;
};

}  // namespace lull
