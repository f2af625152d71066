#include "renderer/render/render.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <stdexcept>

#include "renderer/base/thread_clock.h"
#include "renderer/render/undo.h"
#include "stopping/base/parallel.h"
#include "stopping/rules/lnoise.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Takes the samples of a tile, all of a pixel before the next: neighbouring rays find the same
// part of the scene in the caches, and the pixel's sums stay in registers. Pixels that an
// interrupted render has taken further already keep what they have. Returns how many were taken.
int64_t RenderTile(const SampleSource& source, const Tile& tile, Sampler sampler, Film* film) {
    int64_t samples = 0;
    for (int y = tile.pixels.min.y(); y < tile.pixels.max.y(); ++y)
        for (int x = tile.pixels.min.x(); x < tile.pixels.max.x(); ++x) {
            const Vec2i pixel(x, y);
            FilmPixel sums = film->At(pixel);
            const uint32_t end = uint32_t(tile.first + tile.count);
            for (uint32_t k = sums.count; k < end; ++k) {
                const PathSample sample = source(sampler, pixel, k);
                sums.Add(sample.radiance, sample.rejected);
                ++samples;
            }
            film->At(pixel) = sums;
        }
    return samples;
}

constexpr int smallestNoiseSide = 10;  // pixels, of blocks that VisibleNoise() takes

bool HasSamplesBeyond(int spp, const PixelRect& rect, const Film& film) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x)
            if (film.At({x, y}).count > uint32_t(spp)) return true;
    return false;
}

// Returns the visible noise of a block, of any size, both of whose means are in the view.
double NoiseOf(const BlockView& view) {
    if (std::min(view.width, view.height) >= smallestNoiseSide) return VisibleNoise(view);
    const LightnessNoise noise = ComputeLightnessNoise(view);
    return SubBlockStatistics(noise, view.width, view.height, 1).maskedNoise[0];
}

// Says where blocks are that an interrupted render has left; with a clock, also how noisy.
std::vector<BlockStart> StartsOf(const RenderState* interrupted, bool hasClock, const Film& film) {
    std::vector<BlockStart> starts;
    if (!interrupted) return starts;
    for (const BlockResult& b : interrupted->blocks) {
        const auto& [rect, spp] = std::pair(b.block.pixels, b.block.spp);
        BlockStart start{
            .spp = spp, .stopped = b.block.stopped, .stoppedByVote = b.block.stoppedByVote};
        if (hasClock && spp > 0) {
            FilmView view;
            film.Extract(rect, true, &view);
            start.noise = NoiseOf({view.width, view.height, spp, view.mean, view.halfMean});
            start.begun = HasSamplesBeyond(spp, rect, film);
        }
        starts.push_back(start);
    }
    return starts;
}

// Carries out a schedule: one task for each tile that is ready, each of which takes whatever tile
// is due when it starts. The last tile of a pass asks the criterion and spawns the block's next
// pass, so no block ever waits for another, and a single block still fills every core.
class Executor {
  public:
    Executor(const SampleSource& source, const RenderOptions& options, Film* film,
             const RenderState* interrupted)
        : source(source),
          options(options),
          film(film),
          secondsBefore(interrupted ? interrupted->seconds : 0),
          hasClock(options.secondsLeft),
          schedule(film->Region(), ScheduleFor(options), StartsOf(interrupted, hasClock, *film)),
          results(interrupted ? interrupted->blocks
                              : std::vector<BlockResult>(schedule.Blocks().size())),
          criteria(MakeCriteria(interrupted)),
          samples(film->SampleCount()) {}

    // Says whether the state has the blocks that the schedule will make of the film.
    static bool Fits(const RenderState& state, const PixelRect& region,
                     const ScheduleOptions& options) {
        const size_t count = MakeBlocks(region, options).size();
        return state.blocks.size() == count && state.criteria.size() == count;
    }

