#include "renderer/transport/subsurface.h"

#include "renderer/bsdf/fresnel.h"

namespace lull {
namespace {

// Chosen half of the time is the probe along the normal, which finds most.
constexpr std::array<float, 3> kAxisShares = {0.25f, 0.25f, 0.5f};

// Returns the density over the surface with which p, whose normal is n, is found by the probes of
// all axes and channels together.
float ProbePdf(const SubsurfaceProfile& profile, const Frame& frame, const Vec3f& d,
               const Vec3f& n) {
    const Vec3f local = frame.ToLocal(d), normal = frame.ToLocal(n);
    float pdf = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float r = std::hypot(local[(axis + 1) % 3], local[(axis + 2) % 3]);
        for (int c = 0; c < 3; ++c)
            pdf += profile.Pdf(c, r) * std::abs(normal[axis]) * kAxisShares[axis] / 3;
    }
    return pdf;
}

// Represents the segment of a probe ray, and how its hits are chosen among.
struct Probe {
    Vec3f from, to;
    float u;  // the rest of the number that chose axis and channel
};

std::optional<Probe> ChooseProbe(const SubsurfaceProfile& profile, const Frame& frame,
                                 const Vec3f& p, float u, const Vec2f& v, float reach) {
    const Vec3f* axes[3];  // the probe is along the last one
    if (u < 0.5f) {
        axes[0] = &frame.s, axes[1] = &frame.t, axes[2] = &frame.n;
        u *= 2;
    } else if (u < 0.75f) {
        axes[0] = &frame.t, axes[1] = &frame.n, axes[2] = &frame.s;
        u = (u - 0.5f) * 4;
    } else {
        axes[0] = &frame.n, axes[1] = &frame.s, axes[2] = &frame.t;
        u = (u - 0.75f) * 4;
    }
    const int channel = std::min(int(3 * u), 2);
    const auto r = profile.Sample(channel, v.x());
    // Light further away than that is left out, as in pbrt-v3; and where no ray is traced.
    const auto most = profile.Sample(channel, 0.999f);
    if (!r || !most || !(*r < *most)) return {};
    if (!(*most <= reach)) return {};
    const float phi = 2 * kPi * v.y(), half = std::sqrt(Sqr(*most) - Sqr(*r));
    const Vec3f middle = p + *r * (std::cos(phi) * *axes[0] + std::sin(phi) * *axes[1]);
    return Probe{middle - half * *axes[2], middle + half * *axes[2], 3 * u - float(channel)};
}

}  // namespace

std::optional<SubsurfaceExit> SampleSubsurface(const Scene& scene, Sampler& sampler,
                                               const SurfaceInteraction& hit, const Bsdf& bsdf,
                                               const SubsurfaceProfile& profile, float time) {
    const float u = sampler.Get1D();
    const auto probe =
        ChooseProbe(profile, bsdf.Shading(), hit.p, u, sampler.Get2D(), scene.shapes.reach);
    if (!probe) return {};

    // Choose one of all hits of this material with equal probability: each new one replaces the one
    // before with probability 1 / count, by the rest of the same number.
    std::optional<SubsurfaceExit> exit;
    int count = 0;
    float rest = probe->u;
    Ray ray{probe->from, probe->to - probe->from, 1 - 0.0001f};
    Hit found;
    while (!ray.d.isZero(0) && scene.accelerator.Intersect(ray, &found, time)) {
        SurfaceInteraction at;
        scene.shapes.Interact(ray, found, kNeedsNothing, &at, time);
        ray.d = probe->to - at.p;
        ray.o = OffsetRayOrigin(at.p, at.pError, at.n, ray.d);
        if (at.material != hit.material) continue;
        const float share = 1 / float(++count);
        const bool isTaken = rest < share;
        rest = isTaken ? rest * float(count) : (rest - share) / (1 - share);
        if (isTaken) exit = SubsurfaceExit{at, found.shape, Rgb(0, 0, 0)};
    }
    if (!exit) return {};
    const Vec3f d = exit->hit.p - hit.p;
    const float pdf = ProbePdf(profile, bsdf.Shading(), d, exit->hit.n) / float(count);
    exit->weight = profile(d.norm()) / pdf;
    if (!(pdf > 0) || IsBlack(exit->weight) || !IsFinite(exit->weight)) return {};
    exit->hit.wo = exit->hit.ns;
    return exit;
}

Bsdf ExitBsdf(const SubsurfaceExit& exit, float eta) {
    Frame frame{{}, {}, exit.hit.ns};
    CoordinateSystem(frame.n, &frame.s, &frame.t);
    Bsdf bsdf(frame, exit.hit.n, eta);
    // eta^2 undoes the scaling of radiance by refraction into the solid.
    const float norm = float(1 - 2 * FresnelMoment1(1 / double(eta)));
    bsdf.Add(DiffuseExit{Rgb(Rgb::Constant(Sqr(eta) / norm)), eta});
    return bsdf;
}

}  // namespace lull
