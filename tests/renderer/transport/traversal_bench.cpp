// Measures how much of a render's time is ray traversal, and what sorting the rays or tracing them
// in packets would give. Each scene is rendered on one thread while its rays are recorded; the same
// rays are then traced again:
//   order   path     as the render traced them
//           bounce   those of the same bounce together: what a wavefront would trace
//           sorted   within each bounce by the octant of the direction, then along a Morton curve
//           first    as path, only the rays of the camera and the shadow rays of what they hit:
//           those
//                    that packets could have without sorting, the samples of a pixel together;
//                    "of render" is how much faster than now a whole render could be with them
//   width   1        through the accelerator, one at a time, as in a render
//           8, 16    in Embree's packets; gathering them counts, but no hit is handed on
// The packets of path/8 and path/16 hold rays that follow from each other, so no render could have
// them: they show what packets save apart from coherence.
// Times are the thread's own processor time, the least of several rounds that each measure all
// variants, so that other work on the machine disturbs them little. The share of traversal is that
// of path/1; rather too low, since shading does not displace the scene from the caches there.
// The scenes are those of LULL_BENCH_SCENES (files, separated by colons), or our own.
// LULL_BENCH_SPP sets the samples per pixel.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <span>

#include "renderer/input/pbrt_parser.h"
#include "renderer/scene/compile.h"
#include "renderer/transport/integrator.h"
#include "tests/renderer/bench_scenes.h"
#include "tests/renderer/transport/recording_accelerator.h"

