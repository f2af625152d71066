#include "renderer/render/executor_internal.h"

#include <tbb/task_arena.h>

#include <functional>

#include "renderer/base/thread_clock.h"
#include "stopping/rules/lnoise.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

ScheduleOptions ScheduleFor(const RenderOptions& options) {
    ScheduleOptions schedule = options.schedule;
    schedule.worstFirst = bool(options.secondsLeft);
    return schedule;
}

// Takes the samples of a tile, all of a pixel before the next: neighbouring rays find the same
// part of the scene in the caches, and the pixel's sums stay in registers. Pixels that an
// interrupted render has taken further already keep what they have. Returns how many were taken.
template <typename Source>
int64_t RenderTile(const Source& source, const Tile& tile, Sampler sampler, Film* film) {
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
            film->Set(pixel, sums);
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

}  // namespace

std::vector<BlockStart> StartsOf(const RenderState* interrupted, bool hasClock, const Film& film) {
    if (!interrupted) return {};
    return StartsOf(interrupted->blocks, hasClock, film);
}

std::vector<BlockStart> StartsOf(std::span<const BlockResult> blocks, bool hasClock,
                                 const Film& film) {
    std::vector<BlockStart> starts;
    for (const BlockResult& b : blocks) {
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

Executor::Executor(const SampleSource& source, const RenderOptions& options, Film* film,
                   const RenderState* interrupted)
    : Executor(source, options, film, interrupted,
               StartsOf(interrupted, bool(options.secondsLeft), *film), {}) {}

Executor::Executor(const SampleSource& source, const RenderOptions& options, Film* film,
                   const RenderState* interrupted, std::span<const BlockStart> starts,
                   TileShare share)
    : source(source),
      options(options),
      film(film),
      share(std::move(share)),
      secondsBefore(interrupted ? interrupted->seconds : 0),
      hasClock(options.secondsLeft),
      schedule(film->Region(), ScheduleFor(options), starts, this->share),
      results(interrupted ? interrupted->blocks
                          : std::vector<BlockResult>(schedule.Blocks().size())),
      criteria(MakeCriteria(interrupted)),
      trends(MakeTrends()),
      samples(film->SampleCount()) {}

bool Executor::Fits(const RenderState& state, const PixelRect& region,
                    const ScheduleOptions& options) {
    const size_t count = MakeBlocks(region, options).size();
    return state.blocks.size() == count && state.criteria.size() == count;
}

RenderResult Executor::Run() {
    ShowStops();
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
    return Result();
}

RenderResult Executor::Result() {
    NoteBlocks();
    RenderResult result;
    result.progress = CurrentProgress();
    if (options.onProgress) options.onProgress(result.progress);
    result.timeUp = timeCalled && !schedule.Done() && !IsCancelled();
    result.cancelled = !schedule.Done() && !result.timeUp;
    result.blocks = std::move(results);
    return result;
}

void Executor::Task::operator()() {
    order.Enter();
    try {
        executor->RunTile();
    } catch (...) {
        if (!executor->TakeException(std::current_exception())) throw;
    }
    order.Leave();
}

void Executor::Spawn(int count) {
    task.order.Leave();
    for (int i = 0; i < count; ++i) group.run(std::ref(task));
}

void Executor::RunTile() {
    if (pausing || IsCancelled()) return;
    const std::optional<Tile> tile = TakeTile();
    if (tile) RunTile(*tile);
}

void Executor::RunTile(const Tile& tile) {
    const double tileStart = ThreadSeconds(), wallStart = Seconds();
    const int64_t taken = TakeSamples(tile);
    if (options.display) options.display->Show(tile.pixels, *film);
    if (FinishTile(tile, ThreadSeconds() - tileStart, {taken, Seconds() - wallStart}))
        OnPassEnd(tile.block);
    ReportProgress();
    if (options.onCheckpoint && Seconds() >= nextCheckpoint) pausing = true;
}

int64_t Executor::TakeSamples(const Tile& tile) {
    const Sampler sampler(options.sampler, options.seed);
    if (!options.layers) return RenderTile(source, tile, sampler, film);
    const auto withLayers = [&](Sampler& s, const Vec2i& pixel, uint32_t index) {
        return options.layers.Take(s, pixel, index);
    };
    return RenderTile(withLayers, tile, sampler, film);
}

void Executor::Restart(std::span<const BlockStart> starts, TileShare newShare) {
    std::lock_guard lock(mutex);
    share = std::move(newShare);
    schedule = Schedule(film->Region(), ScheduleFor(options), starts, share);
    undo = {};
    effort = {};
}

std::vector<BlockStart> Executor::Starts() {
    NoteBlocks();
    return StartsOf(results, hasClock, *film);
}

double Executor::Seconds() const {
    return secondsBefore + std::chrono::duration<double>(Clock::now() - start).count();
}

void Executor::NoteBlocks() {
    const std::span<const Block> blocks = schedule.Blocks();
    for (size_t i = 0; i < blocks.size(); ++i) {
        results[i].block = blocks[i];
        results[i].block.spp = schedule.DecidedSpp(int(i));
    }
}

RenderState Executor::State() {
    NoteBlocks();
    RenderState state{results, {}, Seconds()};
    for (const std::unique_ptr<Criterion>& criterion : criteria)
        state.criteria.push_back(criterion ? criterion->Save() : std::vector<std::byte>());
    return state;
}

// There are never more tasks than tiles, but when time has been called.
std::optional<Tile> Executor::TakeTile() {
    const bool isTimeUp = hasClock && !options.peers && !(options.secondsLeft() > 0);
    if (isTimeUp) CallTime();
    std::lock_guard lock(mutex);
    const std::optional<Tile> tile = schedule.Next();
    if (tile && hasClock && !undo.Has(tile->block))
        undo.Keep(tile->block,
                  TilesOf(schedule.Blocks()[tile->block].pixels, tile->block,
                          options.schedule.tileSize, share),
                  *film, options.layers);
    return tile;
}

void Executor::CallTime() {
    std::lock_guard lock(mutex);
    schedule.CallTime();
    timeCalled = true;
}

void Executor::Undo() {
    undo.UndoAll(film, options.layers);
    samples = film->SampleCount();
}

// Returns true if the tile was the last of its pass.
bool Executor::FinishTile(const Tile& tile, double seconds, const Effort& spent) {
    std::lock_guard lock(mutex);
    results[tile.block].seconds += seconds;
    samples += spent.samples;
    effort.samples += spent.samples;
    effort.seconds += spent.seconds;
    return schedule.Finish(tile);
}

int Executor::DecideBlock(int i) {
    Judgement judgement;
    // Isolation keeps a criterion that waits for tasks of its own from running a tile here,
    // which would fill the same view.
    tbb::this_task_arena::isolate([&] { judgement = Judge(i); });
    OnDecided(i, judgement);
    return Decide(i, judgement);
}

int Executor::Decide(int i, const Judgement& judgement) {
    std::lock_guard lock(mutex);
    const int readyBefore = schedule.ReadyTiles();
    schedule.Decide(i, judgement.stop, judgement.noise);
    ShowStops();
    if (hasClock) undo.Forget(i);
    return schedule.ReadyTiles() - readyBefore;
}

void Executor::ShowStops() {
    if (!options.display) return;
    const std::span<const Block> blocks = schedule.Blocks();
    shownStops.resize(blocks.size());
    for (size_t i = 0; i < blocks.size(); ++i)
        if (blocks[i].stopped && !std::exchange(shownStops[i], true))
            options.display->ShowStop(blocks[i].pixels);
}

std::vector<std::unique_ptr<Criterion>> Executor::MakeCriteria(
    const RenderState* interrupted) const {
    const std::span<const Block> blocks = schedule.Blocks();
    std::vector<std::unique_ptr<Criterion>> made(blocks.size());
    if (!options.makeCriterion || share.rank > 0) return made;
    const double imageArea = double(film->Region().Area());
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (!blocks[i].votes) continue;
        made[i] = options.makeCriterion(
            {.index = int(i), .areaFraction = double(blocks[i].pixels.Area()) / imageArea});
        if (interrupted && blocks[i].spp > 0) made[i]->Restore(interrupted->criteria[i]);
    }
    return made;
}

// Follows the decisions so far. Of several ranks, none knows what all blocks have cost.
std::vector<StopTrend> Executor::MakeTrends() const {
    if (!options.trend || !options.onProgress || options.peers) return {};
    std::vector<StopTrend> made(results.size(), StopTrend(*options.trend));
    for (size_t i = 0; i < results.size(); ++i)
        for (const DecisionRecord& record : results[i].decisions)
            made[i].Add(record.spp, record.decision);
    return made;
}

// Nobody else touches a block between the end of its pass and the decision.
Executor::Judgement Executor::Judge(int i) {
    if (!criteria[i] && !hasClock) return {};
    const double start = ThreadSeconds();
    const int spp = schedule.PassEnd(i);
    const BlockView view = ViewOf(i, spp);
    const Decision decision = criteria[i] ? criteria[i]->Observe(view) : Decision();
    if (decision.judged) results[i].decisions.push_back({spp, decision});
    if (decision.judged && !trends.empty()) {
        std::lock_guard lock(mutex);
        trends[size_t(i)].Add(spp, decision);
    }
    Judgement judgement{.stop = decision.stop};
    if (hasClock) judgement.noise = decision.visibleNoise ? *decision.visibleNoise : NoiseOf(view);
    results[i].criterionSeconds += ThreadSeconds() - start;
    return judgement;
}

// Returns what the criterion and the clock have to see of a block.
ViewNeed Executor::NeedAt(int i, int spp) const {
    if (hasClock) return ViewNeed::MeanAndHalf;
    return criteria[i] ? criteria[i]->Need(spp) : ViewNeed::Nothing;
}

BlockView Executor::ViewOf(int i, int spp) {
    const Block& block = schedule.Blocks()[i];
    BlockView blockView;
    blockView.width = block.pixels.Width();
    blockView.height = block.pixels.Height();
    blockView.spp = spp;
    blockView.seconds = results[i].seconds;
    const ViewNeed need = NeedAt(i, spp);
    if (need != ViewNeed::Nothing) {
        const double start = ThreadSeconds();
        FilmView& view = views.local();
        film->Extract(block.pixels, need == ViewNeed::MeanAndHalf, &view);
        CompleteView(i, &view);
        blockView.mean = view.mean;
        blockView.halfMean = view.halfMean;
        blockView.viewSeconds = ThreadSeconds() - start;
    }
    return blockView;
}

void Executor::ReportProgress() {
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

RenderProgress Executor::CurrentProgress() const {
    RenderProgress progress{int(schedule.Blocks().size()), schedule.StoppedBlocks(),
                            schedule.MedianSpp(),          samples,
                            schedule.SamplesToCap(),       Seconds()};
    if (hasClock) progress.secondsLeft = options.secondsLeft();
    if (!trends.empty()) Predict(&progress);
    return progress;
}

// Predicts what is left. A sample of a block costs what its samples have cost so far, and the
// seconds of processors go by as fast as they did.
void Executor::Predict(RenderProgress* progress) const {
    const std::span<const Block> blocks = schedule.Blocks();
    const auto stops = PredictStops(trends, blocks, options.schedule.cap);
    if (!stops) return;
    double spent = 0;
    for (const BlockResult& result : results) spent += result.seconds;
    double left = 0, secondsLeft = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
        const double area = double(blocks[i].pixels.Area()), had = area * blocks[i].spp;
        const double missing = area * ((*stops)[i] - blocks[i].spp);
        left += missing;
        secondsLeft += missing * (had > 0 ? results[i].seconds / had : spent / double(samples));
    }
    progress->predictedSamples = left;
    if (spent > 0) progress->predictedSeconds = secondsLeft / spent * progress->seconds;
}

}  // namespace lull
