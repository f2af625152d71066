// Records all of a path, in place of its first hit alone.
#pragma once

#include <utility>

#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/path_log.h"

namespace lull {

class PathRecorder {
  public:
    PathRecorder(const Scene& scene, std::vector<PathStep>* steps) : scene(scene), steps(steps) {}

    static constexpr bool Wanted() { return false; }
    void Advance(float t) { distance += t; }

    void LeaveScene(const Path& path) { Add(PathStep::Kind::Sky, path, path.ray.d.normalized()); }
    // Comes to a surface, before anything is known of its material.
    void ReachSurface(const Path& path, const Hit& found, const SurfaceInteraction& at) {
        PathStep& step = Add(PathStep::Kind::Surface, path, at.p);
        step.normal = at.n;
        step.object = NumberOfObject(scene, found);
        step.material = 1 + uint32_t(at.material);
    }
    static void MeetSurface(const Path&, const Hit&, const SurfaceInteraction&, const Bsdf&) {}
    void MeetMedium(const Path& path, const Vec3f& p) { Add(PathStep::Kind::Medium, path, p); }

    // `L` is what the path has brought by now.
    void Emit(const Rgb& L) { Gain(L, &PathStep::emitted); }
    void Light(const Rgb& L) { Gain(L, &PathStep::direct); }
    void Scatter(const Path& path, bool isTransmission) {
        PathStep& step = steps->back();
        step.goesOn = true;
        step.direction = path.ray.d.normalized();
        step.pdf = path.pdf;
        step.isSpecular = path.seesLights;
        step.isTransmission = isTransmission;
    }

  private:
    PathStep& Add(PathStep::Kind kind, const Path& path, const Vec3f& position) {
        PathStep& step = steps->emplace_back();
        step.kind = kind;
        step.distance = std::exchange(distance, 0.f);
        step.position = position;
        step.throughput = path.beta;
        return step;
    }
    void Gain(const Rgb& L, Rgb PathStep::*part) {
        steps->back().*part += L - before;
        before = L;
    }

    const Scene& scene;
    std::vector<PathStep>* steps;
    Rgb before = Rgb::Zero();
    float distance = 0;
};

}  // namespace lull
