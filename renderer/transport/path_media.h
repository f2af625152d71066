// Steps of the path loop between two vertices, with and without participating media.
#pragma once

#include "renderer/transport/path_state.h"

#include <optional>

#include "renderer/bsdf/subsurface.h"
#include "renderer/scene/scene.h"

namespace lull {

// Panes: smooth thin sheets (glTF's transmission without a volume), which light goes straight
// through. To a path, being let through is no vertex: shadow rays pass panes with the same share,
// so that light behind them is weighted by the last vertex before, and no bounce is counted.

// Returns the share of light that gets straight through the surface where `ray` has found it, to
// where the ray comes from; black where it is no pane. `hit` receives the point.
Rgb ShareThrough(const Scene&, const Ray& ray, const Hit& found, float time,
                 SurfaceInteraction* hit);

// Does what ShareAlong() does in a scene that has panes.
Rgb ShareThroughPanes(const Scene&, const Ray& ray, float time);

// Returns the share of light that gets along the ray, from its end to its origin.
inline Rgb ShareAlong(const Scene& scene, const Ray& ray, float time) {
    if (scene.hasPanes) [[unlikely]]
        return ShareThroughPanes(scene, ray, time);
    return scene.accelerator.Occluded(ray, time) ? Rgb(Rgb::Zero()) : Rgb(Rgb::Ones());
}

// Decides at random whether a path that comes to a surface with kLetsThrough goes straight on, for
// sure where nothing else may happen (`mustGo`) and it can. Updates the throughput; where the path
// stays, the BSDF lets no light straight through any more.
bool GoesThroughPane(const Vec3f& wo, bool mustGo, Sampler&, Bsdf*, Rgb* beta);

// What a ray that looks for a light has found.
struct LightHit {
    Hit found;                // the light's surface, if it has one
    SurfaceInteraction at;    // there
    Rgb share = Rgb::Ones();  // of its light that gets to where the ray starts, an estimate
};

// Makes the ray from a surface point to a light's point; nothing where that is in shadow. Both ends
// are moved off their surfaces; the factor keeps the light's own surface out (pbrt-v3's
// ShadowEpsilon). A grazing ray that this or rounding turns to the other side is in shadow.
[[gnu::always_inline]] inline std::optional<Ray> ShadowRay(const SurfaceInteraction& hit,
                                                           const LightSample& light) {
    if (light.isAtInfinity) return hit.SpawnRay(light.wi);
    const Vec3f origin = OffsetRayOrigin(hit.p, hit.pError, hit.n, light.wi);
    const Vec3f target = OffsetRayOrigin(light.p, light.pError, light.n, origin - light.p);
    const Vec3f d = target - origin;
    if (!IsSameSide(hit.n, d, light.wi)) return {};
    return Ray{origin, d, 1 - 0.0001f};
}

// Without media: nothing is there. As with pbrt-v3's path integrator, interfaces block shadow rays.
// In scenes that have them (`panes`), shadow rays go through panes.
template <bool panes>
struct Vacuum {
    static constexpr bool kExist = false, kLetThrough = panes;
    using Context = PathContext<Vacuum>;

    explicit Vacuum(const Scene&) {}

    // Returns the share of a light's sample that gets to a vertex; without panes, whether it does.
    [[gnu::always_inline]] static auto See(const Context& context, const SurfaceVertex& v,
                                           const LightSample& light) {
        const std::optional<Ray> ray = ShadowRay(v.hit, light);
        const float time = context.camera.time;
        if constexpr (panes)
            return ray ? ShareAlong(context.scene, *ray, time) : Rgb(Rgb::Zero());
        else
            return ray && !context.scene.accelerator.Occluded(*ray, time);
    }

    static bool LeavesScene(const Context& context, const SurfaceVertex& v, const Vec3f& wi,
                            LightHit* lightHit) {
        const Ray ray = v.hit.SpawnRay(wi);
        if constexpr (!panes) return !context.scene.accelerator.Occluded(ray, context.camera.time);
        lightHit->share = ShareAlong(context.scene, ray, context.camera.time);
        return !IsBlack(lightHit->share);
    }
    // Returns whether it meets area light `index`.
    static bool MeetsLight(const Context& context, const SurfaceVertex& v, const Vec3f& wi,
                           int index, LightHit* lightHit) {
        Ray ray = v.hit.SpawnRay(wi);
        const Scene& scene = context.scene;
        const float time = context.camera.time;
        for (;;) {
            if (!scene.accelerator.Intersect(ray, &lightHit->found, time)) return false;
            if (scene.shapes.LightAt(lightHit->found) == index) break;
            if constexpr (!panes) return false;
            lightHit->share *= ShareThrough(scene, ray, lightHit->found, time, &lightHit->at);
            if (IsBlack(lightHit->share)) return false;
            ray = lightHit->at.SpawnRay(wi);
        }
        scene.shapes.Interact(ray, lightHit->found, kNeedsNothing, &lightHit->at);
        return true;
    }

    // Whether paths at their last ray, too, look for light behind such a surface.
    static constexpr bool LooksBehind(SurfaceNeeds needs) {
        return panes && (needs & kLetsThrough);
    }
    // Carries the ray on behind an interface; returns false where the path ends. Lights behind it
    // are seen only by rays for which emission counts in full.
    [[gnu::always_inline]] static bool GoThrough(const SurfaceInteraction& hit, int, bool isLast,
                                                 Path* path) {
        if (isLast) return false;
        path->ray = hit.SpawnRay(path->ray.d);
        path->pdf = 0;
        path->wentThrough = true;
        return true;
    }
    // Called when the path leaves a surface.
    static void Leave(const SurfaceVertex&, const Vec3f&) {}
};

using NoMedia = Vacuum<false>;
using NoMediaButPanes = Vacuum<true>;

// With media, pbrt-v3's volpath: shadow rays go through interfaces, and panes.
class Media {
  public:
    static constexpr bool kExist = true, kLetThrough = true;
    using Context = PathContext<Media>;

