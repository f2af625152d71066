// Times Evaluate and Sample of Bsdfs: each lobe alone and common combinations.
#include <benchmark/benchmark.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

struct Case {
    std::string name;
    std::vector<Lobe> lobes;
};

std::vector<Case> Cases() {
    const Rgb c(0.5f, 0.4f, 0.3f);
    const TrowbridgeReitz d(0.2f, 0.2f);
    const Rgb eta(0.2f, 0.92f, 1.1f), k(3.9f, 2.45f, 2.14f);
    return {
        {"none", {}},
        {"LambertianReflection", {LambertianReflection{c}}},
        {"LambertianTransmission", {LambertianTransmission{c}}},
        {"OrenNayar", {OrenNayar(c, 20)}},
        {"DielectricReflection", {DielectricReflection{c, d, {1.5f}}}},
        {"ConductorReflection", {ConductorReflection{c, d, {eta, k}}}},
        {"MicrofacetTransmission", {MicrofacetTransmission{c, d, 1.5f}}},
        {"SpecularReflection", {SpecularReflection<PerfectMirror>{c, {}}}},
        {"SpecularTransmission", {SpecularTransmission{c, 1.5f}}},
        {"FresnelSpecular", {FresnelSpecular{c, c, 1.5f}}},
        {"FresnelBlend", {FresnelBlend{c, c, d}}},
        {"plastic", {LambertianReflection{c}, DielectricReflection{c, d, {1 / 1.5f}}}},
        {"rough_glass", {DielectricReflection{c, d, {1.5f}}, MicrofacetTransmission{c, d, 1.5f}}},
        {"translucent",
         {LambertianReflection{c}, LambertianTransmission{c}, DielectricReflection{c, d, {1.5f}},
          MicrofacetTransmission{c, d, 1.5f}}},
    };
}

// Directions are precomputed; the Bsdf is rotated, as it is in a scene.
constexpr int kDirections = 1024;

struct Inputs {
    Bsdf bsdf = MakeBsdf({});
    std::vector<Vec3f> wo, wi;
    std::vector<Vec2f> u;

    explicit Inputs(const std::vector<Lobe>& lobes) {
        Random random(1);
        Frame frame{{}, {}, random.Direction()};
        CoordinateSystem(frame.n, &frame.s, &frame.t);
        bsdf = Bsdf(frame, frame.n);
        for (const Lobe& lobe : lobes) bsdf.Add(lobe);
        for (int i = 0; i < kDirections; ++i) {
            wo.push_back(random.Direction());
            const Vec3f w = random.Direction();
            wi.push_back(w.dot(frame.n) * wo[i].dot(frame.n) > 0 ? w : Vec3f(-w));
            u.push_back(random.Point());
        }
    }
};

// wi is above the surface with wo: what next-event estimation mostly asks for.
void Evaluate(benchmark::State& state, const std::vector<Lobe>& lobes) {
    const Inputs in(lobes);
    int i = 0;
    for (auto _ : state) {
        i = (i + 1) % kDirections;
        benchmark::DoNotOptimize(in.bsdf.Evaluate(in.wo[i], in.wi[i], LobeSet::NonSpecular));
    }
}

void Sample(benchmark::State& state, const std::vector<Lobe>& lobes) {
    const Inputs in(lobes);
    int i = 0;
    for (auto _ : state) {
        i = (i + 1) % kDirections;
        benchmark::DoNotOptimize(in.bsdf.Sample(in.wo[i], in.u[i], LobeSet::All));
    }
}

void Make(benchmark::State& state, const std::vector<Lobe>& lobes) {
    const Inputs in(lobes);
    for (auto _ : state) {
        Bsdf bsdf(in.bsdf.Shading(), in.wo[0]);
        for (const Lobe& lobe : lobes) bsdf.Add(lobe);
        benchmark::DoNotOptimize(bsdf);
    }
}

const int kRegistered = [] {
    for (const Case& c : Cases()) {
        benchmark::RegisterBenchmark(("Make/" + c.name).c_str(), Make, c.lobes);
        benchmark::RegisterBenchmark(("Evaluate/" + c.name).c_str(), Evaluate, c.lobes);
        benchmark::RegisterBenchmark(("Sample/" + c.name).c_str(), Sample, c.lobes);
    }
    return 0;
}();

}  // namespace
}  // namespace lull::test
