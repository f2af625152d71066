// Records the vertices of one path, to find the source of a bright pixel.
#pragma once

#include <vector>

#include "renderer/transport/integrator.h"

namespace lull {

// The end of one ray of a path.
struct PathStep {
    enum class Kind { Surface, Medium, Sky };

    Kind kind = Kind::Surface;
    float distance = 0;                 // from the step before, or from the camera
    Vec3f position = Vec3f::Zero();     // world; for the sky, the ray's direction
    Vec3f normal = Vec3f::Zero();       // surfaces: geometric, unit
    uint32_t object = 0, material = 0;  // numbers as in FirstHit
    Rgb throughput = Rgb::Ones();       // of the path that arrives here
    Rgb emitted = Rgb::Zero();          // radiance emitted here, weighted by throughput
    Rgb direct = Rgb::Zero();           // of light that arrives here directly, counted
    bool goesOn = false;                // the path was scattered; then:
    Vec3f direction = Vec3f::Zero();    // unit, world
    float pdf = 0;                      // of the direction, 1/sr; of a specular lobe, no density
    bool isSpecular = false, isTransmission = false;
};

struct PathLog {
    Ray ray;                 // the camera's
    float filterWeight = 1;  // these factors are in the sample's radiance, but not in the steps
    float cameraWeight = 1;
    float filmScale = 1;
    std::vector<PathStep> steps;
    PathSample sample;
};

// Takes the same sample of a scene that has a PathIntegrator as RenderSample(), and records
// its path.
PathLog LogSample(const Scene&, Estimator, Sampler&, const Vec2i& pixel, uint32_t index);

}  // namespace lull
