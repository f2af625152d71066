#include "renderer/scene/media/medium.h"

#include "renderer/base/variant.h"

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

// Tentative collisions along a ray, at intervals that are exponentially distributed.

// Returns the next collision after t. Far from the ray's origin a step can be shorter than floats
// are apart; it then goes to the next float, so that each way has an end.
float NextCollision(float t, float depth, float majorant) {
    const float next = t + depth / majorant;
    return next > t ? next : NextFloatTowards(1, t);
}

float SampleDepth(Sampler& sampler) { return -std::log1p(-sampler.Get1D()); }

// By the greatest density of all.
class EvenSteps {
  public:
    template <typename Density>
    EvenSteps(const GridMedium& medium, const Density&, const Crossing& crossing)
        : maxDensity(medium.maxDensity),
          majorant(medium.sigmaT * medium.maxDensity),
          tMax(crossing.tMax) {}

    // Goes on to the next collision. Returns false where there is none.
    bool Next(float* t, Sampler& sampler) {
        *t = NextCollision(*t, SampleDepth(sampler), majorant);
        return *t < tMax;
    }

    const float maxDensity;

  private:
    const float majorant, tMax;
};

// By that of each brick, from one to the next.
class BrickSteps {
  public:
    BrickSteps(const GridMedium& medium, const SparseGrid& grid, const Crossing& crossing)
        : grid(grid),
          sigmaT(medium.sigmaT),
          tMax(crossing.tMax),
          o(grid.scale * crossing.o + grid.offset),
          d(grid.scale * crossing.d) {
        const Vec3f start = (o + crossing.tMin * d) / SparseGrid::kSide;
        for (int i = 0; i < 3; ++i)
            brick[i] = int(std::clamp(start[i], 0.f, float(grid.size[i] - 1)));
        Enter();
    }

    bool Next(float* t, Sampler& sampler) {
        for (float depth = SampleDepth(sampler); *t < tMax;) {
            const float majorant = sigmaT * maxDensity;
            if (majorant > 0) {
                const float next = NextCollision(*t, depth, majorant);
                if (next < end) {
                    *t = next;
                    return true;
                }
                depth = std::max(0.f, depth - (end - *t) * majorant);
            }
            *t = std::max(*t, end);
            if (axis < 0) return false;
            brick[axis] += d[axis] > 0 ? 1 : -1;
            if (brick[axis] < 0 || brick[axis] >= grid.size[axis]) return false;
            Enter();
        }
        return false;
    }

    float maxDensity;

  private:
    void Enter() {
        end = tMax;
        axis = -1;
        for (int i = 0; i < 3; ++i) {
            const int side = SparseGrid::kSide * (brick[i] + (d[i] > 0));
            if (const float t = (float(side) - o[i]) / d[i]; d[i] != 0 && t < end) {
                end = t;
                axis = i;
            }
        }
        maxDensity = grid.At(brick).most;
    }

    const SparseGrid& grid;
    const float sigmaT, tMax;
    const Vec3f o, d;  // the ray in voxels
    Vec3i brick;
    float end;  // of the way in the brick
    int axis;   // across which the ray leaves it; -1: it ends there
};

template <typename Density>
using StepsOf = std::conditional_t<std::is_same_v<Density, SparseGrid>, BrickSteps, EvenSteps>;

// What is at a point: the greatest extinction of all channels over the medium's, and by channel
// shares of it.
struct Properties {
    float density;
    Rgb extinction, scattering, absorption;
};

template <typename Density>
Properties PropertiesAt(const GridMedium& m, const Density& density, const Vec3f& p) {
    return {density(p), m.tint.value_or(Rgb::Ones()), m.albedo, m.absorption};
}

Properties PropertiesAt(const GridMedium&, const RgbDensity& density, const Vec3f& p) {
    const Rgb other = Rgb::Constant(density.otherwise);
    const Rgb sigmaA = density.sigmaA ? (*density.sigmaA)(p) : other;
    const Rgb sigmaS = density.sigmaS ? (*density.sigmaS)(p) : other;
    const Rgb sigmaT = sigmaA + sigmaS;
    const float most = sigmaT.maxCoeff();
    if (!(most > 0)) return {0, Rgb::Zero(), Rgb::Zero(), Rgb::Zero()};
    return {most, sigmaT / most, sigmaS / most, sigmaA / most};
}

// Where colours differ, collisions are by the mean extinction, so that each channel can pass.
template <typename Density>
MediumSample SampleTinted(const GridMedium& medium, const Density& density,
                          const Crossing& crossing, Sampler& sampler) {
    MediumSample sample;
    StepsOf<Density> steps(medium, density, crossing);
    for (float t = crossing.tMin; steps.Next(&t, sampler);) {
        const Vec3f p = crossing(t);
        const Properties at = PropertiesAt(medium, density, p);
        const float share = std::clamp(at.density / steps.maxDensity, 0.f, 1.f);
        if (medium.emission)
            sample.emitted += sample.weight * at.absorption * share * (*medium.emission)(p);
        const float mean = at.extinction.mean(), q = share * mean;
        if (sampler.Get1D() < q) {
            sample.t = t;
            sample.weight *= at.scattering / mean;
            break;
        }
        sample.weight *= (1 - at.extinction * share) / (1 - q);
    }
    return sample;
}

}  // namespace

Rgb MediumEmission::operator()(const Vec3f& p) const {
    Rgb L = Le;
    if (scale) L *= (*scale)(p);
    if (color) L *= (*color)(p);
    if (temperatures) L *= (*temperatures)(p);
    return L;
}

Rgb GridMedium::Transmittance(const Ray& worldRay, Sampler& sampler) const {
    if (!(sigmaT * maxDensity > 0)) return Rgb::Ones();
    const Crossing crossing(gridFromWorld, worldRay);
    return Visit(density, [&]<typename Density>(const Density& field) {
        StepsOf<Density> steps(*this, field, crossing);
        Rgb transmittance = Rgb::Ones();
        for (float t = crossing.tMin; steps.Next(&t, sampler);) {
            const Properties at = PropertiesAt(*this, field, crossing(t));
            transmittance *= 1 - at.extinction * std::max(0.f, at.density / steps.maxDensity);
            if (const float most = transmittance.maxCoeff(); most < 0.1f) {
                const float q = std::max(0.05f, 1 - most);
                if (sampler.Get1D() < q) return Rgb(Rgb::Zero());
                transmittance /= 1 - q;
            }
        }
        return transmittance;
    });
}

MediumSample GridMedium::Sample(const Ray& worldRay, Sampler& sampler) const {
    if (!(sigmaT * maxDensity > 0)) return {};
    const Crossing crossing(gridFromWorld, worldRay);
    return Visit(density, [&]<typename Density>(const Density& field) {
        if constexpr (!std::is_same_v<Density, RgbDensity>)
            if (!tint && !emission) {
                StepsOf<Density> steps(*this, field, crossing);
                for (float t = crossing.tMin; steps.Next(&t, sampler);)
                    if (field(crossing(t)) > sampler.Get1D() * steps.maxDensity)
                        return MediumSample{.t = t, .weight = albedo};
                return MediumSample{};
            }
        return SampleTinted(*this, field, crossing, sampler);
    });
}

}  // namespace lull
