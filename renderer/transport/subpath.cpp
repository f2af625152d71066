#include "renderer/transport/bdpt_internal.h"

namespace lull {
namespace {

// Returns the index of refraction beyond the surface that the specular lobe has which takes wo to
// wi; 1 if it does not refract.
float IndexBetween(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi) {
    constexpr float kStraight = 1 - 1e-6f;
    float index = 1;
    for (int i = 0; i < bsdf.LobeCount(LobeSet::All); ++i) {
        float eta = 1;
        if (const auto* lobe = std::get_if<SpecularTransmission>(&bsdf.At(i)))
            eta = lobe->eta;
        else if (const auto* smooth = std::get_if<FresnelSpecular>(&bsdf.At(i)))
            eta = smooth->eta;
        else
            continue;
        if (eta == 1 && -wo.dot(wi) > kStraight) return 1;
        if (eta != 1) index = eta;
    }
    return index;
}

}  // namespace

bool Scatter(Origin origin, const SubpathVertex& v, const Vec2f& u, Segment* segment,
             bool* isSpecular, bool* isTransmission) {
    const SurfaceInteraction& hit = v.hit;
    const auto sample = v.bsdf.Sample(hit.wo, u, LobeSet::All);
    if (!sample) return false;
    const Vec3f& wi = sample->wi;
    const float cosine = std::abs(wi.dot(hit.ns));
    *isSpecular = sample->isSpecular;
    *isTransmission = sample->isTransmission;
    // A mirror that is turned for either direction takes many directions from the camera to one.
    // Subpaths from lights would have to find that, so they leave such light to the others.
    const bool isOneWay = sample->isSpecular && (v.bsdf.IsTurned(hit.wo) || v.bsdf.IsTurned(wi));
    if (isOneWay && origin == Origin::Light) return false;
    float forth, back;
    Rgb f;  // times the cosine
    if (sample->isSpecular) {
        // The densities of a refracted direction and of the one back differ by the indices and
        // cosines alone; the probabilities of lobes are taken as equal.
        const float index = sample->isTransmission ? IndexBetween(v.bsdf, hit.wo, wi) : 1;
        const float cosO = hit.wo.dot(hit.ns), cosI = wi.dot(hit.ns);
        const auto density = [&](float c) { return std::abs(c) * (c < 0 ? Sqr(index) : 1); };
        forth = density(cosI);
        back = density(cosO);
        f = sample->f * cosine;
        if (origin == Origin::Light) {
            const float turned = std::abs(hit.wo.dot(hit.n)) * cosine;
            if (!(turned > 0)) return false;
            f *= std::abs(cosO * wi.dot(hit.n)) / turned;
            f *= cosO > 0 ? Sqr(index) : 1 / Sqr(index);
        }
    } else {
        forth = sample->pdf;
        const BsdfValue reverse = v.bsdf.Evaluate(wi, hit.wo, LobeSet::All);
        back = reverse.pdf;
        f = origin == Origin::Camera
                ? Rgb(sample->f * cosine)
                : Rgb(reverse.f * (v.ShadingFactor() * std::abs(wi.dot(hit.n))));
    }
    segment->beta = v.beta * f / sample->pdf;
    if (IsBlack(segment->beta) || !IsFinite(segment->beta)) return false;
    segment->ray = hit.SpawnRay(wi);
    segment->pdf = forth;
    segment->p = hit.p;
    segment->n = hit.n;
    segment->density = v.arrival.density;
    segment->sum = sample->isSpecular ? 0 : v.arrival.own;
    if (!isOneWay) segment->sum += Sqr(double(back)) * v.arrival.fewer;
    segment->connects = !sample->isSpecular;
    segment->fromInfinity = false;
    return segment->density > 0;
}

Rgb ShareBetween(const Scene& scene, const SurfaceInteraction& a, const SurfaceInteraction& b,
                 float time) {
    const Vec3f w = b.p - a.p;
    const Vec3f from = OffsetRayOrigin(a.p, a.pError, a.n, w);
    const Vec3f to = OffsetRayOrigin(b.p, b.pError, b.n, -w);
    const Vec3f d = to - from;
    if (!IsSameSide(a.n, d, w) || !IsSameSide(b.n, d, w)) return Rgb::Zero();
    return ShareAlong(scene, {from, d, 1 - 0.0001f}, time);
}

bool SurvivesRoulette(float brightest, int bounces, float threshold, Sampler& sampler, Rgb* beta) {
    if (bounces <= 2 || !(brightest < threshold)) return true;
    const float survival = std::sqrt(brightest);
    if (sampler.Get1D() >= survival) return false;
    *beta /= survival;
    return true;
}

}  // namespace lull
