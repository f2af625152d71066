#include "renderer/render/render.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <stdexcept>

#include "renderer/render/executor_internal.h"
#include "renderer/render/guide_learning.h"
#include "renderer/render/ranks/rank.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

// This thread speaks with the other ranks, so the arena has none of its places for it.
RenderResult RenderWithPeers(const SampleSource& source, const RenderOptions& options, Film* film,
                             const RenderState* interrupted, int threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads) + 1);
    tbb::task_arena arena(threads, 0);
    RenderResult result = options.peers->Rank() == 0
                              ? LeadRanks(source, options, film, interrupted, &arena)
                              : FollowRanks(source, options, film, &arena);
    result.threads = threads * options.peers->Count();
    return result;
}

}  // namespace

RenderResult Render(const SampleSource& source, const RenderOptions& options, Film* film,
                    const RenderState* interrupted) {
    if (interrupted && !Fits(*interrupted, film->Region(), options.schedule))
        throw std::invalid_argument("the interrupted render has other blocks");
    const int threads = ThreadCount(options.threads);
    if (!options.layers.AreOf(film->Region()))
        throw std::invalid_argument("the layers are of another region");
    const bool alone = !options.peers || options.peers->Count() == 1;
    if (!alone && options.display) throw std::invalid_argument("several ranks have no viewer");
    if (!alone) return RenderWithPeers(source, options, film, interrupted, threads);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    RenderResult result = arena.execute([&] {
        return Executor(source, options, film, interrupted, StartsOf(interrupted, options, *film))
            .Run();
    });
    result.threads = threads;
    return result;
}

SampleSource SamplesOf(const Scene& scene, const PathOptions& options) {
    return [&scene, options](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                             FirstHit* firstHit) {
        return RenderSample(scene, options, sampler, pixel, index, firstHit);
    };
}

SampleSource SamplesOf(const Scene& scene, const GuideLearner& learner, bool throughSpecular) {
    return [&, throughSpecular](Sampler& sampler, const Vec2i& pixel, uint32_t index,
                                FirstHit* firstHit) {
        PathOptions options = learner.Paths();
        options.throughSpecular = throughSpecular;
        return RenderSample(scene, options, sampler, pixel, index, firstHit);
    };
}

}  // namespace lull