    // Does what MediumTable::Beyond() does. Where two volumes touch, the ray meets only one of
    // their surfaces: of the media about one that is entered, those are kept that it leaves later,
    // and where one is left, it is in the volume that it leaves next without having entered it.
    static MediumStack Beyond(const Scene&, int shape, const SurfaceInteraction&, const Vec3f& wi,
                              bool crosses, const MediumStack& current);

    // Starts where the camera is.
    explicit Media(const Scene& scene) : scene(&scene), media(scene.media.ofCamera) {}

    // Samples where the medium scatters the ray before it has gone t.
    MediumSample Sample(Ray ray, float t, Sampler& sampler) const {
        ray.tMax = t;
        const int medium = media.Top();
        return medium == kVacuum ? MediumSample{} : scene->media.Sample(medium, ray, sampler);
    }
    float PhaseParameter() const { return scene->media.PhaseParameter(media.Top()); }

    // How a vertex sees a sample of a light.
    struct Visibility {
        Rgb share = Rgb::Zero();  // of the light that gets there, an estimate
        // The channels in which rays that look for the light end in a medium without an end.
        Eigen::Array<bool, 3, 1> isOutOfReach = {false, false, false};
    };
    // As in pbrt-v3, light from infinity comes from twice the scene's radius away: through a medium
    // that fills the world it would not come from farther.
    template <typename Vertex>
    Visibility See(const Context& context, const Vertex& v, const LightSample& light) const {
        const Vec3f p = v.Position();
        const Vec3f origin = v.OriginTowards(light.isAtInfinity ? light.wi : Vec3f(light.p - p));
        const Vec3f target =
            light.isAtInfinity ? Vec3f(p + context.scene.shapes.bounds.Diagonal().norm() * light.wi)
                               : OffsetRayOrigin(light.p, light.pError, light.n, origin - light.p);
        if (!v.IsSameSide(target - origin, light.wi)) return {};
        return Look(context, origin, target, Towards(v, light.wi), light.isAtInfinity);
    }

    // As without media.
    template <typename Vertex>
    bool LeavesScene(const Context& context, const Vertex& v, const Vec3f& wi,
                     LightHit* lightHit) const {
        return Follow(context, {v.OriginTowards(wi), wi, kInfinity}, Towards(v, wi), kNothing,
                      lightHit);
    }
    template <typename Vertex>
    bool MeetsLight(const Context& context, const Vertex& v, const Vec3f& wi, int index,
                    LightHit* lightHit) const {
        return Follow(context, {v.OriginTowards(wi), wi, kInfinity}, Towards(v, wi), index,
                      lightHit);
    }

    // Surfaces behind an interface still belong to the last vertex, whose shadow rays see them;
    // rays that count in full end there, as with pbrt-v3.
    static bool LooksBehind(SurfaceNeeds needs) { return needs & (kIsInterface | kLetsThrough); }
    bool GoThrough(const SurfaceInteraction& hit, int shape, bool isLast, Path* path) {
        if (isLast && path->seesLights) return false;
        media = Beyond(*scene, shape, hit, path->ray.d, true, media);
        path->ray = hit.SpawnRay(path->ray.d);
        path->wentThrough = true;
        return true;
    }
    void Leave(const SurfaceVertex& v, const Vec3f& wi) { media = Towards(v, wi); }

  private:
    static constexpr int kNothing = -2;  // in place of an area light

    // Return the media on the side of a vertex that a direction points to.
    MediumStack Towards(const SurfaceVertex& v, const Vec3f& wi) const {
        return Beyond(*scene, v.shape, v.hit, wi, !v.IsSameSide(wi, v.hit.wo), media);
    }
    const MediumStack& Towards(const MediumVertex&, const Vec3f&) const { return media; }

    // Looks along a segment that starts in media `from`.
    static Visibility Look(const Context&, const Vec3f& origin, const Vec3f& target,
                           const MediumStack& from, bool isAtInfinity);
    // Follows a ray that starts in media `from` through interfaces and panes. Returns whether it
    // meets area light `index`.
    static bool Follow(const Context&, const Ray&, const MediumStack& from, int index, LightHit*);

    const Scene* scene;
    MediumStack media;  // that the path's next ray is in
};

// Finds where light that has gone into a translucent solid comes out again.

struct SubsurfaceExit {
    SurfaceInteraction hit;
    int shape;
    Rgb weight;  // of the path from there, scattered by the BSDF of an exit
};

// Chooses a point of the same material near `hit`, whose BSDF `bsdf` has let the path in, as the
// profile spreads light, by probe rays along the three axes of its frame (King, Kulla, Conty,
// Fajardo 2013; pbrt 3rd ed., 15.4.1). Returns nothing where none is found or no light goes.
std::optional<SubsurfaceExit> SampleSubsurface(const Scene& scene, Sampler& sampler,
                                               const SurfaceInteraction& hit, const Bsdf& bsdf,
                                               const SubsurfaceProfile& profile, float time);

// Returns how light leaves there: by Fresnel's law, as if it came from everywhere. wo is hit.ns.
Bsdf ExitBsdf(const SubsurfaceExit& exit, float eta);

}  // namespace lull
