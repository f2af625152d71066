// Records the first hit of a path, and the light of groups.
#pragma once

#include "renderer/bsdf/bsdf.h"
#include "renderer/transport/integrator.h"
#include "renderer/transport/path_state.h"

namespace lull {

// Returns the number of the hit object, as in FirstHit.
inline uint32_t NumberOfObject(const Scene& scene, const Hit& found) {
    return 1 + uint32_t(found.instance < 0 ? found.shape
                                           : scene.shapes.worldShapeCount + found.instance);
}

class FirstHitRecorder : public NoRecorder {
  public:
    // Records what the sample asks for. `direction` is of the camera's ray at `time`.
    FirstHitRecorder(const Scene& scene, const PathOptions& options, const Vec3f& direction,
                     float time, PathSample* sample)
        : scene(scene),
          options(options),
          direction(direction),
          time(time),
          groups(sample->groups),
          hit(&sample->hit),
          done(!sample->asksForHit) {}
    static bool IsNeeded(const PathSample& sample) { return sample.asksForHit || sample.groups; }

    bool Wanted() const { return !done; }

    void FindLight(const Path& path, int index, const Rgb& L) {
        if (groups) groups->Add(index, path.beta * L);
    }

    // The environment's radiance stands for the albedo.
    void LeaveScene(const Path& path) {
        if (done) return;
        done = true;
        StoreColor(
            Emission(scene, options.estimator, path, nullptr, {}, NoRecorder()) * scene.film.scale,
            path);
    }

    void ReachSurface(const Path&, const Hit& found, const SurfaceInteraction&) {
        if (!done) distance += found.t;
    }

    void MeetSurface(const Path& path, const Hit& found, const SurfaceInteraction& at,
                     const Bsdf& bsdf) {
        if (done) return;
        const bool isSpecular = bsdf.LobeCount(LobeSet::All) > 0 &&
                                bsdf.LobeCount(LobeSet::NonSpecular) == 0 &&
                                !(scene.materials.Needs(at.material) & kScattersBelow);
        if (isSpecular && options.throughSpecular && at.areaLight < 0) return;
        Rgb color = AlbedoOf(bsdf, at.wo);
        if (at.areaLight >= 0) {
            const Rgb seen = Emission(scene, options.estimator, path, &at, found, NoRecorder());
            if (isDirect) hit->emission = path.beta * seen;
            color = color.max(seen * scene.film.scale);
        }
        Store(color, at.p, path);
        if (at.ns.allFinite()) hit->normal = at.n.dot(at.wo) < 0 ? Vec3f(-at.ns) : at.ns;
        hit->object = NumberOfObject(scene, found);
        hit->material = 1 + uint32_t(at.material);
    }

    // `path.beta` knows of the medium's albedo.
    void MeetMedium(const Path& path, float t, const Vec3f& p) {
        if (done) return;
        distance += t;
        Store(Rgb::Ones(), p, path);
    }

    void Scatter(const Path&, bool) { isDirect = false; }

  private:
    void Store(const Rgb& color, const Vec3f& p, const Path& path) {
        done = true;
        StoreColor(color, path);
        hit->position = p;
        hit->depth = Depth();
        hit->found = p.allFinite() && std::isfinite(hit->depth);
    }

    // Refraction scales radiance by the indices' ratio; that is no matter of colour.
    void StoreColor(const Rgb& color, const Path& path) {
        const Rgb seen = path.beta * path.etaScale * color;
        for (int c = 0; c < 3; ++c) hit->albedo[c] = seen[c] > 0 ? std::min(seen[c], 1.f) : 0;
    }

    float Depth() const {
        const Camera& camera = scene.camera;
        if (camera.projection == Projection::Environment ||
            camera.projection == Projection::EqualArea)
            return distance;
        Vec3f axis = camera.rotation.col(2);
        if (camera.motion) axis = TransformVector(camera.motion->At(time), axis);
        const float scale = axis.norm();
        return distance * (direction.dot(axis) / scale) + camera.clipStart * scale;
    }

    const Scene& scene;
    const PathOptions& options;
    const Vec3f direction;
    const float time;
    GroupRadiance* groups;  // null: not wanted
    FirstHit* hit;
    float distance = 0;  // of the path so far, from where its first ray begins
    bool done;
    bool isDirect = true;  // nothing has scattered the path
};

// Records all of a path, in place of its first hit alone.

class PathRecorder : public NoRecorder {
  public:
    PathRecorder(const Scene& scene, std::vector<PathStep>* steps) : scene(scene), steps(steps) {}

    void LeaveScene(const Path& path) {
        Add(PathStep::Kind::Sky, path, 0, path.ray.d.normalized());
        Gain(path, &PathStep::emitted);
    }
    void ReachSurface(const Path& path, const Hit& found, const SurfaceInteraction& at) {
        PathStep& step = Add(PathStep::Kind::Surface, path, found.t, at.p);
        step.normal = at.n;
        step.object = NumberOfObject(scene, found);
        step.material = 1 + uint32_t(at.material);
        Gain(path, &PathStep::emitted);
    }
    void MeetMedium(const Path& path, float t, const Vec3f& p) {
        Add(PathStep::Kind::Medium, path, t, p);
    }
    void Scatter(const Path& path, bool isTransmission) {
        Gain(path, &PathStep::direct);
        PathStep& step = steps->back();
        step.goesOn = true;
        step.direction = path.ray.d.normalized();
        step.pdf = path.pdf;
        step.isSpecular = path.seesLights;
        step.isTransmission = isTransmission;
    }
    void End(const Path& path) {
        if (!steps->empty()) Gain(path, &PathStep::direct);
    }

  private:
    PathStep& Add(PathStep::Kind kind, const Path& path, float distance, const Vec3f& position) {
        PathStep& step = steps->emplace_back();
        step.kind = kind;
        step.distance = distance;
        step.position = position;
        step.throughput = path.beta;
        return step;
    }
    // Adds the radiance of the path since the last call.
    void Gain(const Path& path, Rgb PathStep::*part) {
        steps->back().*part += path.L - before;
        before = path.L;
    }

    const Scene& scene;
    std::vector<PathStep>* steps;
    Rgb before = Rgb::Zero();
};

}  // namespace lull
