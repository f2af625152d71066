#include "renderer/scene/lights/light_probes.h"

#include "renderer/base/color.h"
#include "renderer/base/sampling.h"

namespace lull {
namespace {

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
