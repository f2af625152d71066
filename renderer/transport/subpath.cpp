#include "renderer/base/math.h"
#include "renderer/scene/cameras/camera.h"
#include "renderer/transport/bdpt_internal.h"
#include "renderer/transport/integrator_internal.h"

namespace lull {
namespace {

// Returns the index beyond the surface of the specular lobe from wo to wi; 1 without refraction.
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

namespace {

class CameraConnector {
  public:
    CameraConnector(const BdptContext& context, std::vector<Splat>* splats)
        : context(context),
          splats(splats),
          size(context.scene.film.resolution.cast<float>()),
          reach(context.scene.filter.Radius()) {}

    // The light is number `light`.
    void Connect(const SubpathVertex& v, const SurfaceInteraction& hit, int light) {
        if (!v.Connects()) return;
        const Scene& scene = context.scene;
        CameraSample at;
        at.time = context.time;
        if (scene.camera.HasLens()) at.lens = context.sampler.Get2D();
        const auto view = ViewOf(scene.camera, hit.p, at.lens, at.time);
        if (!view || (view->film.array() < -reach.array()).any() ||
            (view->film.array() > (size + reach).array()).any())
            return;
        at.film = view->film;
        if (!(scene.materials.Needs(hit.material) & kNeedsFootprint)) return Add(v, *view, light);
        SurfaceInteraction seen = hit;
        ComputeFootprint(scene.camera, at, &seen);
        Add(SubpathVertex(scene, seen, v.beta, v.arrival), *view, light);
    }

  private:
    void Add(const SubpathVertex& v, const CameraView& view, int light) {
        const Scene& scene = context.scene;
        const Vec3f d = view.lens - v.hit.p;
        const float distance2 = d.squaredNorm();
        const Vec3f w = d / std::sqrt(distance2);
        const BsdfValue value = v.TowardsCamera(w);
        Rgb L = value.f * v.beta * (view.perSolidAngle / distance2);
        if (IsBlack(L)) return;
        const Vec3f origin = OffsetRayOrigin(v.hit.p, v.hit.pError, v.hit.n, w);
        L *= ShareAlong(scene, {origin, view.lens - origin, 1}, context.time);
        if (IsBlack(L)) return;
        const double seen = double(view.perSolidAngle) * PerArea(v.hit.n, w, double(distance2));
        const double samples = context.lightPaths;
        L *= float(samples / (Sqr(samples) + Sqr(seen) * v.arrival.Sum(value.pdf)));
        const float luminance = Luminance(L);
        if (luminance > scene.film.maxSampleLuminance)
            L *= scene.film.maxSampleLuminance / luminance;
        L = Balanced(scene, L) * scene.film.scale;
        const bool isValid = IsFinite(L) && luminance >= 0;
        splats->push_back({view.film, isValid ? L : Rgb(Rgb::Zero()), light, !isValid});
    }

    const BdptContext& context;
    std::vector<Splat>* splats;
    const Vec2f size, reach;  // of the image and the filter, pixels
};

}  // namespace

double LightPathCount(const Scene& scene, const BdptShares& shares) {
    if (!SeesPoints(scene.camera) || scene.hidesShapes) return 0;
    if (!scene.emission || !scene.emission->Any()) return 0;
    const Vec2i& size = scene.film.resolution;
    return std::ceil(double(shares.lightPaths) * double(size.x()) * double(size.y()));
}

void TraceLightPath(const Scene& scene, const BdptShares& shares, Sampler& sampler, uint32_t round,
                    uint32_t index, std::vector<Splat>* splats) {
    splats->clear();
    // Numbers of no pixel: one Sobol sequence for each round.
    sampler.StartSample(Vec2i(-1, int(round)), index);
    const float time = scene.isMoving ? sampler.Get1D() : 0;
    const BdptContext context = ContextOf(scene, shares, sampler, time);
    CameraConnector connector(context, splats);
    alignas(SubpathVertex) std::byte storage[sizeof(SubpathVertex)];
    FollowLight(
        context, context.integrator.maxDepth,
        [&](const SurfaceInteraction& hit, const Rgb& beta, const Arrival& arrival)
            -> SubpathVertex& { return *new (storage) SubpathVertex(scene, hit, beta, arrival); },
        [&](const SubpathVertex& v, const SurfaceInteraction& hit, int light) {
            connector.Connect(v, hit, light);
        });
}

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
        density *= double(LeAndPdf(light, v.hit.p, -ray.w).pdf);
    }
    return density / double(ray.density.origin);
}

}  // namespace lull
