// Makes media, and compares what they transmit, scatter and emit with integrals along a ray.
#pragma once

#include "renderer/scene/media/medium_table.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull::media_test {

inline MediumTable MakeTable(const std::string& kind, std::vector<Parameter> parameters,
                             const Mat4d& place = Mat4d::Identity()) {
    Description description;
    MediumEntity entity;
    entity.name = kind;
    entity.mediumName = "m";
    entity.loc = LocAt(3);
    entity.worldFromMedium = place;
    for (Parameter& p : parameters) entity.parameters.Add(std::move(p));
    description.media.push_back(std::move(entity));
    Warnings warnings;
    MediumTable table(description, warnings);
    EXPECT_EQ(warnings.Total(), 0);
    return table;
}

struct Moments {
    Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = sum;
    int count = 0;

    void Add(const Rgb& v) {
        sum += v.cast<double>();
        squares += v.cast<double>().square();
        ++count;
    }
    void ExpectMean(const Eigen::Array3d& expected) const {
        const Eigen::Array3d mean = sum / count;
        const Eigen::Array3d error = ((squares / count - mean.square()) / count).max(0).sqrt();
        EXPECT_TRUE(((mean - expected).abs() <= 4.5 * error + 1e-5).all())
            << mean.transpose() << " instead of " << expected.transpose();
    }
};

// Both the estimates of transmittance and the rays that pass have the mean exp(-depth); those that
// scatter, and the emission on the way, have the means given. `depth` is that of the ray, by
// channel.
inline void ExpectMeans(const MediumTable& table, const Ray& ray, const Eigen::Array3d& depth,
                        const Eigen::Array3d& expectedScattered,
                        const Eigen::Array3d& expectedEmitted, int count = 200000) {
    Sampler sampler(SamplerKind::Random, 1);
    Moments transmitted, passed, scattered, emitted;
    for (int i = 0; i < count; ++i) {
        sampler.StartSample({0, 0}, uint32_t(i));
        transmitted.Add(table.Transmittance(0, ray, sampler));
        const MediumSample s = table.Sample(0, ray, sampler);
        ASSERT_TRUE((s.weight >= 0).all() && IsFinite(s.weight));
        ASSERT_TRUE(!s.t || (*s.t >= 0 && *s.t <= ray.tMax * 1.00001f));
        passed.Add(s.t ? Rgb(Rgb::Zero()) : s.weight);
        scattered.Add(s.t ? s.weight : Rgb(Rgb::Zero()));
        emitted.Add(s.emitted);
    }
    transmitted.ExpectMean((-depth).exp());
    passed.ExpectMean((-depth).exp());
    scattered.ExpectMean(expectedScattered);
    emitted.ExpectMean(expectedEmitted);
}

// A point of a medium: coefficients per unit of length in the world, and radiance.
struct Point {
    Rgb sigmaA = Rgb::Zero(), sigmaS = Rgb::Zero(), Le = Rgb::Zero();
};

// Expects the integrals along a ray of unit direction, in a medium without transform that is
// `pointAt` in the box from p0 to p1.
template <typename PointAt>
void ExpectIntegrals(const MediumTable& table, const Ray& ray, const Vec3f& p0, const Vec3f& p1,
                     const PointAt& pointAt, int count = 40000) {
    Eigen::Array3d depth = Eigen::Array3d::Zero(), scattered = depth, emitted = depth;
    constexpr int kSteps = 4000;
    const double step = double(ray.tMax) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        const Vec3f p = ray.o + (float(i) + 0.5f) * float(step) * ray.d;
        if ((p.array() < p0.array()).any() || (p.array() > p1.array()).any()) continue;
        const Point at = pointAt(p, Vec3f((p - p0).cwiseQuotient(p1 - p0)));
        const Eigen::Array3d sigmaT = (at.sigmaA + at.sigmaS).cast<double>();
        const Eigen::Array3d through = (-depth - 0.5 * step * sigmaT).exp() * step;
        scattered += through * at.sigmaS.cast<double>();
        emitted += through * (at.sigmaA * at.Le).cast<double>();
        depth += step * sigmaT;
    }
    ASSERT_GT(depth.maxCoeff(), 0.3);
    ExpectMeans(table, ray, depth, scattered, emitted, count);
}

}  // namespace lull::media_test
