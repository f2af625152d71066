// Random tests of what every path is made of; a failure names the seed of its trial.
#include <fmt/format.h>

#include <cmath>

#include "renderer/base/sampling.h"
#include "renderer/scene/geometry/shapes/mesh.h"
#include "renderer/scene/geometry/shapes/quadric.h"
#include "tests/hard_cases/known_scene.h"
#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {

namespace {

using test::Random;

// Runs `fails` on trials that differ in nothing but the seed of their random numbers.
template <typename Trial>
HardCaseResult RunTrials(int count, const HardCaseOptions& options, const Trial& fails) {
    Failures failures;
    for (int i = 0; i < (options.isLong ? 100 * count : count); ++i) {
        const uint64_t seed = options.seed + uint64_t(i);
        Random random(seed);
        failures.Note(fails(&random), [&] { return fmt::format("seed {}", seed); });
    }
    return failures.Result("trials");
}

// Triangles of any size and shape, anywhere: rays that leave a hit do not meet the triangle again.
HardCaseResult Reintersection(const HardCaseOptions& options) {
    return RunTrials(1000, options, [](Random* random) {
        const double scale = std::pow(10.0, 10 * random->Float() - 4);
        const Vec3f offset =
            float(scale * std::pow(10.0, 5 * random->Float() - 2)) * random->Direction();
        Vec3f p[3];
        std::string points;
        for (Vec3f& v : p) {
            v = offset + float(scale * std::pow(10.0, -3 * random->Float())) * random->Direction();
            points += fmt::format("{:.9g} {:.9g} {:.9g} ", v.x(), v.y(), v.z());
        }
        const auto scene = MakeScene({.world = MeshText("0 1 2", points)});
        for (int i = 0; i < 20; ++i) {
            const Vec2f b = SampleUniformTriangle(random->Point());
            const Vec3f target = b.x() * p[0] + b.y() * p[1] + (1 - b.x() - b.y()) * p[2];
            const Vec3f d = random->Direction();
            const Ray ray{target - d * float(scale * 3), d, kInfinity};
            Hit hit;
            if (!scene->accelerator.Intersect(ray, &hit)) continue;
            SurfaceInteraction at;
            scene->shapes.Interact(ray, hit, kNeedsNothing, &at);
            for (int j = 0; j < 20; ++j) {
                Vec3f w = random->Direction();
                if (j % 4 == 0) w = (w - w.dot(at.n) * at.n + 1e-5f * w).normalized();
                Hit again;
                if (scene->accelerator.Intersect(at.SpawnRay(w), &again)) return true;
            }
        }
        return false;
    });
}

// What BSDFs sample has the density that they say and carries at most what is there.
HardCaseResult Bsdfs(const HardCaseOptions& options) {
    std::vector<test::NamedLobe> lobes = test::SpreadLobes();
    for (const test::NamedLobe& specular : test::SpecularLobes()) lobes.push_back(specular);
    return RunTrials(200'000, options, [&](Random* random) {
        const Bsdf bsdf = test::MakeBsdf({lobes[size_t(random->Below(int(lobes.size())))].lobe});
        Vec3f wo = random->Direction();
        if (random->Below(4) == 0) {
            wo.z() *= 1e-6f;
            wo.normalize();
        }
        const auto s = bsdf.Sample(wo, random->Point(), LobeSet::All);
        if (!s) return false;
        const bool sound = IsFinite(s->f) && s->f.minCoeff() >= 0 && s->pdf > 0 &&
                           std::isfinite(s->pdf) && std::abs(s->wi.norm() - 1) < 1e-5f;
        if (!sound || s->isSpecular) return !sound;
        const BsdfValue v = bsdf.Evaluate(wo, s->wi, LobeSet::All);
        return !(std::abs(v.pdf - s->pdf) <= 1e-3f * s->pdf);
    });
}

// Points chosen on spheres, disks and triangles have the density that is computed for them.
HardCaseResult Shapes(const HardCaseOptions& options) {
    return RunTrials(100'000, options, [](Random* random) {
        const float scale = std::pow(10.f, 8 * random->Float() - 4);
        const Vec3f from = scale * std::pow(10.f, 3 * random->Float() - 1) * random->Direction();
        Sphere sphere;
        sphere.radius = sphere.zMax = scale * (0.01f + random->Float());
        sphere.zMin = -sphere.radius;
        const auto s = Sample(sphere, from, random->Point());
        if (!s) return false;
        const float pdf = Pdf(sphere, from, s->p, s->n);
        return !(std::isfinite(s->pdf) && std::abs(pdf - s->pdf) <= 1e-3f * s->pdf &&
                 std::abs(s->n.norm() - 1) < 1e-4f && s->p.allFinite());
    });
}

// Warps stay in their domains for all numbers that samplers can give, both ends included.
HardCaseResult Warps(const HardCaseOptions& options) {
    return RunTrials(300'000, options, [](Random* random) {
        const auto number = [&] {
            const float ends[] = {0, 0x1p-24f, 0.5f, kOneMinusEpsilon};
            const int i = random->Below(8);
            return i < 4 ? ends[i] : random->Float();
        };
        const Vec2f u(number(), number());
        const Vec3f sphere = SampleUniformSphere(u), hemisphere = SampleCosineHemisphere(u);
        const Vec2f disk = SampleConcentricDisk(u), triangle = SampleUniformTriangle(u);
        return !(std::abs(sphere.norm() - 1) < 1e-6f && std::abs(hemisphere.norm() - 1) < 1e-3f &&
                 hemisphere.z() >= 0 && disk.norm() < 1 + 1e-6f && triangle.minCoeff() >= 0 &&
                 triangle.sum() <= 1 + 1e-6f);
    });
}

// Tables of probabilities over 76 orders of magnitude: zeros are never chosen, what is chosen has
// the probability that is said, and all add up to 1.
HardCaseResult Distributions(const HardCaseOptions& options) {
    return RunTrials(20'000, options, [](Random* random) {
        std::vector<float> values(size_t(1 + random->Below(200)));
        for (float& v : values)
            v = random->Below(3) == 0 ? 0 : std::pow(10.f, 76 * random->Float() - 38);
        const Distribution1D table(values);
        bool allZero = true;
        double sum = 0;
        for (int i = 0; i < table.Count(); ++i) {
            allZero &= values[size_t(i)] == 0;
            sum += table.Pmf(i);
        }
        if (!(std::abs(sum - 1) < 1e-5)) return true;
        for (int k = 0; k < 20; ++k) {
            float pmf;
            const int i = table.SampleDiscrete(random->Float(), &pmf);
            if (!(pmf > 0) || pmf != table.Pmf(i)) return true;
            if (!allZero && values[size_t(i)] == 0) return true;
        }
        return false;
    });
}

}  // namespace

std::vector<HardCase> RandomCases() {
    return {
        {"random tests", "rays from random triangles, sizes 1e-7 to 1e6, far off",
         "a ray hits the triangle it starts on", Reintersection},
        {"random tests", "BSDF samples, a quarter of them at 1e-6 to the surface",
         "densities that do not belong to the samples", Bsdfs},
        {"random tests", "points on spheres, sizes 1e-6 to 1e4", "densities of tiny cones", Shapes},
        {"random tests", "warps of the unit square, edges included", "points outside by rounding",
         Warps},
        {"random tests", "tables of probabilities over 76 orders of magnitude",
         "elements that cannot be chosen are", Distributions}};
}

}  // namespace lull
