// Measures what guiding paths does, scene by scene, in runs that alternate: "noise" is the mean
// squared error in lightness of images of 16 spp, guided over unguided; "seconds" is what a sample
// takes of a processor; "cost" is the product, the time to the same noise. "recording" is what a
// sample takes of which paths are guided and recorded, over one that is guided alone. The scenes
// are those of LULL_BENCH_SCENES (files, separated by colons), or our own, with LULL_BENCH_SIDE
// (64) pixels a side; the guide has learned from an image of LULL_BENCH_SPP (252) spp.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "renderer/base/clocks.h"
#include "renderer/base/color.h"
#include "renderer/learning/learners.h"
#include "renderer/render/render.h"
#include "tests/renderer/bench_scenes.h"

namespace lull {
namespace {

constexpr int kSpp = 16, kImages = 4;

int FromEnvironment(const char* name, int otherwise) {
    const char* value = std::getenv(name);
    return value ? std::max(1, std::atoi(value)) : otherwise;
}

double Lightness(double y) {
    return y > 1 ? 100 : y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * std::max(0., y);
}

// Sums up images that differ in nothing but their seed.
struct Images {
    std::vector<double> sums, squares;  // of the lightness of each pixel
    double seconds = 0;

    void Add(const SampleSource& source, int side, uint64_t seed) {
        sums.resize(size_t(side) * size_t(side));
        squares.resize(sums.size());
        const double start = ThreadSeconds();
        Sampler sampler(SamplerKind::Random, seed);
        for (size_t i = 0; i < sums.size(); ++i) {
            Rgb sum = Rgb::Zero();
            for (uint32_t k = 0; k < kSpp; ++k)
                sum += source(sampler, {int(i) % side, int(i) / side}, k, {}).radiance;
            const double lightness = Lightness(double(Luminance(sum)) / kSpp);
            sums[i] += lightness;
            squares[i] += Sqr(lightness);
        }
        seconds += ThreadSeconds() - start;
    }
    double Noise() const {
        double noise = 0;
        for (size_t i = 0; i < sums.size(); ++i) noise += squares[i] - Sqr(sums[i]) / kImages;
        return noise;
    }
};

void BenchGuide(benchmark::State& state, const std::string& file) {
    const int side = FromEnvironment("LULL_BENCH_SIDE", 64);
    const auto scene = LoadScene(file, {side, side});
    if (const auto why = WhyNotGuided(*scene, Estimator::Combined))
        return state.SkipWithError(why->c_str());
    const PixelRect region{{0, 0}, {side, side}};
    for (auto _ : state) {
        Learners learner(*scene, {.megabytes = FromEnvironment("LULL_BENCH_MEMORY", 64)},
                         region.Area());
        RenderOptions render;
        render.schedule.cap = FromEnvironment("LULL_BENCH_SPP", 252);
        render.sampler = SamplerKind::Random;
        Film film(region, {.grid = GridOf(render.schedule)});
        Render({.source = SamplesOf(*scene, learner), .film = &film, .learners = &learner}, render);
        Images plain, guided, recorded;
        const PathOptions records = learner.Paths();
        for (uint64_t i = 0; i < kImages; ++i) {
            plain.Add(SamplesOf(*scene, Estimator::Combined), side, 1 + i);
            guided.Add(SamplesOf(*scene, *records.guide), side, 1 + i);
            recorded.Add(SamplesOf(*scene, records), side, 1 + i);
        }
        const double noise = guided.Noise() / plain.Noise(),
                     seconds = guided.seconds / plain.seconds;
        state.counters["noise"] = noise;
        state.counters["seconds"] = seconds;
        state.counters["cost"] = noise * seconds;
        state.counters["recording"] = recorded.seconds / guided.seconds;
    }
}

int RegisterAll() {
    for (const std::string& file : BenchScenes()) {
        const std::filesystem::path path(file);
        const std::string name = path.parent_path().filename() / path.stem();
        benchmark::RegisterBenchmark(name.c_str(),
                                     [file](benchmark::State& state) { BenchGuide(state, file); })
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    }
    return 0;
}

const int kRegistered = RegisterAll();

}  // namespace
}  // namespace lull
