#include "renderer/render/light_rounds.h"

#include <atomic>
#include <limits>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

constexpr uint32_t kChunk = 1024;  // light paths that a thread takes

// Costs of a light path, and of a subpath from a light with its connections, in camera's subpaths
// with the light that is sampled at their vertices (renderer/docs/rendering.md).
constexpr double kCostOfLightPath = 1, kCostOfConnections = 2.5;

// Moves a share half of the way, on a scale of ratios, to where `variance` at a share of 1, over
// `cost`, has it beside the variance of camera's subpaths, whose cost is 1.
float Moved(float share, double variance, double cost, double ofCamera, float least) {
    if (!(ofCamera > 0)) return share;
    const double best = std::sqrt(variance / cost / ofCamera);
    return std::clamp(float(std::sqrt(double(share) * best)), least, 1.f);
}

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

// Returns the part of the pixels active when the round began: also of blocks that stopped in it.
double ActivePart(const Schedule& schedule) {
    const int first = schedule.LeastSpp();
    int64_t active = 0, all = 0;
    for (const Block& block : schedule.Blocks()) {
        all += block.pixels.Area();
        if (!block.stopped || block.spp > first) active += block.pixels.Area();
    }
    return double(active) / double(std::max<int64_t>(1, all));
}

}  // namespace

LightRounds::LightRounds(const Scene& scene, const Film& film, const Sampler& sampler)
    : scene(scene),
      region(film.Region()),
      start(sampler),
      unit(FindUnit()),
      groups(film.layers.Options().groups) {}

double LightRounds::FindUnit() const {
    constexpr uint32_t kMost = 1 << 16;
    constexpr int kEnough = 256;
    if (LightPathCount(scene, kFirst) == 0) return 1;
    Sampler sampler = start;
    std::vector<Splat> splats;
    double sum = 0;
    int count = 0;
    for (uint32_t i = 0; i < kMost && count < kEnough; ++i) {
        TraceLightPath(scene, kFirst, sampler, 0, i, &splats);
        for (const Splat& splat : splats) {
            const double y = double(Luminance(splat.radiance));
            if (!(y > 0)) continue;
            sum += y;
            ++count;
        }
    }
    if (count == 0) return double(scene.film.scale);
    return std::exp2(std::round(std::log2(std::clamp(sum / count, 1e-30, 1e30))));
}

void LightRounds::Begin(const Schedule& schedule) {
    const int first = schedule.LeastSpp();
    ScheduleOptions uncapped = schedule.Options();
    uncapped.cap = std::numeric_limits<int>::max();
    isCutShort = !schedule.Done() &&
                 PassEndAfter(first, uncapped) != PassEndAfter(first, schedule.Options());
    BdptShares ofRound = shares;
    ofRound.lightPaths = std::clamp(shares.lightPaths * float(std::sqrt(ActivePart(schedule))),
                                    kLeast.lightPaths, 1.f);
    Begin({first, PassEndAfter(first, schedule.Options()), ofRound});
}

void LightRounds::Begin(const LightRound& begun) {
    round = begun;
    planes.assign(size_t(1 + groups.Count()), SplatPlane(region, unit));
}

bool LightRounds::Trace(const std::function<bool()>& isCancelled, int part, int parts) {
    const auto paths = uint32_t(LightPathCount(scene, round.shares));
    const auto chunks = int((paths + kChunk - 1) / kChunk);
    std::atomic<bool> isWhole = true;
    ForEachIndex(round.end - round.first, [&](int sample) {
        ForEachIndex(chunks, [&](int chunk) {
            if (isCancelled && isCancelled()) isWhole = false;
            if (!isWhole || (int64_t(sample) * chunks + chunk) % parts != part) return;
            const uint32_t begin = uint32_t(chunk) * kChunk, index = uint32_t(round.first + sample);
            Sampler sampler = start;
            std::vector<Splat> splats;
            for (uint32_t i = begin; i < std::min(begin + kChunk, paths); ++i) {
                TraceLightPath(scene, round.shares, sampler, index, i, &splats);
                for (const Splat& splat : splats) Add(splat, InHalf(index));
            }
        });
    });
    return isWhole;
}

