// Measures what guiding paths does, scene by scene, in runs that alternate: "noise" is the mean
// squared error in lightness of images of 16 spp, guided over unguided; "seconds" is what a sample
// takes of a processor; "cost" is the product, the time to the same noise. "trial" and "vertices"
// are what --guide auto sees, "learned" the spp that went into that. The scenes are those of
// LULL_BENCH_SCENES (files, separated by colons), or our own, with LULL_BENCH_SIDE (64) pixels a
// side; learning may take a quarter of LULL_BENCH_CAP (1000) spp.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "renderer/base/color.h"
#include "renderer/base/thread_clock.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/render/guide_learning.h"
#include "renderer/render/guide_trial.h"
#include "renderer/scene/compile.h"
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
                sum += source(sampler, {int(i) % side, int(i) / side}, k).radiance;
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
    Warnings warnings;
    const int side = FromEnvironment("LULL_BENCH_SIDE", 64);
    CompileOptions options;
    options.substitute = true;
    options.film.resolution = Vec2i(side, side);
    const auto scene = Compile(ParsePbrt(file, warnings), options, warnings);
    if (const auto why = WhyNotGuided(*scene, Estimator::Combined))
        return state.SkipWithError(why->c_str());
    LearningOptions learningOptions;
    learningOptions.sampler = SamplerKind::Random;
    learningOptions.cap = FromEnvironment("LULL_BENCH_CAP", 1000);
    learningOptions.megabytes = FromEnvironment("LULL_BENCH_MEMORY", learningOptions.megabytes);
    for (auto _ : state) {
        Learning learning;
        const PixelRect region{{0, 0}, {side, side}};
        Learn(*scene, region, learningOptions, &learning);
        Images plain, guided;
        for (uint64_t i = 0; i < kImages; ++i) {
            plain.Add(SamplesOf(*scene, Estimator::Combined), side, 1 + i);
            guided.Add(SamplesOf(*scene, learning.guide), side, 1 + i);
        }
        const auto trial = TryGuide(*scene, region, learning.guide, {});
        const double noise = guided.Noise() / plain.Noise(),
                     seconds = guided.seconds / plain.seconds;
        state.counters["noise"] = noise;
        state.counters["seconds"] = seconds;
        state.counters["cost"] = noise * seconds;
        state.counters["trial"] = trial->variance;
        state.counters["vertices"] = trial->vertices;
        state.counters["learned"] = learning.figures.samples;
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
