// Represents where a path scatters: on a surface, or in a medium. Directions point away from there,
// unit, world.
#pragma once

#include "renderer/bsdf/phase.h"
#include "renderer/scene/scene.h"

namespace lull {

// Returns whether both directions leave a surface of normal n on the same side.
inline bool IsSameSide(const Vec3f& n, const Vec3f& a, const Vec3f& b) {
    return (a.dot(n) < 0) == (b.dot(n) < 0);
}

// Returns the factor of radiance that is refracted from wo's side of a surface to the other.
inline float EtaScaleAt(const SurfaceInteraction& hit, const Bsdf& bsdf) {
    const float eta2 = Sqr(bsdf.Eta());
    return hit.wo.dot(hit.n) > 0 ? eta2 : 1 / eta2;
}

struct SurfaceVertex {
    const SurfaceInteraction& hit;
    const Bsdf& bsdf;
    int shape;

    const Vec3f& Position() const { return hit.p; }
    LightChoice Choice(const LightTable& lights, size_t place) const {
        return lights.Choice(hit, bsdf, place);
    }

    BsdfValue Evaluate(const Vec3f& wi, LobeSet set) const {
        return bsdf.Evaluate(hit.wo, wi, set);
    }
    // Does so without specular lobes, with the density that all others are as likely.
    BsdfValue EvaluateEvenly(const Vec3f& wi) const {
        return bsdf.WithoutShares().Evaluate(hit.wo, wi, LobeSet::NonSpecular);
    }
    std::optional<BsdfSample> Sample(const Vec2f& u, LobeSet set) const {
        return bsdf.Sample(hit.wo, u, set);
    }
    // Returns the factor of f.
    float Cosine(const Vec3f& wi) const { return std::abs(wi.dot(hit.ns)); }

    // Returns the point where a ray of direction d, of any length, starts.
    Vec3f OriginTowards(const Vec3f& d) const {
        return OffsetRayOrigin(hit.p, hit.pError, hit.n, d);
    }
    Ray SpawnRay(const Vec3f& d) const { return hit.SpawnRay(d); }
    float EtaScale() const { return EtaScaleAt(hit, bsdf); }
    bool IsSameSide(const Vec3f& a, const Vec3f& b) const { return lull::IsSameSide(hit.n, a, b); }
};

// f is the phase function, which is its density as well.
struct MediumVertex {
    Vec3f p, wo;
    float g;

    const Vec3f& Position() const { return p; }
    LightChoice Choice(const LightTable& lights, size_t place) const {
        return lights.Choice(p, place);
    }

    BsdfValue Evaluate(const Vec3f& wi, LobeSet) const {
        const float phase = PhaseHenyeyGreenstein(wo.dot(wi), g);
        return {Rgb::Constant(phase), phase};
    }
    BsdfValue EvaluateEvenly(const Vec3f& wi) const { return Evaluate(wi, LobeSet::All); }
    std::optional<BsdfSample> Sample(const Vec2f& u, LobeSet) const {
        const Vec3f wi = SampleHenyeyGreenstein(wo, g, u);
        const BsdfValue value = Evaluate(wi, LobeSet::All);
        return BsdfSample{value.f, value.pdf, wi, false, true};
    }
    float Cosine(const Vec3f&) const { return 1; }
    float EtaScale() const { return 1; }

    Vec3f OriginTowards(const Vec3f&) const { return p; }
    Ray SpawnRay(const Vec3f& d) const { return {p, d, kInfinity}; }
    bool IsSameSide(const Vec3f&, const Vec3f&) const { return true; }
};

}  // namespace lull
