#include "renderer/render/executor_internal.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "renderer/base/clocks.h"
#include "renderer/base/math.h"
#include "renderer/render/light_rounds.h"

namespace lull {

namespace {

// Takes the samples of a tile, all of a pixel before the next: neighbouring rays find the same part
// of the scene in the caches, and the pixel's sums stay in registers. Pixels that an interrupted
// render has taken further already keep what they have. Adds them to `spread`, if there is one, and
// the light of light paths, if there is any. Returns how many were taken.
template <typename Take>
int64_t RenderTile(const Take& take, const Tile& tile, Film* film, SampleSpread* spread,
                   SplatAdder* light) {
    int64_t samples = 0;
    FilmTile pixels = film->Tile(tile.pixels);
    for (int y = tile.pixels.min.y(); y < tile.pixels.max.y(); ++y)
        for (int x = tile.pixels.min.x(); x < tile.pixels.max.x(); ++x) {
            const Vec2i pixel(x, y);
            FilmPixel sums = pixels.At(pixel);
            const uint32_t first = sums.count, end = uint32_t(tile.first + tile.count);
            if (light && end > first) light->Begin(pixel);
            double sum = 0, squares = 0;  // of luminance
            for (uint32_t k = first; k < end; ++k) {
                const PathSample& sample = take(pixel, k);
                sums.Add(sample.radiance, sample.rejected);
                ++samples;
                if (!spread) continue;
                const double y = double(Luminance(sample.radiance));
                sum += y;
                squares += Sqr(y);
                spread->connected += Sqr(y * double(sample.connected));
                ++spread->samples;
            }
            if (light && end > first) {
                light->End(pixel, first, &sums);
                if (spread) spread->light += light->SquaresAt(pixel);
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

bool HasBlocksOf(const RenderState& state, const PixelRect& region,
                 const ScheduleOptions& options) {
    const size_t count = MakeBlocks(region, options).size();
    return state.blocks.size() == count &&
           (state.criteria.empty() || state.criteria.size() == count);
}

Executor::Executor(const RenderOptions& options, std::span<const BlockStart> starts,
                   RankTiles share, RankHooks given)
    : schedule(options, starts, std::move(share)),
      ledger(options, schedule.Unlocked().Blocks().size()),
      criteria(options, schedule.Unlocked().Blocks()),
      tasks([this] { RunTile(); }, given.onException),
      options(options),
      hooks(std::move(given)) {
    if (options.lightRounds && options.interrupted && options.interrupted->shares)
        options.lightRounds->SetShares(*options.interrupted->shares);
}

RenderResult Executor::Run() {
    RestartIntervals();
    if (options.lightRounds) BeginLight();
    for (;;) {
        do {
            pausing = false;
            SpawnReady();
            tasks.Wait();
        } while (EndRound());
        const double pause = ledger.Seconds();
        const bool isOver = !pausing || IsCancelled();
        if (schedule.TimeCalled() && isOver && !IsCancelled()) Undo();
        if (isOver || ledger.Seconds() >= nextCheckpoint) WriteCheckpoint();
        if (isOver || IsCancelled()) return Result();
        ShowPreview(pause);
    }
}

void Executor::RestartIntervals() {
    nextCheckpoint = ledger.Seconds() + options.checkpoints.interval;
    nextPreview = ledger.Seconds() + options.events.previewInterval;
}

bool Executor::IsPauseDue() const {
    return (options.checkpoints.write && ledger.Seconds() >= nextCheckpoint) ||
           (options.events.onPreview && ledger.Seconds() >= nextPreview);
}

void Executor::BeginLightRound(const std::function<void()>& writeCheckpoint) {
    options.lightRounds->Begin(schedule.Unlocked());
    if (options.lightRounds->IsCutShort() && !isLastRound) writeCheckpoint();
    isLastRound = options.lightRounds->IsCutShort();
}

void Executor::BeginLight() {
    BeginLightRound([this] { WriteCheckpoint(); });
    schedule.BeginRound(LightRoundEnd(options));
    isLightTraced = options.lightRounds->Trace([this] { return IsCancelled(); });
}

bool Executor::EndRound() {
    if (!options.lightRounds || !schedule.Unlocked().NoPassUnderWay()) return false;
    options.lightRounds->Learn(options.film);
    if (IsCancelled() || !schedule.IsRoundOver()) return false;
    BeginLight();
    return true;
}

void Executor::Quiesce() {
    pausing = true;
    tasks.Wait();
}

void Executor::RunTile() {
    if (pausing || IsCancelled() || !isLightTraced) return;
    const std::optional<Tile> tile = schedule.Next();
    if (!tile) return;
    const double tileStart = ThreadSeconds(), wallStart = ledger.Seconds();
    const int64_t taken = TakeSamples(*tile);
    if (options.display) options.display->Show(tile->pixels, *options.film);
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
    Sampler sampler = options.sampler;
    PathSample sample;
    Film* film = options.film;
    SampleSpread* spread = film->SpreadOf(tile.pixels);
    const auto render = [&](const auto& take) {
        if (!options.lightRounds) return RenderTile(take, tile, film, spread, nullptr);
        SplatAdder light(*options.lightRounds, film);
        return RenderTile(take, tile, film, spread, &light);
    };
    const auto alone = [&](const Vec2i& pixel, uint32_t index) -> const PathSample& {
        options.source(sampler, pixel, index, &sample);
        return sample;
    };
    if (film->layers.IsEmpty()) return render(alone);
    sample.asksForHit = film->layers.NeedFirstHits();
    sample.asksForFeatures = film->layers.Options().features;
    const LightGroups& wanted = film->layers.Options().groups;
    std::optional<GroupRadiance> groups;
    if (wanted.Count() > 0) sample.groups = &groups.emplace(wanted);
    return render([&](const Vec2i& pixel, uint32_t index) -> const PathSample& {
        film->layers.Add(pixel, alone(pixel, index));
        return sample;
    });
}

int Executor::DecideBlock(int i) {
    const int spp = schedule.Unlocked().PassEnd(i);
    BlockCheck check;
    // Isolation keeps a criterion that waits for tasks of its own from running a tile here, which
    // would fill the same view.
    tbb::this_task_arena::isolate([&] {
        check =
            criteria.Check(i, schedule.BlockAt(i), spp, ledger.SecondsOf(i), hooks.completeView);
    });
    ledger.AddCheck(i, spp, check);
    if (hooks.onDecided) hooks.onDecided(i, check.answer);
    return schedule.Decide(i, check.answer);
}

std::vector<int> Executor::Undo() {
    std::vector<int> blocks = schedule.Undo();
    ledger.SetSamples(options.film->SampleCount());
    return blocks;
}

RenderState Executor::State() {
    RenderState state{ledger.Blocks(schedule.Unlocked()), criteria.Save(), ledger.Seconds()};
    if (options.lightRounds) state.shares = options.lightRounds->Shares();
    return state;
}

void Executor::WriteCheckpoint() {
    const Checkpointing& checkpoints = options.checkpoints;
    if (checkpoints.write && !isLastRound && !(schedule.Unlocked().Done() && !checkpoints.atEnd))
        checkpoints.write(State());
    nextCheckpoint = ledger.Seconds() + checkpoints.interval;
}

void Executor::ShowPreview(double pause) {
    if (!options.events.onPreview || ledger.Seconds() < nextPreview || schedule.Unlocked().Done())
        return;
    options.events.onPreview(Result());
    // Previews that take long, as denoised ones, become up to ten times as rare.
    const double end = ledger.Seconds(), interval = options.events.previewInterval;
    nextPreview = end + std::clamp(4 * (end - pause), interval, 10 * interval);
}

RenderResult Executor::Result() {
    const bool isDone = schedule.Unlocked().Done();
    RenderResult result = ledger.Result(schedule.Unlocked());
    result.timeUp = schedule.TimeCalled() && !isDone && !IsCancelled();
    result.cancelled = !isDone && !result.timeUp;
    return result;
}

}  // namespace lull
