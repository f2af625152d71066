#include "renderer/render/executor_internal.h"

#include <tbb/task_arena.h>

#include "renderer/base/color.h"
#include "renderer/base/thread_clock.h"
#include "renderer/render/guide_learning.h"

namespace lull {

namespace {

// Takes the samples of a tile, all of a pixel before the next: neighbouring rays find the same part
// of the scene in the caches, and the pixel's sums stay in registers. Pixels that an interrupted
// render has taken further already keep what they have. Adds them to `spread`, if there is one.
// Returns how many were taken.
template <typename Source>
int64_t RenderTile(const Source& source, const Tile& tile, Sampler sampler, Film* film,
                   SampleSpread* spread) {
    int64_t samples = 0;
    FilmTile pixels = film->Tile(tile.pixels);
    for (int y = tile.pixels.min.y(); y < tile.pixels.max.y(); ++y)
        for (int x = tile.pixels.min.x(); x < tile.pixels.max.x(); ++x) {
            const Vec2i pixel(x, y);
            FilmPixel sums = pixels.At(pixel);
            const uint32_t first = sums.count, end = uint32_t(tile.first + tile.count);
            double sum = 0, squares = 0;  // of luminance
            for (uint32_t k = first; k < end; ++k) {
                const PathSample sample = source(sampler, pixel, k);
                sums.Add(sample.radiance, sample.rejected);
                ++samples;
                if (!spread) continue;
                const double y = double(Luminance(sample.radiance));
                sum += y;
                squares += Sqr(y);
                spread->vertices += sample.vertices;
                ++spread->samples;
            }
            pixels.Set(pixel, sums);
            if (spread && end > first) {
                spread->squares += std::max(0., squares - Sqr(sum) / (end - first));
                spread->freedom += end - first - 1;
            }
        }
    return samples;
}

}  // namespace

bool Fits(const RenderState& state, const PixelRect& region, const ScheduleOptions& options) {
    const size_t count = MakeBlocks(region, options).size();
    return state.blocks.size() == count &&
           (state.criteria.empty() || state.criteria.size() == count);
}

Executor::Executor(const SampleSource& source, const RenderOptions& options, Film* film,
                   const RenderState* interrupted, std::span<const BlockStart> starts,
                   TileShare share, RankHooks given)
    : schedule(options, film, starts, std::move(share)),
      ledger(options, interrupted, schedule.Unlocked().Blocks().size(), film->SampleCount()),
      judge(options, *film, schedule.Unlocked().Blocks(), interrupted),
      tasks([this] { RunTile(); }, given.onException),
      source(source),
      options(options),
      film(film),
      hooks(std::move(given)) {}

RenderResult Executor::Run() {
    RestartIntervals();
    for (;;) {
        do {
            pausing = false;
            SpawnReady();
            tasks.Wait();
        } while (EndRound());
        const bool isOver = !pausing || IsCancelled();
        if (schedule.TimeCalled() && isOver && !IsCancelled()) Undo();
        if (isOver || ledger.Seconds() >= nextCheckpoint) WriteCheckpoint();
        if (isOver || IsCancelled()) return Result();
        ShowPreview();
    }
}

void Executor::RestartIntervals() {
    nextCheckpoint = ledger.Seconds() + options.checkpointInterval;
    nextPreview = ledger.Seconds() + options.previewInterval;
}

bool Executor::IsPauseDue() const {
    return (options.onCheckpoint && ledger.Seconds() >= nextCheckpoint) ||
           (options.onPreview && ledger.Seconds() >= nextPreview);
}

bool Executor::EndRound() {
    if (!options.learner || IsCancelled() || !schedule.IsRoundOver()) return false;
    options.learner->EndRound(*film);
    schedule.BeginRound(options.learner->RoundEnd());
    return true;
}

void Executor::Quiesce() {
    pausing = true;
    tasks.Wait();
}

void Executor::RunTile() {
    if (pausing || IsCancelled()) return;
    const std::optional<Tile> tile = schedule.Next();
    if (!tile) return;
    const double tileStart = ThreadSeconds(), wallStart = ledger.Seconds();
    const int64_t taken = TakeSamples(*tile);
    if (options.display) options.display->Show(tile->pixels, *film);
    ledger.AddTile(tile->block, ThreadSeconds() - tileStart, {taken, ledger.Seconds() - wallStart});
    if (schedule.Finish(*tile)) {
        if (hooks.onPassEnd)
            hooks.onPassEnd(tile->block);
        else
            tasks.Spawn(DecideBlock(tile->block));
    }
    ledger.Report(&schedule);
    if (IsPauseDue()) pausing = true;
}

int64_t Executor::TakeSamples(const Tile& tile) {
    const Sampler sampler(options.sampler, options.seed);
    SampleSpread* spread =
        options.learner ? options.learner->SpreadOf(*film, tile.pixels) : nullptr;
    if (!options.layers) return RenderTile(source, tile, sampler, film, spread);
    const auto withLayers = [&](Sampler& s, const Vec2i& pixel, uint32_t index) {
        FirstHit hit;
        const PathSample sample = options.layers.source(s, pixel, index, &hit);
        options.layers.Add(pixel, index, hit, sample.radiance);
        return sample;
    };
    return RenderTile(withLayers, tile, sampler, film, spread);
}

int Executor::DecideBlock(int i) {
    const int spp = schedule.Unlocked().PassEnd(i);
    Judgement judgement;
    // Isolation keeps a criterion that waits for tasks of its own from running a tile here, which
    // would fill the same view.
    tbb::this_task_arena::isolate([&] {
        judgement =
            judge.Judge(i, schedule.BlockAt(i), spp, ledger.SecondsOf(i), hooks.completeView);
    });
    ledger.AddJudgement(i, spp, judgement);
    if (hooks.onDecided) hooks.onDecided(i, judgement.answer);
    return schedule.Decide(i, judgement.answer);
}

std::vector<int> Executor::Undo() {
    std::vector<int> blocks = schedule.Undo();
    ledger.SetSamples(film->SampleCount());
    return blocks;
}

void Executor::WriteCheckpoint() {
    if (options.onCheckpoint && !(schedule.Unlocked().Done() && !options.checkpointAtEnd))
        options.onCheckpoint({ledger.Blocks(schedule.Unlocked()), judge.Save(), ledger.Seconds()});
    nextCheckpoint = ledger.Seconds() + options.checkpointInterval;
}

void Executor::ShowPreview() {
    if (!options.onPreview || ledger.Seconds() < nextPreview || schedule.Unlocked().Done()) return;
    options.onPreview(Result());
    nextPreview = ledger.Seconds() + options.previewInterval;
}

RenderResult Executor::Result() {
    const bool isDone = schedule.Unlocked().Done();
    RenderResult result = ledger.Result(schedule.Unlocked());
    result.timeUp = schedule.TimeCalled() && !isDone && !IsCancelled();
    result.cancelled = !isDone && !result.timeUp;
    return result;
}

}  // namespace lull
