#include "renderer/render/task_set_internal.h"

#include <exception>

namespace lull {

template <typename Work>
void TaskSet::Guarded(const Work& work) {
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

void TaskSet::Spawn(int count) {
    open += count;
    tileTask.order.Leave();
    for (int i = 0; i < count; ++i) group.run(std::ref(tileTask));
}

void TaskSet::Enqueue(tbb::task_arena* arena, std::function<void()> work) {
    {
        std::lock_guard lock(worksMutex);
        works.push_back(std::move(work));
    }
    ++open;
    workTask.order.Leave();
    arena->enqueue(group.defer(std::ref(workTask)));
}

void TaskSet::Wait() {
    group.wait();
    tileTask.order.Enter();
}

void TaskSet::TileTask::operator()() {
    order.Enter();
    set->Guarded(set->doTile);
    order.Leave();
}

void TaskSet::WorkTask::operator()() {
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

}  // namespace lull
