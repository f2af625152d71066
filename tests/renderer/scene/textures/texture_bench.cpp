// Measures texture look-ups in nanoseconds: "coherent" walks along a row as camera rays do,
// "random" jumps as bounces do.
#include <benchmark/benchmark.h>

#include <random>

#include "renderer/image/image_io.h"
#include "renderer/scene/textures/imagemap.h"
#include "renderer/scene/textures/noise.h"
#include "renderer/scene/textures/patterns.h"

namespace lull {
namespace {

std::vector<TextureContext> MakePoints(bool random) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> uniform;
    std::vector<TextureContext> points(1 << 16);
    for (size_t i = 0; i < points.size(); ++i) {
        points[i].uv = random ? Vec2f(uniform(generator), uniform(generator))
                              : Vec2f(float(i) * 1e-4f, 0.3f + float(i) * 1e-6f);
        points[i].p = 10 * Vec3f(points[i].uv.x(), points[i].uv.y(), 0.5f);
    }
    return points;
}

template <typename Texture>
void Measure(benchmark::State& state, const Texture& texture, bool random) {
    const TextureTable table;
    const auto points = MakePoints(random);
    size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(Evaluate(texture, table, points[i]));
        i = (i + 1) & (points.size() - 1);
    }
}

template <typename Stored, typename Value>
void BM_Image(benchmark::State& state) {
    const int size = int(state.range(0));
    const Wrap wrap = Wrap(state.range(2));
    constexpr int channels = std::is_same_v<Value, float> ? 1 : 3;
    std::vector<Stored> texels(size_t(size) * size_t(size) * channels);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = Stored(float(i * 7919 % 251));
    const Image image{size, size, channels, texels};
    const auto stored = std::make_shared<const TextureImage>(
        MakeTextureImage(image, std::is_same_v<Stored, uint8_t> ? kSrgb : 1,
                         channels == 1 ? TextureChannels::Luminance : TextureChannels::Rgb));
    Measure(state, ImageMap<Value>{UvMapping{}, stored, 1, wrap, wrap}, state.range(1));
}

void ImageArguments(benchmark::internal::Benchmark* b) {
    b->ArgNames({"size", "random", "wrap"});
    for (int size : {256, 4096})
        for (int random : {0, 1}) b->Args({size, random, int(Wrap::Repeat)});
    b->Args({256, 1, int(Wrap::Black)});
}
BENCHMARK(BM_Image<uint8_t, Rgb>)->Apply(ImageArguments);
BENCHMARK(BM_Image<Half, Rgb>)->Apply(ImageArguments);
BENCHMARK(BM_Image<float, Rgb>)->Apply(ImageArguments);
BENCHMARK(BM_Image<uint8_t, float>)->Apply(ImageArguments);

void BM_SphericalMapping(benchmark::State& state) {
    const auto points = MakePoints(true);
    const Mapping2D mapping = SphericalMapping{Eigen::Matrix4f::Identity()};
    size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(Map(mapping, points[i]));
        i = (i + 1) & (points.size() - 1);
    }
}
BENCHMARK(BM_SphericalMapping);

void BM_Checkerboard(benchmark::State& state) {
    Measure(state, Checkerboard<float>{Mapping2D(UvMapping{{16, 16}, {0, 0}}), {1}, {0}}, true);
}
BENCHMARK(BM_Checkerboard);

void BM_Fbm(benchmark::State& state) {
    Measure(state, Fbm<float>{Mapping3D{}, 0.5f, int(state.range(0))}, true);
}
BENCHMARK(BM_Fbm)->Arg(1)->Arg(8);

void BM_Marble(benchmark::State& state) {
    Measure(state, Marble{Mapping3D{}, 0.5f, 8, 1, 0.2f}, true);
}
BENCHMARK(BM_Marble);

}  // namespace
}  // namespace lull