    RenderResult Run() {
        do {
            pausing = false;
            nextCheckpoint = Seconds() + options.checkpointInterval;
            Spawn(schedule.ReadyTiles());
            group.wait();
            task.order.Enter();
            if (timeCalled && !pausing && !IsCancelled()) Undo();
            if (options.onCheckpoint && (!schedule.Done() || options.checkpointAtEnd))
                options.onCheckpoint(State());
        } while (pausing && !IsCancelled());

        NoteBlocks();
        RenderResult result;
        result.progress = CurrentProgress();
        if (options.onProgress) options.onProgress(result.progress);
        result.timeUp = timeCalled && !schedule.Done() && !IsCancelled();
        result.cancelled = !schedule.Done() && !result.timeUp;
        result.blocks = std::move(results);
        return result;
    }

  private:
    // Is what all tasks do, and holds their order, so that the first thing they read is this.
    struct Task {
        Executor* executor;
        TaskOrder order = {};

        void operator()() {
            order.Enter();
            executor->RunTile();
            order.Leave();
        }
    };

    void Spawn(int count) {
        task.order.Leave();
        for (int i = 0; i < count; ++i) group.run(std::ref(task));
    }

    void RunTile() {
        if (pausing || IsCancelled()) return;
        const std::optional<Tile> tile = TakeTile();
        if (tile) RunTile(*tile);
    }

    void RunTile(const Tile& tile) {
        const double tileStart = ThreadSeconds();
        const int64_t taken =
            RenderTile(source, tile, Sampler(options.sampler, options.seed), film);
        if (FinishTile(tile, taken, ThreadSeconds() - tileStart)) Spawn(DecideBlock(tile.block));
        ReportProgress();
        if (options.onCheckpoint && Seconds() >= nextCheckpoint) pausing = true;
    }

    static ScheduleOptions ScheduleFor(const RenderOptions& options) {
        ScheduleOptions schedule = options.schedule;
        schedule.worstFirst = bool(options.secondsLeft);
        return schedule;
    }

    bool IsCancelled() const { return options.isCancelled && options.isCancelled(); }

    double Seconds() const { return secondsBefore + SecondsSince(start); }

    void NoteBlocks() {
        const std::span<const Block> blocks = schedule.Blocks();
        for (size_t i = 0; i < blocks.size(); ++i) results[i].block = blocks[i];
    }

    RenderState State() {
        NoteBlocks();
        RenderState state{results, {}, Seconds()};
        for (const std::unique_ptr<Criterion>& criterion : criteria)
            state.criteria.push_back(criterion ? criterion->Save() : std::vector<std::byte>());
        return state;
    }

    // There are never more tasks than tiles, but when time has been called.
    std::optional<Tile> TakeTile() {
        const bool isTimeUp = hasClock && !(options.secondsLeft() > 0);
        std::lock_guard lock(mutex);
        if (isTimeUp) {
            schedule.CallTime();
            timeCalled = true;
        }
        const std::optional<Tile> tile = schedule.Next();
        if (tile && hasClock) undo.Keep(tile->block, schedule.Blocks()[tile->block].pixels, *film);
        return tile;
    }

    // Forgets the samples of passes that the time did not suffice for.
    void Undo() {
        undo.UndoAll(film);
        samples = film->SampleCount();
    }

    // Returns true if the tile was the last of its pass.
    bool FinishTile(const Tile& tile, int64_t taken, double seconds) {
        std::lock_guard lock(mutex);
        results[tile.block].seconds += seconds;
        samples += taken;
        return schedule.Finish(tile);
    }

    // Asks the criterion and returns how many tiles have become ready.
    int DecideBlock(int i) {
        Judgement judgement;
        // Isolation keeps a criterion that waits for tasks of its own from running a tile here,
        // which would fill the same view.
        tbb::this_task_arena::isolate([&] { judgement = Judge(i); });
        std::lock_guard lock(mutex);
        const int readyBefore = schedule.ReadyTiles();
        schedule.Decide(i, judgement.stop, judgement.noise);
        if (hasClock) undo.Forget(i);
        return schedule.ReadyTiles() - readyBefore;
    }

    std::vector<std::unique_ptr<Criterion>> MakeCriteria(const RenderState* interrupted) const {
        const std::span<const Block> blocks = schedule.Blocks();
        std::vector<std::unique_ptr<Criterion>> made(blocks.size());
        if (!options.makeCriterion) return made;
        const double imageArea = double(film->Region().Area());
        for (size_t i = 0; i < blocks.size(); ++i) {
            if (!blocks[i].votes) continue;
            made[i] = options.makeCriterion(
                {.index = int(i), .areaFraction = double(blocks[i].pixels.Area()) / imageArea});
            if (interrupted && blocks[i].spp > 0) made[i]->Restore(interrupted->criteria[i]);
        }
        return made;
    }