namespace lull {
namespace {

constexpr int kSide = 128;    // pixels
constexpr int kTileSize = 8;  // small, as in renders
constexpr int kRounds = 5;

constexpr std::array<const char*, 4> kOrders = {"path", "bounce", "sorted", "first"};
constexpr size_t kFirst = 3;
constexpr std::array<int, 3> kWidths = {1, 8, 16};

double ThreadSeconds() {
    timespec t = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// The shortest of the times a thing took, and how many rays it found to hit.
struct Timing {
    double seconds = kInfinity;
    size_t hits = 0;

    template <class F>
    void Measure(F&& run) {
        const double start = ThreadSeconds();
        hits = run();
        seconds = std::min(seconds, ThreadSeconds() - start);
    }
};

struct Measurement {
    size_t samples, nearestCount, occlusionCount, firstNearestCount, firstOcclusionCount;
    Timing render, sort;
    struct Variant {
        Timing nearest, occlusion;
        double Seconds() const { return nearest.seconds + occlusion.seconds; }
    };
    std::array<std::array<Variant, kWidths.size()>, kOrders.size()> variants;  // [order][width]

    size_t RayCount() const { return nearestCount + occlusionCount; }
};

// Renders the image tile by tile, recording into `log` unless it is null. With the combined
// estimator each nearest-hit ray is the next bounce of its path.
void RenderImage(const Scene& scene, int samplesPerPixel, RayLog* log) {
    Sampler sampler(SamplerKind::Random, 0);
    rayLog = log;
    for (int i = 0; i < kSide * kSide; ++i) {
        constexpr int area = kTileSize * kTileSize, columns = kSide / kTileSize;
        const int tile = i / area, inTile = i % area;
        const Vec2i pixel(tile % columns * kTileSize + inTile % kTileSize,
                          tile / columns * kTileSize + inTile / kTileSize);
        for (int k = 0; k < samplesPerPixel; ++k) {
            if (log) log->bounce = -1;
            benchmark::DoNotOptimize(
                RenderSample(scene, Estimator::Combined, sampler, pixel, uint32_t(k)));
        }
    }
    rayLog = nullptr;
}

// Spreads the lowest 17 bits of v to every third bit.
uint64_t SpreadBits(uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffull;
    v = (v | v << 16) & 0x001f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    return (v | v << 2) & 0x1249249249249249ull;
}

std::vector<RecordedRay> SortByBounce(std::vector<RecordedRay> rays) {
    std::stable_sort(rays.begin(), rays.end(),
                     [](const auto& a, const auto& b) { return a.bounce < b.bounce; });
    return rays;
}

std::vector<RecordedRay> SortSpatially(std::span<const RecordedRay> rays) {
    Vec3f lower = Vec3f::Constant(kInfinity), upper = -lower;
    for (const auto& entry : rays) {
        lower = lower.cwiseMin(entry.ray.o);
        upper = upper.cwiseMax(entry.ray.o);
    }
    const Vec3f extent = (upper - lower).cwiseMax(1e-20f);
    const Vec3f scale = 0x1ffff * extent.cwiseInverse();
    std::vector<std::pair<uint64_t, uint32_t>> keys(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        const Ray& ray = rays[i].ray;
        uint64_t key = uint64_t(rays[i].bounce) << 3;
        for (int k = 0; k < 3; ++k) key |= uint64_t(std::signbit(ray.d[k])) << k;
        key <<= 51;
        for (int k = 0; k < 3; ++k)
            key |= SpreadBits(uint64_t((ray.o[k] - lower[k]) * scale[k])) << k;
        keys[i] = {key, uint32_t(i)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<RecordedRay> sorted(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) sorted[i] = rays[keys[i].second];
    return sorted;
}

std::vector<RecordedRay> OnlyFirst(std::vector<RecordedRay> rays) {
    std::erase_if(rays, [](const RecordedRay& ray) { return ray.bounce > 0; });
    return rays;
}

size_t Trace(const Scene& scene, RTCScene world, std::span<const RecordedRay> rays,
             bool isOcclusion, int width, bool areCoherent) {
    if (width == 8) return TracePackets<8>(world, rays, isOcclusion, areCoherent);
    if (width == 16) return TracePackets<16>(world, rays, isOcclusion, areCoherent);
    size_t hits = 0;
    Hit hit;
    for (const auto& entry : rays)
        hits += isOcclusion ? scene.accelerator.Occluded(entry.ray)
                            : scene.accelerator.Intersect(entry.ray, &hit);
    return hits;
}

Measurement MeasureScene(const std::string& file) {
    const char* spp = std::getenv("LULL_BENCH_SPP");
    const int samplesPerPixel = spp ? std::max(1, std::atoi(spp)) : 4;
    const auto scene = LoadScene(file, {kSide, kSide});
    RayLog log;
    RenderImage(*scene, samplesPerPixel, &log);

    const RTCScene world = AdmitPackets(*scene);
    Measurement m = {};
    m.samples = size_t(kSide) * kSide * samplesPerPixel;
    m.nearestCount = log.nearest.size();
    m.occlusionCount = log.occlusion.size();
    std::array<std::vector<RecordedRay>, kOrders.size()> nearest, occlusion;
    nearest[0] = log.nearest, nearest[1] = SortByBounce(log.nearest);
    occlusion[0] = log.occlusion, occlusion[1] = SortByBounce(log.occlusion);
    nearest[kFirst] = OnlyFirst(log.nearest), occlusion[kFirst] = OnlyFirst(log.occlusion);
    m.firstNearestCount = nearest[kFirst].size();
    m.firstOcclusionCount = occlusion[kFirst].size();
    for (int round = 0; round < kRounds; ++round) {
        m.render.Measure([&] { return RenderImage(*scene, samplesPerPixel, nullptr), 0; });
        m.sort.Measure([&] {
            nearest[2] = SortSpatially(nearest[1]);
            occlusion[2] = SortSpatially(occlusion[1]);
            return 0;
        });
        for (size_t i = 0; i < kOrders.size(); ++i)
            for (size_t j = 0; j < kWidths.size(); ++j) {
                m.variants[i][j].nearest.Measure([&] {
                    return Trace(*scene, world, nearest[i], false, kWidths[j], i == kFirst);
                });
                m.variants[i][j].occlusion.Measure([&] {
                    return Trace(*scene, world, occlusion[i], true, kWidths[j], i == kFirst);
                });
            }
    }
    return m;
}

// Returns what was measured of the scene, measuring on first use.
const Measurement& MeasurementOf(const std::string& file) {
    static std::map<std::string, Measurement> all;
    const auto found = all.find(file);
    return found != all.end() ? found->second : all.emplace(file, MeasureScene(file)).first->second;
}

void ReportRender(benchmark::State& state, const std::string& file) {
    const Measurement& m = MeasurementOf(file);
    for (auto _ : state) state.SetIterationTime(m.render.seconds);
    state.counters["samples/s"] = double(m.samples) / m.render.seconds;
    state.counters["rays/sample"] = double(m.RayCount()) / double(m.samples);
    state.counters["Mrays/s"] = 1e-6 * double(m.RayCount()) / m.render.seconds;
    state.counters["traversal"] = m.variants[0][0].Seconds() / m.render.seconds;
}

// Reports rays/s of both kinds; "gain" is the speed over that of the same rays one at a time (in
// the order of the paths), without the time of any sorting; "differing" is the share of rays by
// which the number of hits differs from that.
void ReportVariant(benchmark::State& state, const std::string& file, size_t order, size_t width) {
    const Measurement& m = MeasurementOf(file);
    const auto &v = m.variants[order][width], &single = m.variants[order == kFirst ? kFirst : 0][0];
    for (auto _ : state) state.SetIterationTime(v.Seconds());
    const bool isFirst = order == kFirst;
    const auto nearest = double(isFirst ? m.firstNearestCount : m.nearestCount);
    const auto occlusion = double(isFirst ? m.firstOcclusionCount : m.occlusionCount);
    const double hits = double(v.nearest.hits + v.occlusion.hits);
    const double singleHits = double(single.nearest.hits + single.occlusion.hits);
    state.counters["Mrays/s"] = 1e-6 * (nearest + occlusion) / v.Seconds();
    state.counters["nearest"] = 1e-6 * nearest / v.nearest.seconds;
    state.counters["occlusion"] = 1e-6 * occlusion / v.occlusion.seconds;
    state.counters["gain"] = single.Seconds() / v.Seconds();
    state.counters["differing"] = std::abs(hits - singleHits) / (nearest + occlusion);
    if (isFirst)
        state.counters["of render"] =
            m.render.seconds / (m.render.seconds - (single.Seconds() - v.Seconds()));
}

void ReportSort(benchmark::State& state, const std::string& file) {
    const Measurement& m = MeasurementOf(file);
    for (auto _ : state) state.SetIterationTime(m.sort.seconds);
    state.counters["Mrays/s"] = 1e-6 * double(m.RayCount()) / m.sort.seconds;
    state.counters["of render"] = m.sort.seconds / m.render.seconds;
}

int RegisterAll() {
    // The times were taken beforehand, all variants in turn: a benchmark only reports its own.
    auto registerOne = [](const std::string& name, auto report) {
        benchmark::RegisterBenchmark(name.c_str(), report)
            ->UseManualTime()
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    };
    for (const std::string& file : BenchScenes()) {
        const std::string name = std::filesystem::path(file).parent_path().filename();
        registerOne(name + "/render", [=](auto& state) { ReportRender(state, file); });
        for (size_t i = 0; i < kOrders.size(); ++i)
            for (size_t j = 0; j < kWidths.size(); ++j)
                registerOne(fmt::format("{}/{}/{}", name, kOrders[i], kWidths[j]),
                            [=](auto& state) { ReportVariant(state, file, i, j); });
        registerOne(name + "/sorting", [=](auto& state) { ReportSort(state, file); });
    }
    return 0;
}

[[maybe_unused]] const int registered = RegisterAll();

}  // namespace
}  // namespace lull
