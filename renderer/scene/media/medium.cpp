#include "renderer/scene/media/medium.h"

namespace lull {
namespace {

// The part of a ray that is in the unit cube, in grid space; t is that of the world.
struct Crossing {
    Vec3f o, d;
    float tMin = 0, tMax = -1;  // nothing where tMin >= tMax

    Crossing(const Mat4d& gridFromWorld, const Ray& ray)
        : o(TransformPoint(gridFromWorld, ray.o)), d(TransformVector(gridFromWorld, ray.d)) {
        float low = 0, high = ray.tMax;
        for (int i = 0; i < 3; ++i) {
            if (d[i] == 0) {
                if (!(o[i] >= 0 && o[i] <= 1)) return;
                continue;
            }
            const float t0 = -o[i] / d[i], t1 = (1 - o[i]) / d[i];
            low = std::max(low, std::min(t0, t1));
            high = std::min(high, std::max(t0, t1));
        }
        tMin = low;
        tMax = high;
    }
    Vec3f operator()(float t) const { return o + t * d; }
};

// Returns the next collision after t, by a step that is exponentially distributed. Far from the
// ray's origin a step can be shorter than floats are apart; it then goes to the next float, so that
// each way has an end.
float NextCollision(float t, float majorant, Sampler& sampler) {
    const float next = t - std::log1p(-sampler.Get1D()) / majorant;
    return next > t ? next : NextFloatTowards(1, t);
}

// Where colours differ, collisions are those of the greatest extinction, and others weigh in.
MediumSample SampleTinted(const GridMedium& grid, const Crossing& crossing, float majorant,
                          Sampler& sampler) {
    Rgb weight = Rgb::Ones();
    for (float t = crossing.tMin;;) {
        t = NextCollision(t, majorant, sampler);
        if (!(t < crossing.tMax)) return {.weight = weight};
        const float share = std::clamp(grid.Density(crossing(t)) / grid.maxDensity, 0.f, 1.f);
        if (sampler.Get1D() < share) return {.t = t, .weight = weight * grid.albedo};
        weight *= (1 - *grid.tint * share) / (1 - share);
    }
}

}  // namespace

float GridMedium::Density(const Vec3f& p) const {
    Vec3i cell;
    Vec3f f;
    for (int i = 0; i < 3; ++i) {
        const float x = std::clamp(p[i], -1.f, 2.f) * float(size[i]) - 0.5f;
        cell[i] = int(std::floor(x));
        f[i] = x - float(cell[i]);
    }
    float sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3i step(corner & 1, corner >> 1 & 1, corner >> 2);
        const Vec3i c = cell + step;
        if ((c.array() < 0).any() || (c.array() >= size.array()).any()) continue;
        float weight = 1;
        for (int i = 0; i < 3; ++i) weight *= step[i] ? f[i] : 1 - f[i];
        sum += weight * density[(size_t(c.z()) * size.y() + c.y()) * size.x() + c.x()];
    }
    return sum;
}

Rgb GridMedium::Transmittance(const Ray& worldRay, Sampler& sampler) const {
    const float majorant = sigmaT * maxDensity;
    if (!(majorant > 0)) return Rgb::Ones();
    const Crossing crossing(gridFromWorld, worldRay);
    const Rgb shares = tint.value_or(Rgb::Ones());  // of the greatest extinction
    Rgb transmittance = Rgb::Ones();
    for (float t = crossing.tMin;;) {
        t = NextCollision(t, majorant, sampler);
        if (!(t < crossing.tMax)) return transmittance;
        transmittance *= 1 - shares * std::max(0.f, Density(crossing(t)) / maxDensity);
        if (const float most = transmittance.maxCoeff(); most < 0.1f) {
            const float q = std::max(0.05f, 1 - most);
            if (sampler.Get1D() < q) return Rgb::Zero();
            transmittance /= 1 - q;
        }
    }
}

MediumSample GridMedium::Sample(const Ray& worldRay, Sampler& sampler) const {
    const float majorant = sigmaT * maxDensity;
    if (!(majorant > 0)) return {};
    const Crossing crossing(gridFromWorld, worldRay);
    if (tint) return SampleTinted(*this, crossing, majorant, sampler);
    for (float t = crossing.tMin;;) {
        t = NextCollision(t, majorant, sampler);
        if (!(t < crossing.tMax)) return {};
        if (Density(crossing(t)) > sampler.Get1D() * maxDensity) return {.t = t, .weight = albedo};
    }
}

}  // namespace lull
