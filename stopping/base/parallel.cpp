#include "stopping/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace lull {

namespace {

// The order, so that the first thing that a task reads is this.
struct OrderedBody {
    const std::function<void(int)>& body;
    TaskOrder order = {};

    void operator()(int i) {
        order.Enter();
        body(i);
        order.Leave();
    }
};

}  // namespace

void ForEachIndex(int count, const std::function<void(int)>& body) {
    if (count == 1) return body(0);
    OrderedBody ordered{body};
    ordered.order.Leave();
    tbb::parallel_for(0, count, std::ref(ordered), tbb::simple_partitioner());
    ordered.order.Enter();
}

int ThreadCount(int threads) {
    const int cores = tbb::info::default_concurrency();
    return threads <= 0 ? cores : std::min(threads, std::max(256, 4 * cores));
}

void RunWithThreads(int threads, const std::function<void()>& body) {
    threads = ThreadCount(threads);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    arena.execute(body);
}

}  // namespace lull