void LightRounds::Learn(Film* film) {
    const Variances of = VariancesOf(*film);
    film->ForgetSpreads();
    if (!(of.camera > 0)) return;
    const double rest = std::max(of.camera - of.connections, 0.1 * of.camera);
    shares.connections =
        Moved(shares.connections, of.connections * double(round.shares.connections),
              kCostOfConnections, rest, kLeast.connections);
    shares.lightPaths = Moved(shares.lightPaths, of.paths * double(round.shares.lightPaths),
                              kCostOfLightPath, of.camera, kLeast.lightPaths);
}

void LightRounds::Add(const Splat& s, bool inHalf) {
    if (s.rejected) {
        const Vec2i p = s.film.array().floor().cast<int>().matrix();
        planes[0].Reject(p.cwiseMax(region.min).cwiseMin(region.max - Vec2i(1, 1)));
        return;
    }
    const Vec2f radius = scene.filter.Radius(), middle(0.5f, 0.5f);
    const Vec2f low = s.film - middle - radius, high = s.film - middle + radius;
    const Vec2i from = low.array().ceil().cast<int>().matrix().cwiseMax(region.min);
    const Vec2i to = high.array().floor().cast<int>().matrix().cwiseMin(region.max - Vec2i(1, 1));
    for (int y = from.y(); y <= to.y(); ++y)
        for (int x = from.x(); x <= to.x(); ++x) {
            const float weight = scene.filter.Evaluate(s.film - Vec2f(float(x), float(y)) - middle);
            if (weight == 0) continue;
            planes[0].Add({x, y}, s.radiance * weight, inHalf);
            if (groups.Count() > 0)
                planes[1 + size_t(groups.ofLight[size_t(s.light)])].Add({x, y}, s.radiance * weight,
                                                                        inHalf);
        }
}

SplatLight LightRounds::LightOf(const SplatPlane& light, const Vec2i& p, uint32_t from) const {
    const SplatPlane::Sums all = light.SumsAt(p);
    // Passes of a render that goes on with another rule may begin within a round.
    const double samples = double(round.end) - double(from);
    const double length = double(round.end - round.first), share = samples / length;
    SplatLight part{
        .squares = all.squares * share, .each = Luminance(all.sum) / length, .samples = samples};
    for (size_t c = 0; c < 3; ++c) {
        part.sum[c] = all.sum[c] * share;
        part.halfSum[c] = all.halfSum[c] * share;
    }
    return part;
}

void SplatAdder::Begin(const Vec2i& p) {
    if (const auto* groups = film->layers.Find<LightGroupLayer>())
        for (int i = 0; i < groups->Count(); ++i)
            before[size_t(i)] = Luminance(groups->At(i, p, 0).sum);
}

void SplatAdder::End(const Vec2i& p, uint32_t first, FilmPixel* sums) const {
    PixelSplats splats{rounds.LightOf(rounds.planes[0], p, first)};
    splats.all.camera = Luminance(sums->sum) - Luminance(film->At(p).sum);
    std::array<SplatLight, kMostLightGroups + 1> ofGroups;
    if (const auto* groups = film->layers.Find<LightGroupLayer>()) {
        for (size_t i = 0; i < size_t(groups->Count()); ++i) {
            ofGroups[i] = rounds.LightOf(rounds.planes[1 + i], p, first);
            ofGroups[i].camera = Luminance(groups->At(int(i), p, 0).sum) - before[i];
        }
        splats.groups = {ofGroups.data(), size_t(groups->Count())};
    }
    for (size_t c = 0; c < 3; ++c) {
        sums->sum[c] += splats.all.sum[c];
        sums->halfSum[c] += splats.all.halfSum[c];
    }
    sums->rejected += uint32_t(rounds.planes[0].At(p).rejected);
    film->layers.ForEach([&](auto& layer) {
        if constexpr (requires { layer.AddSplats(p, splats); }) layer.AddSplats(p, splats);
    });
}

}  // namespace lull
