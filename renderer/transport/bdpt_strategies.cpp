#include "renderer/transport/bdpt_strategies_internal.h"

#include "renderer/base/color.h"
#include "renderer/transport/panes.h"
#include "renderer/transport/path_media.h"

namespace lull {

double EmissionWeight(const Segment& segment, double density, double fewer, float direct,
                      const EmissionDensity& emission) {
    const double sampled = segment.connects ? double(direct) / double(segment.pdf) : 0;
    const double fromLight = double(emission.origin) * double(emission.onward) / density;
    return 1 / (1 + Sqr(sampled) + Sqr(fromLight) * fewer);
}

Rgb EmittedLight(const BdptContext& context, const Segment& segment, const SurfaceInteraction& hit,
                 const Hit& found, const Arrival& arrival, const LightChoice& choice) {
    const Scene& scene = context.scene;
    const Light& light = scene.lights[hit.areaLight];
    const Rgb L = Le(light, hit.n, hit.wo, found);
    if (IsBlack(L)) return L;
    const float direct =
        segment.connects ? Pdf(light, segment.p, hit.p, hit.n) * choice.Pmf(hit.areaLight) : 0;
    return L * float(EmissionWeight(segment, arrival.density, arrival.fewer, direct,
                                    scene.emission->Density(hit.areaLight, hit.n, hit.wo)));
}

Rgb SampledLight(const BdptContext& context, const SubpathVertex& v, const LightChoice& choice,
                 int* chosen) {
    const Scene& scene = context.scene;
    float pmf;
    const int index = *chosen = choice.Sample(context.sampler.Get1D(), &pmf);
    const Vec2f u = context.sampler.Get2D();
    if (!(pmf > 0)) return Rgb::Zero();
    const auto light = scene.lights.Sample(index, v.hit.p, u);
    if (!light || IsBlack(light->L)) return Rgb::Zero();
    const BsdfValue value = v.TowardsLight(light->wi);
    if (IsBlack(value.f)) return Rgb::Zero();
    const auto ray = ShadowRay(v.hit, *light);
    const Rgb share = ray ? ShareAlong(scene, *ray, context.time) : Rgb(Rgb::Zero());
    if (IsBlack(share)) return Rgb::Zero();
    const Rgb L = share * (light->isOnMap ? scene.lights.Radiance(index, *light) : light->L);

    const double direct = double(light->pdf) * double(pmf);
    const double found = light->isDelta || light->isHidden ? 0 : double(value.pdf) / direct;
    const EmissionDensity emission = scene.emission->Density(index, light->n, -light->wi);
    const double across = std::abs(double(v.hit.n.dot(light->wi)));
    double more = double(emission.origin) / direct * double(emission.onward) * across;
    if (!light->isAtInfinity) {
        const double distance2 = std::max(double((light->p - v.hit.p).squaredNorm()), 1e-30);
        // A density by solid angle, of light that has an area.
        if (!light->isDelta) more /= PerArea(light->n, light->wi, distance2);
        more /= distance2;
    }
    if (more > 0) more = Sqr(more) * v.arrival.Sum(v.Pdf(light->wi, v.hit.wo));
    const double weight = 1 / (1 + Sqr(found) + more);
    return value.f * L * float(weight / direct);
}

Rgb ConnectedLight(const BdptContext& context, const SubpathVertex& z, const SubpathVertex& y) {
    const Vec3f d = y.hit.p - z.hit.p;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return Rgb::Zero();
    const Vec3f w = d / std::sqrt(distance2);
    const BsdfValue atZ = z.TowardsLight(w);
    if (IsBlack(atZ.f)) return Rgb::Zero();
    const BsdfValue atY = y.TowardsCamera(-w);
    Rgb L = atZ.f * atY.f * y.beta / distance2;
    if (IsBlack(L)) return Rgb::Zero();
    L *= ShareBetween(context.scene, z.hit, y.hit, context.time);
    if (IsBlack(L)) return Rgb::Zero();
    const double towardsY = double(atZ.pdf) * PerArea(y.hit.n, w, double(distance2));
    const double towardsZ = double(y.Pdf(y.hit.wo, -w)) * PerArea(z.hit.n, w, double(distance2));
    double others = 0;
    if (towardsY > 0) others += Sqr(towardsY) * y.arrival.Sum(atY.pdf);
    if (towardsZ > 0) others += Sqr(towardsZ) * z.arrival.Sum(z.Pdf(w, z.hit.wo));
    const double samples = context.connections;
    return L * float(samples / (Sqr(samples) + others));
}

}  // namespace lull
