// Measures the cost of a decision on a block of 200x200 pixels. A pass of 20 spp over it takes
// about a second on one core, so that 10 ms are 1 %.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "stopping/rules/baselines.h"
#include "stopping/rules/learned.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

const BlockImage& TestBlock() {
    static const BlockImage block = NoisyBlock(200, 200, 0.3, 20, 1);
    return block;
}

void DisplayLightness(benchmark::State& state) {
    std::vector<uint8_t> srgb(TestBlock().mean.size());
    std::vector<double> lightness(srgb.size() / 3);
    for (auto _ : state) {
        EncodeSrgb8(TestBlock().mean, srgb);
        Lightness(srgb, lightness);
        benchmark::DoNotOptimize(lightness.data());
    }
}
BENCHMARK(DisplayLightness)->Unit(benchmark::kMillisecond);

void EntropyFeature(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(MeasureBlock(TestBlock().At(20), {.m = int(state.range(0))}));
}
BENCHMARK(EntropyFeature)->Arg(4)->Arg(25)->Arg(100)->Arg(400)->Unit(benchmark::kMillisecond);

void NoiseInLightness(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(
            SubBlockStatistics(ComputeLightnessNoise(TestBlock().At(20)), 200, 200, 100));
}
BENCHMARK(NoiseInLightness)->Unit(benchmark::kMillisecond);

void PaperNetwork(benchmark::State& state) {
    const Network network = RandomNetwork(100, {512, 128, 32}, 0.1f);
    const Eigen::MatrixXf window = Eigen::MatrixXf::Random(100, 8).cwiseAbs();
    for (auto _ : state) benchmark::DoNotOptimize(NoisyProbability(network, window));
}
BENCHMARK(PaperNetwork)->Unit(benchmark::kMillisecond);

// Observes passes one after the other, with every window full after the first few.
void Observe(benchmark::State& state, Criterion* criterion) {
    int spp = 0;
    for (auto _ : state) benchmark::DoNotOptimize(criterion->Observe(TestBlock().At(spp += 20)));
}
void LearnedPass(benchmark::State& state) {
    const auto model =
        std::make_shared<const Model>(Model{RandomNetwork(100, {512, 128, 32}, 0.1f), {}, ""});
    Observe(state, MakeCriterion(LearnedRule(model, 20)).get());
}
BENCHMARK(LearnedPass)->Unit(benchmark::kMillisecond);
void DammertzPass(benchmark::State& state) {
    Observe(state, MakeCriterion(DammertzRule(1e-9)).get());
}
BENCHMARK(DammertzPass)->Unit(benchmark::kMillisecond);
void CyclesPass(benchmark::State& state) { Observe(state, MakeCriterion(CyclesRule(0.01)).get()); }
BENCHMARK(CyclesPass)->Unit(benchmark::kMillisecond);
void LuxTilePass(benchmark::State& state) {
    Observe(state, MakeCriterion(LuxTileRule(1e-9)).get());
}
BENCHMARK(LuxTilePass)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lull
