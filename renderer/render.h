// Renders blocks pass by pass, each until its own stopping criterion says that it is done.
#pragma once

#include <functional>

#include "renderer/schedule.h"
#include "renderer/transport/path_tracer.h"

namespace lull {

struct RenderProgress {
    int blocks = 0, stoppedBlocks = 0;
    int medianSpp = 0;         // over the blocks
    int64_t samples = 0;       // taken so far
    int64_t samplesToCap = 0;  // still to take if no block stops before the cap
    double seconds = 0;        // since the start
};

struct RenderOptions {
    ScheduleOptions schedule;
    SamplerKind sampler = SamplerKind::Sobol;
    uint64_t seed = 0;
    int threads = 0;  // 0: all

    // Says whether `block` stops at `spp`; called after each pass of a block that votes, by one
    // thread at a time for the same block, by several for different blocks. Empty: never.
    std::function<bool(int block, int spp, const FilmView&)> shouldStop;
    // Is told how far things are, by one thread at a time, about every `progressInterval` seconds
    // and at the end. Can be empty.
    std::function<void(const RenderProgress&)> onProgress;
    double progressInterval = 0.25;
    // Is asked before every tile; true ends the render after the tiles under way. Can be empty.
    std::function<bool()> isCancelled;
};

struct BlockResult {
    Block block;
    double seconds = 0;           // of threads spent on its samples
    double criterionSeconds = 0;  // spent on its criterion, the view of the pixels included
};

struct RenderResult {
    std::vector<BlockResult> blocks;
    RenderProgress progress;  // at the end
    bool cancelled = false;   // before every block had stopped
};

// Takes sample `index` of a pixel; must depend on nothing but the sampler's seed, pixel and index.
using SampleSource = std::function<PathSample(Sampler&, const Vec2i& pixel, uint32_t index)>;

// Renders the film's region, which must be without samples. The pixels are the same bits for any
// number of threads and, at equal samples per pixel, for any size of blocks and length of passes.
// Passes on what the callbacks throw.
RenderResult Render(const SampleSource&, const RenderOptions&, Film*);

// Returns the scene as a source of samples; it must outlive the source.
SampleSource SamplesOf(const Scene&, Estimator);

}  // namespace lull