    struct Judgement {
        bool stop = false;
        double noise = unknownNoise;
    };

    // Nobody else touches a block between the end of its pass and the decision.
    Judgement Judge(int i) {
        if (!criteria[i] && !hasClock) return {};
        const double start = ThreadSeconds();
        const Block& block = schedule.Blocks()[i];
        const BlockView view = ViewOf(i);
        const Decision decision = criteria[i] ? criteria[i]->Observe(view) : Decision();
        if (decision.judged) results[i].decisions.push_back({block.spp, decision});
        Judgement judgement{.stop = decision.stop};
        if (hasClock)
            judgement.noise = decision.visibleNoise ? *decision.visibleNoise : NoiseOf(view);
        results[i].criterionSeconds += ThreadSeconds() - start;
        return judgement;
    }

    // Returns what the criterion and the clock need to see of a block.
    BlockView ViewOf(int i) {
        const Block& block = schedule.Blocks()[i];
        BlockView blockView;
        blockView.width = block.pixels.Width();
        blockView.height = block.pixels.Height();
        blockView.spp = block.spp;
        blockView.seconds = results[i].seconds;
        const ViewNeed need = hasClock ? ViewNeed::MeanAndHalf : criteria[i]->Need(block.spp);
        if (need != ViewNeed::Nothing) {
            const double start = ThreadSeconds();
            FilmView& view = views.local();
            film->Extract(block.pixels, need == ViewNeed::MeanAndHalf, &view);
            blockView.mean = view.mean;
            blockView.halfMean = view.halfMean;
            blockView.viewSeconds = ThreadSeconds() - start;
        }
        return blockView;
    }

    void ReportProgress() {
        if (!options.onProgress) return;
        std::unique_lock reporting(progressMutex, std::try_to_lock);
        if (!reporting || Seconds() < nextProgress) return;
        nextProgress = Seconds() + options.progressInterval;
        RenderProgress progress;
        {
            std::lock_guard lock(mutex);
            progress = CurrentProgress();
        }
        options.onProgress(progress);
    }

    RenderProgress CurrentProgress() const {
        RenderProgress progress{int(schedule.Blocks().size()), schedule.StoppedBlocks(),
                                schedule.MedianSpp(),          samples,
                                schedule.SamplesToCap(),       Seconds()};
        if (hasClock) progress.secondsLeft = options.secondsLeft();
        return progress;
    }

    const SampleSource& source;
    const RenderOptions& options;
    Film* film;
    const Clock::time_point start = Clock::now();
    const double secondsBefore;         // of the runs before this one
    std::atomic<bool> pausing = false;  // takes no more tiles, for a checkpoint
    double nextCheckpoint = 0;
    const bool hasClock;

    std::mutex mutex;  // guards the schedule, `samples`, the tiles' seconds in `results`, `undo`
    Schedule schedule;
    std::vector<BlockResult> results;
    std::vector<std::unique_ptr<Criterion>> criteria;  // null for blocks that do not vote
    int64_t samples;
    PassUndo undo;            // for renders that have a clock
    bool timeCalled = false;  // it has run down

    std::mutex progressMutex;  // guards `nextProgress`, and lets one thread report at a time
    double nextProgress = 0;

    tbb::enumerable_thread_specific<FilmView> views;
    Task task{this};
    tbb::task_group group;
};

}  // namespace

RenderResult Render(const SampleSource& source, const RenderOptions& options, Film* film,
                    const RenderState* interrupted) {
    if (interrupted && !Executor::Fits(*interrupted, film->Region(), options.schedule))
        throw std::invalid_argument("the interrupted render has other blocks");
    const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    RenderResult result =
        arena.execute([&] { return Executor(source, options, film, interrupted).Run(); });
    result.threads = threads;
    return result;
}

SampleSource SamplesOf(const Scene& scene, Estimator estimator) {
    return [&scene, estimator](Sampler& sampler, const Vec2i& pixel, uint32_t index) {
        return RenderSample(scene, estimator, sampler, pixel, index);
    };
}

}  // namespace lull
