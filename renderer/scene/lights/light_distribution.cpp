#include "renderer/scene/lights/light_distribution.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "renderer/base/math.h"
#include "renderer/base/sampling.h"

namespace lull {
namespace {

// Turns weights into running sums of probabilities that end at exactly 1. Weights without a
// positive finite sum give the uniform choice.
std::vector<float> Normalized(std::vector<float> weights) {
    double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(total > 0) || !std::isfinite(total)) {
        std::fill(weights.begin(), weights.end(), 1.f);
        total = double(weights.size());
    }
    double running = 0;
    for (float& w : weights) {
        running += w;
        w = std::min(float(running / total), 1.f);
    }
    // Lights of weight 0 at the end share the last sum, so that they are never chosen.
    const float last = weights.back();
    for (auto w = weights.rbegin(); w != weights.rend() && *w == last; ++w) *w = 1;
    return weights;
}

using Numbers = LightProbes::Numbers;
using Places = LightProbes::Places;

// Return the sum for a shape of luminance 1, where that is known without samples, or where they are
// so simple that all are taken at once; a negative number elsewhere.
float SumOver(const EmittingTriangle& triangle, bool twoSided, const LightProbes& probes,
              const Places& places) {
    const Numbers b2 = 1 - probes.b0 - probes.b1;
    Numbers cosine = Numbers::Zero(), distance2 = Numbers::Zero();  // the cosine times the distance
    for (int i = 0; i < 3; ++i) {
        const Numbers d = places.col(i) - probes.b0 * triangle.p0[i] - probes.b1 * triangle.p1[i] -
                          b2 * triangle.p2[i];
        cosine += triangle.n[i] * d;
        distance2 += d.square();
    }
    if (twoSided) cosine = cosine.abs();
    const Numbers pdf = triangle.areaPdf * distance2 * distance2.sqrt() / cosine;
    Numbers contributions;
    for (int k = 0; k < LightProbes::kCount; ++k) contributions[k] = pdf[k] > 0 ? 1 / pdf[k] : 0;
    return contributions.sum();
}

// From outside, all samples are as likely: by the cone that the sphere subtends.
float SumOver(const Sphere* sphere, bool twoSided, const LightProbes&, const Places& places) {
    const Vec3f center = sphere->place.worldFromShape.topRightCorner<3, 1>().cast<float>();
    Numbers distance2 = Numbers::Zero();
    for (int i = 0; i < 3; ++i) distance2 += (places.col(i) - center[i]).square();
    const Numbers sin2 = Sqr(sphere->radius) / distance2;
    if (!(sin2.maxCoeff() < 1)) return -1;
    if (sphere->place.reverseOrientation && !twoSided) return 0;
    return 2 * kPi * (sin2 / (1 + (1 - sin2).sqrt())).sum();
}

template <typename E>
float SumOver(const E&, bool, const LightProbes&, const Places&) {
    return -1;
}

float SumAtOnce(const AreaLight& light, const LightProbes& probes, const Places& places) {
    if (light.map || light.profile) return -1;
    return Luminance(light.L) * Visit(light.surface, [&](const auto& emitter) {
               return SumOver(emitter, light.twoSided, probes, places);
           });
}
template <typename L>
float SumAtOnce(const L&, const LightProbes&, const Places&) {
    return -1;
}

Rgb RadianceOf(const InfiniteLight& light, const LightSample& sample) {
    return sample.isOnMap ? light.Radiance(sample) : sample.L;
}
template <typename L>
Rgb RadianceOf(const L&, const LightSample& sample) {
    return sample.L;
}

}  // namespace

VoxelGrid::VoxelGrid(const Bounds3f& bounds, int most) : bounds(bounds) {
    const Vec3f diagonal = bounds.Diagonal();
    const float longest = std::max(diagonal.maxCoeff(), std::numeric_limits<float>::min());
    for (int i = 0; i < 3; ++i) {
        resolution[i] = std::max(1, int(std::round(diagonal[i] / longest * float(most))));
        voxelsPerUnit[i] = diagonal[i] > 0 ? resolution[i] / diagonal[i] : 0;
    }
}

Bounds3f VoxelGrid::BoundsOf(size_t voxel) const {
    const Vec3i v(int(voxel % resolution.x()), int(voxel / resolution.x() % resolution.y()),
                  int(voxel / resolution.x() / resolution.y()));
    const Vec3f size = bounds.Diagonal().cwiseQuotient(resolution.cast<float>());
    const Vec3f lower = bounds.lower + size.cwiseProduct(v.cast<float>());
    return {lower, lower + size};
}

LightDistribution::LightDistribution(std::span<const float> weights)
    : lightCount(int(weights.size())) {
    AllocateTables();
    const std::vector<float> sums = Normalized({weights.begin(), weights.end()});
    std::copy(sums.begin(), sums.end(), tables);
}

LightDistribution::LightDistribution(int count, const Bounds3f& bounds) : lightCount(count) {
    // Take fewer voxels where there are so many lights that the tables could not even be addressed.
    constexpr double kMaxEntries = double(1ull << 31);
    for (int most = kMaxVoxels; most >= 1; most /= 2) {
        grid = VoxelGrid(bounds, most);
        if (double(grid.Count()) * count <= kMaxEntries) break;
    }
    probes = std::make_unique<const LightProbes>();
    AllocateTables();
}

void LightDistribution::AllocateTables() {
    memory = LazyZeros(grid.Count() * lightCount * sizeof(float));
    tables = static_cast<float*>(memory.Data());
}

std::vector<float> LightDistribution::RunningSums(std::vector<float> contributions) const {
    // Leave every light some probability: the points may all have missed where it shines.
    const float sum = std::accumulate(contributions.begin(), contributions.end(), 0.f);
    const float average = sum / (float(LightProbes::kCount) * lightCount);
    const float least = average > 0 ? 0.001f * average : 1.f;
    for (float& c : contributions) c = std::max(c, least);
    return Normalized(std::move(contributions));
}

LightProbes::LightProbes() {
    for (int i = 0; i < kCount; ++i) {
        unit.row(i) << RadicalInverse(2, i), RadicalInverse(3, i), RadicalInverse(5, i);
        u[i] = {RadicalInverse(7, i), RadicalInverse(11, i)};
        const Vec2f b = SampleUniformTriangle(u[i]);
        b0[i] = b.x();
        b1[i] = b.y();
    }
}

LightProbes::Places LightProbes::PlacesIn(const Bounds3f& voxel) const {
    const Vec3f size = voxel.Diagonal();
    Places places;
    for (int i = 0; i < 3; ++i) places.col(i) = voxel.lower[i] + size[i] * unit.col(i);
    return places;
}

float Contribution(const Light& light, const LightProbes& probes, const Places& places) {
    return Visit(light, [&](const auto& l) {
        float sum = SumAtOnce(l, probes, places);
        if (sum >= 0) return sum;
        sum = 0;
        for (int k = 0; k < LightProbes::kCount; ++k) {
            const Vec3f p(places(k, 0), places(k, 1), places(k, 2));
            if (const auto sample = l.Sample(p, probes.u[k]))
                sum += Luminance(RadianceOf(l, *sample)) / sample->pdf;
        }
        return sum;
    });
}

}  // namespace lull
