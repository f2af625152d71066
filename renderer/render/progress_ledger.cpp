#include "renderer/render/executor_internal.h"

#include <utility>

#include "renderer/base/clocks.h"

namespace lull {

namespace {

std::vector<StopTrend> MakeTrends(const RenderOptions& options,
                                  const std::vector<BlockResult>& results) {
    if (!options.trend || !options.events.onProgress || options.peers) return {};
    std::vector<StopTrend> made(results.size(), StopTrend(*options.trend));
    for (size_t i = 0; i < results.size(); ++i)
        for (const BlockDecision& record : results[i].decisions)
            made[i].Add(record.spp, record.decision, record.networkNoise);
    return made;
}

double SecondsOfAll(const std::vector<BlockResult>& results) {
    double seconds = 0;
    for (const BlockResult& result : results) seconds += result.seconds;
    return seconds;
}

// Passes of 20 spp whose blocks a forecast begins with, as it needs three checks for a trend.
constexpr int kLeastForecastSpp = 60;

}  // namespace

ProgressLedger::ProgressLedger(const RenderOptions& options, size_t blocks)
    : options(options),
      secondsBefore(options.interrupted ? options.interrupted->seconds : 0),
      spentBefore(options.interrupted ? SecondsOfAll(options.interrupted->blocks) : 0),
      samplesBefore(options.film->SampleCount()),
      results(options.interrupted ? options.interrupted->blocks : std::vector<BlockResult>(blocks)),
      trends(MakeTrends(options, results)),
      samples(samplesBefore) {}

double ProgressLedger::Seconds() const { return secondsBefore + SecondsSince(start); }

void ProgressLedger::AddTile(int block, double processorSeconds, const TileEffort& taken) {
    std::lock_guard lock(mutex);
    results[size_t(block)].seconds += processorSeconds;
    samples += taken.samples;
    effort.samples += taken.samples;
    effort.seconds += taken.seconds;
}

void ProgressLedger::AddPart(int block, double processorSeconds, int64_t partSamples) {
    std::lock_guard lock(mutex);
    results[size_t(block)].seconds += processorSeconds;
    samples += partSamples;
}

void ProgressLedger::AddCheck(int block, int spp, const BlockCheck& check) {
    BlockResult& result = results[size_t(block)];
    result.criterionSeconds += check.seconds;
    if (!check.decision.checked) return;
    result.decisions.push_back({spp, check.decision, check.networkNoise});
    std::lock_guard lock(mutex);
    if (!trends.empty()) trends[size_t(block)].Add(spp, check.decision, check.networkNoise);
}

TileEffort ProgressLedger::TakeEffort() {
    std::lock_guard lock(mutex);
    return std::exchange(effort, {});
}

double ProgressLedger::TakeSeconds(int block) {
    std::lock_guard lock(mutex);
    return std::exchange(results[size_t(block)].seconds, 0);
}

double ProgressLedger::SecondsOf(int block) {
    std::lock_guard lock(mutex);
    return results[size_t(block)].seconds;
}

int64_t ProgressLedger::Samples() {
    std::lock_guard lock(mutex);
    return samples;
}

void ProgressLedger::SetSamples(int64_t count) {
    std::lock_guard lock(mutex);
    samples = count;
}

const std::vector<BlockResult>& ProgressLedger::Blocks(const Schedule& schedule) {
    const std::span<const Block> blocks = schedule.Blocks();
    for (size_t i = 0; i < blocks.size(); ++i) {
        results[i].block = blocks[i];
        results[i].block.spp = schedule.DecidedSpp(int(i));
    }
    return results;
}

RenderResult ProgressLedger::Result(const Schedule& schedule) {
    RenderResult result;
    if (options.trend) result.trend = *options.trend;
    result.blocks = Blocks(schedule);
    result.progress = Progress(schedule);
    if (options.events.onProgress) options.events.onProgress(result.progress);
    return result;
}

void ProgressLedger::Report(LiveSchedule* schedule) {
    if (!options.events.onProgress) return;
    std::unique_lock reporting(reportMutex, std::try_to_lock);
    if (!reporting || Seconds() < nextReport) return;
    nextReport = Seconds() + options.events.progressInterval;
    options.events.onProgress(schedule->Locked([&](const Schedule& s) { return Progress(s); }));
}

RenderProgress ProgressLedger::Progress(const Schedule& schedule) {
    std::lock_guard lock(mutex);
    RenderProgress progress{.blocks = int(schedule.Blocks().size()),
                            .stoppedBlocks = schedule.StoppedBlocks(),
                            .blocksAtCap = schedule.BlocksAtCap(),
                            .medianSpp = schedule.MedianSpp(),
                            .samples = samples,
                            .samplesToCap = schedule.SamplesToCap(),
                            .seconds = Seconds()};
    if (options.secondsLeft) progress.secondsLeft = options.secondsLeft();
    if (!trends.empty()) Predict(schedule, &progress);
    return progress;
}

// Predicts the remaining time. A sample of a block costs as much as its samples so far, and CPU
// time passes at the rate of this run, of which each block at work must have a sample per pixel.
void ProgressLedger::Predict(const Schedule& schedule, RenderProgress* progress) const {
    const std::span<const Block> blocks = schedule.Blocks();
    const bool isCounted = options.trend->kind == RuleTrend::Samples;
    if (!isCounted && schedule.MedianSpp() < kLeastForecastSpp) return;
    const auto stops = PredictStops(trends, blocks, options.schedule.cap);
    if (!stops) return;
    const double spent = SecondsOfAll(results), spentHere = spent - spentBefore;
    double left = 0, secondsLeft = 0, active = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
        const double area = double(blocks[i].pixels.Area()), had = area * blocks[i].spp;
        const double missing = area * ((*stops)[i] - blocks[i].spp);
        if (!blocks[i].stopped) active += area;
        left += missing;
        secondsLeft += missing * (had > 0 ? results[i].seconds / had : spent / double(samples));
    }
    if (double(samples - samplesBefore) < active) return;
    progress->predictedSamples = left;
    if (!(spentHere > 0)) return;
    const double seconds = secondsLeft / spentHere * SecondsSince(start);
    progress->predictedSeconds = seconds;
    if (isCounted) return;
    std::array<double, 2> range = RangeOfRest(double(samples), left, options.trend->exponents);
    for (double& rest : range)
        rest = left > 0 ? seconds * std::min(rest, double(progress->samplesToCap)) / left : 0;
    progress->secondsRange = range;
}

}  // namespace lull
