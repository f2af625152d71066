// Measures whole renders: samples a second, how many cores they had (process time / elapsed time,
// less where others use the machine) and which share of their threads' time went into samples and
// criteria rather than waiting; and the start of each: seconds by phase and the peak of memory, in
// MB, from nothing to a scene that can be rendered. The scenes are those of LULL_BENCH_SCENES
// (files, separated by colons), or our own. LULL_BENCH_SPP sets the samples per pixel of the whole
// images.
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "renderer/input/pbrt_parser.h"
#include "renderer/render/render.h"
#include "renderer/scene/scene.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/bench_scenes.h"

namespace lull {
namespace {

double ProcessSeconds() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

// Returns the most memory that this process has had since ForgetPeak(), in MB (Linux only).
double PeakMegabytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) / 1024;
    return 0;
}
void ForgetPeak() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;
}

// Loads the scene again and again.
void BenchStart(benchmark::State& state, const std::string& file) {
    double parse = 0, textures = 0, shapes = 0, accelerator = 0, peak = 0;
    for (auto _ : state) {
        ForgetPeak();
        Warnings warnings({}, true);
        const auto start = std::chrono::steady_clock::now();
        const Description description = ParsePbrt(file, warnings);
        parse += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        CompileOptions options;
        const auto scene = Compile(description, options, warnings);
        textures += scene->textureSeconds;
        shapes += scene->shapeSeconds;
        accelerator += scene->acceleratorSeconds;
        peak = std::max(peak, PeakMegabytes());
    }
    const auto average = benchmark::Counter::kAvgIterations;
    state.counters["parse_s"] = benchmark::Counter(parse, average);
    state.counters["textures_s"] = benchmark::Counter(textures, average);
    state.counters["shapes_s"] = benchmark::Counter(shapes, average);
    state.counters["accelerator_s"] = benchmark::Counter(accelerator, average);
    state.counters["peak_MB"] = peak;
}

// Renders `region` of the scene again and again.
void RenderRegion(benchmark::State& state, const Scene& scene, Estimator estimator,
                  const PixelRect& region, const ScheduleOptions& schedule) {
    const Rule rule = ParseRule("dammertz:1e-9");
    RenderOptions options;
    options.schedule = schedule;
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.makeCriterion = CriteriaOf(rule);
    int64_t samples = 0;
    double wall = 0, busy = 0;
    const double cpuBefore = ProcessSeconds();
    for (auto _ : state) {
        Film film(region);
        options.source = SamplesOf(scene, estimator);
        options.film = &film;
        const RenderResult result = Render(options);
        samples += result.progress.samples;
        wall += result.progress.seconds;
        for (const BlockResult& block : result.blocks)
            busy += block.seconds + block.criterionSeconds;
    }
    state.counters["samples/s"] = benchmark::Counter(double(samples), benchmark::Counter::kIsRate);
    state.counters["cores"] = (ProcessSeconds() - cpuBefore) / wall;
    state.counters["busy"] = busy / (wall * std::thread::hardware_concurrency());
}

void BenchWhole(benchmark::State& state, const std::string& file, Estimator estimator) {
    const auto scene = LoadScene(file, {400, 400});
    const char* spp = std::getenv("LULL_BENCH_SPP");
    RenderRegion(state, *scene, estimator, {{0, 0}, {400, 400}},
                 {.cap = spp ? std::max(1, std::atoi(spp)) : 4});
}

// Renders one block, as when all others have stopped: passes of 20 spp, one after another, each
// looked at by a criterion. The argument is the side of the tiles.
void BenchLastBlock(benchmark::State& state, const std::string& file) {
    const auto scene = LoadScene(file, {800, 800});
    RenderRegion(state, *scene, Estimator::Combined, {{200, 400}, {400, 600}},
                 {.cap = 60, .tileSize = int(state.range(0))});
}

int RegisterAll() {
    auto registerOne = [](const std::string& name, auto bench) {
        return benchmark::RegisterBenchmark(name.c_str(), bench)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    };
    for (const std::string& file : BenchScenes()) {
        const std::filesystem::path path(file);
        const std::string name = path.parent_path().filename() / path.stem();
        registerOne(name + "/start", [file](benchmark::State& state) { BenchStart(state, file); });
        registerOne(name + "/combined", [file](benchmark::State& state) {
            BenchWhole(state, file, Estimator::Combined);
        });
        registerOne(name + "/pbrt-v3", [file](benchmark::State& state) {
            BenchWhole(state, file, Estimator::PbrtV3);
        });
        registerOne(name + "/last-block/tile",
                    [file](benchmark::State& state) { BenchLastBlock(state, file); })
            ->Arg(8)
            ->Arg(16)
            ->Arg(32);
    }
    return 0;
}

[[maybe_unused]] const int registered = RegisterAll();

}  // namespace
}  // namespace lull
