#include "renderer/learning/strategy_learner.h"

#include "renderer/base/color.h"
#include "renderer/learning/learner_state.h"

namespace lull {

namespace {

// Moves a share half of the way, on a scale of ratios, to where `variance` at a share of 1, over
// `cost`, has it beside the variance of camera's subpaths, whose cost is 1.
float Moved(float share, double variance, double cost, double ofCamera, float least) {
    if (!(ofCamera > 0)) return share;
    const double best = std::sqrt(variance / cost / ofCamera);
    return std::clamp(float(std::sqrt(double(share) * best)), least, 1.f);
}

// Variances of a sample, as sums over tiles by the square of their brightness.
struct Variances {
    double camera = 0, connections = 0, paths = 0;
};

Variances VariancesOf(const Film& film) {
    const PixelRect& region = film.Region();
    const std::vector<SampleSpread>& spreads = film.Spreads();
    std::vector<double> brightness(spreads.size(), 0);
    std::vector<int> pixels(spreads.size(), 0);
    double mean = 0;
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x) {
            const size_t tile = film.TileAt({x, y});
            const double l = double(Luminance(film.MeanAt({x, y})));
            brightness[tile] += l;
            ++pixels[tile];
            mean += l / double(region.Area());
        }
    Variances of;
    for (size_t i = 0; i < spreads.size(); ++i) {
        const SampleSpread& spread = spreads[i];
        if (spread.freedom <= 0) continue;
        const double l = brightness[i] / pixels[i] + 0.1 * mean, weight = pixels[i] / (l * l);
        if (!(weight > 0 && weight < double(kInfinity))) continue;
        const double samples = double(spread.samples);
        of.camera += weight * spread.squares / double(spread.freedom);
        of.connections += weight * spread.connected / samples;
        of.paths += weight * spread.light / samples;
    }
    return of;
}

}  // namespace

// Blocks that have stopped in the round were active when it began.
void StrategyLearner::Begin(const Schedule& schedule) {
    const int first = schedule.LeastSpp();
    int64_t active = 0;
    for (const Block& block : schedule.Blocks())
        if (!block.stopped || block.spp > first) active += block.pixels.Area();
    const double part = double(active) / double(std::max<int64_t>(1, pixels));
    ofRound = shares;
    ofRound.lightPaths =
        std::clamp(shares.lightPaths * float(std::sqrt(part)), kLeast.lightPaths, 1.f);
}

void StrategyLearner::EndRound(Film* film, const lull::RoundEnd&) {
    const Variances of = VariancesOf(*film);
    film->ForgetSpreads();
    if (!(of.camera > 0)) return;
    const double rest = std::max(of.camera - of.connections, 0.1 * of.camera);
    shares.connections = Moved(shares.connections, of.connections * double(ofRound.connections),
                               kCosts.connections, rest, kLeast.connections);
    shares.lightPaths = Moved(shares.lightPaths, of.paths * double(ofRound.lightPaths),
                              kCosts.lightPath, of.camera, kLeast.lightPaths);
}

void StrategyLearner::Get(StateReader* reader, const Film&) {
    const auto taken = reader->Get<BdptShares>();
    Require(taken.lightPaths >= 0 && taken.lightPaths <= 1 && taken.connections > 0 &&
                taken.connections <= 1,
            "its shares of light paths are damaged");
    shares = taken;
}

}  // namespace lull
