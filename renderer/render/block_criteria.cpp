#include "renderer/render/executor_internal.h"

#include "renderer/base/clocks.h"
#include "renderer/render/peers.h"
#include "stopping/rules/baselines.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

constexpr int kSmallestNoiseSide = 10;  // pixels, of blocks that VisibleNoise() takes

int EndOfPassBegun(const Block& block, ScheduleOptions options, const Film& film) {
    options.inSteps = true;
    const int most = MostSamples(block.pixels, film);
    if (most <= block.spp) return 0;
    int end = block.spp;
    while (end < std::min(most, options.cap)) end = PassEndAfter(end, options);
    return end;
}

double NoiseOf(const BlockView& view) {
    if (std::min(view.width, view.height) >= kSmallestNoiseSide) return VisibleNoise(view);
    const LightnessNoise noise = ComputeLightnessNoise(view);
    return SubBlockStatistics(noise, view.width, view.height, 1).maskedNoise[0];
}

std::vector<std::unique_ptr<Criterion>> MakeBlockCriteria(const RenderOptions& options,
                                                          std::span<const Block> blocks) {
    std::vector<std::unique_ptr<Criterion>> made(blocks.size());
    const bool follows = options.peers && options.peers->Rank() > 0;
    if (!options.makeCriterion || follows) return made;
    const double imageArea = double(options.film->Region().Area());
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (!blocks[i].votes) continue;
        made[i] = options.makeCriterion(
            {.index = int(i), .areaFraction = double(blocks[i].pixels.Area()) / imageArea});
        if (options.interrupted && !options.interrupted->criteria.empty() && blocks[i].spp > 0)
            made[i]->Restore(options.interrupted->criteria[i]);
    }
    return made;
}

}  // namespace

int MostSamples(const PixelRect& rect, const Film& film) {
    uint32_t most = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x)
            most = std::max(most, film.At({x, y}).count);
    return int(most);
}

std::vector<BlockStart> StartsOf(std::span<const BlockResult> blocks,
                                 const RenderOptions& options) {
    const Film& film = *options.film;
    std::vector<BlockStart> starts;
    for (const BlockResult& b : blocks) {
        const auto& [rect, spp] = std::pair(b.block.pixels, b.block.spp);
        BlockStart start{
            .spp = spp, .stopped = b.block.stopped, .stoppedByVote = b.block.stoppedByVote};
        start.hasVoted = std::ranges::any_of(
            b.decisions, [](const BlockDecision& d) { return d.decision.stop; });
        if (options.secondsLeft && !b.block.stopped)
            start.passEnd = EndOfPassBegun(b.block, options.schedule, film);
        if (options.secondsLeft && IsPassEnd(spp, options.schedule) && spp > 0) {
            FilmView view;
            film.Extract(rect, true, &view);
            start.noise = NoiseOf({view.width, view.height, spp, view.mean, view.halfMean});
        }
        starts.push_back(start);
    }
    return starts;
}

std::vector<BlockStart> StartsOf(const RenderOptions& options) {
    if (!options.interrupted) return {};
    return StartsOf(options.interrupted->blocks, options);
}

BlockCriteria::BlockCriteria(const RenderOptions& options, std::span<const Block> blocks)
    : options(options),
      hasClock(options.secondsLeft),
      criteria(MakeBlockCriteria(options, blocks)) {}

ViewNeed BlockCriteria::NeedAt(int block, int spp) const {
    if (!IsPassEnd(spp, options.schedule)) return ViewNeed::Nothing;
    const ViewNeed own = hasClock ? ViewNeed::MeanAndHalf : ViewNeed::Nothing;
    const auto& criterion = criteria[size_t(block)];
    return criterion ? std::max(own, criterion->Need(spp)) : own;
}

BlockCheck BlockCriteria::Check(int index, const Block& block, int spp, double seconds,
                                const std::function<void(int, FilmView*)>& complete) {
    const auto& criterion = criteria[size_t(index)];
    if ((!criterion && !hasClock) || !IsPassEnd(spp, options.schedule)) return {};
    const double start = ThreadSeconds();
    BlockView view = ViewOf(index, block, NeedAt(index, spp), complete);
    view.spp = spp;
    view.seconds = seconds;
    BlockCheck check;
    if (criterion) {
        check.decision = criterion->Observe(view);
        check.networkNoise = criterion->NetworkNoise();
    }
    check.answer.stop = check.decision.stop;
    if (hasClock) check.answer.noise = NoiseOf(view);
    check.seconds = ThreadSeconds() - start;
    return check;
}

BlockView BlockCriteria::ViewOf(int index, const Block& block, ViewNeed need,
                                const std::function<void(int, FilmView*)>& complete) {
    BlockView blockView;
    blockView.width = block.pixels.Width();
    blockView.height = block.pixels.Height();
    if (need == ViewNeed::Nothing) return blockView;
    const double start = ThreadSeconds();
    FilmView& view = views.local();
    options.film->Extract(block.pixels, need >= ViewNeed::MeanAndHalf, &view);
    if (complete) complete(index, &view);
    blockView.mean = view.mean;
    blockView.halfMean = view.halfMean;
    blockView.viewSeconds = ThreadSeconds() - start;
    return blockView;
}

std::vector<std::vector<std::byte>> BlockCriteria::Save() const {
    std::vector<std::vector<std::byte>> states;
    for (const std::unique_ptr<Criterion>& criterion : criteria)
        states.push_back(criterion ? criterion->Save() : std::vector<std::byte>());
    return states;
}

}  // namespace lull
