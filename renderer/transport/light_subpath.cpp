#include "renderer/transport/light_subpath_internal.h"

namespace lull {

double DirectOverEmitted(const Scene& scene, const SubpathVertex& v, const EmittedRay& ray) {
    const Light& light = scene.lights[ray.light];
    const float pmf =
        scene.lights.Choice(v.hit, v.bsdf, scene.lights.PlaceOf(v.hit.p)).Pmf(ray.light);
    const LightType type = TypeOf(light);
    double density = pmf;
    if (type == LightType::Area) {
        const Vec3f d = ray.p - v.hit.p;
        const double distance2 = std::max(double(d.squaredNorm()), 1e-30);
        density *= double(Pdf(light, v.hit.p, ray.p, ray.n)) *
                   PerArea(ray.n, d / std::sqrt(float(distance2)), distance2);
    } else if (type == LightType::Infinite) {
        density *= double(LeAndPdf(light, -ray.w).pdf);
    }
    return density / double(ray.density.origin);
}

}  // namespace lull
