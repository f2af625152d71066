#include "renderer/render/render.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <stdexcept>

#include "renderer/render/executor_internal.h"
#include "renderer/render/light_rounds.h"
#include "renderer/render/ranks/rank.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

// This thread speaks with the other ranks, so the arena has none of its places for it.
RenderResult RenderWithPeers(const RenderContext& context, const RenderOptions& options,
                             int threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads) + 1);
    tbb::task_arena arena(threads, 0);
    RenderResult result = options.peers->Rank() == 0 ? LeadRanks(context, options, &arena)
                                                     : FollowRanks(context, options, &arena);
    result.threads = threads * options.peers->Count();
    return result;
}

}  // namespace

RenderResult Render(const RenderContext& context, const RenderOptions& options) {
    const PixelRect& region = context.film->Region();
    if (context.interrupted && !HasBlocksOf(*context.interrupted, region, options.schedule))
        throw std::invalid_argument("the interrupted render has other blocks");
    const int threads = ThreadCount(options.threads);
    const bool alone = !options.peers || options.peers->Count() == 1;
    if (!alone && options.display) throw std::invalid_argument("several ranks have no viewer");
    if (!alone) return RenderWithPeers(context, options, threads);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    RenderResult result =
        arena.execute([&] { return Executor(context, options, StartsOf(context, options)).Run(); });
    result.threads = threads;
    return result;
}

SampleSource SamplesOf(const Scene& scene, const PathOptions& options, const LightRounds* rounds) {
    return [&scene, options, rounds](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                     PathSample* sample) {
        PathOptions paths = options;
        if (rounds) paths.shares = rounds->Round().shares;
        RenderSample(scene, paths, sampler, pixel, index, sample);
    };
}

}  // namespace lull
