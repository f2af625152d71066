// Records all of a path, in place of its first hit alone.
#pragma once

#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/path_log.h"

namespace lull {

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
