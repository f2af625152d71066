// Sends light out from the lights of a scene, for paths that start there: the counterpart of
// LightTable, which has the light that arrives at a point.
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/scene/lights/light_table.h"

namespace lull {

// The densities of a path's first two vertices, as light `index` starts it.
struct EmissionDensity {
    // Of the vertex on the light, the choice of the light included: 1/m^2; of lights at infinity
    // that of the direction, 1/sr; a probability where the light has one place, or one direction.
    float origin = 0;
    // Of the next: 1/sr, or, of lights at infinity, 1/m^2 across the direction.
    float onward = 0;
};

struct EmittedRay {
    int light;
    // Of lights at infinity the point is on a disk that faces the scene, outside of it.
    Vec3f p, pError = Vec3f::Zero();
    Vec3f n = Vec3f::Zero();  // unit; zero where there is no surface
    Vec3f w;                  // unit, the way that light goes
    Rgb L;                    // W/(m^2 sr), or W/sr; of one direction W/m^2
    bool isAtInfinity = false;
    EmissionDensity density;

    // Returns the power that the ray stands for: its mean over samples is the power of all lights.
    Rgb Power() const {
        const float cosine = n.isZero(0) ? 1 : std::abs(n.dot(w));
        return L * (cosine / density.origin / density.onward);
    }
};

// Chooses lights by their power (pbrt 3rd ed., 16.1.2). Area lights shine by the cosine, points
// evenly over the directions that they light, lights at infinity through a disk about the scene.
class LightEmission {
  public:
    // `lights` must outlive it. Without lights that have power nothing is emitted.
    LightEmission(const LightTable& lights, const Bounds3f& bounds);

    // Chooses a light with u and light that leaves it. Returns nothing where none does.
    std::optional<EmittedRay> Sample(float u, const Vec2f& origin, const Vec2f& direction) const;

    // Returns the densities of light `index` shining along w, from a point of normal n.
    EmissionDensity Density(int index, const Vec3f& n, const Vec3f& w) const;

    bool Any() const { return anyPower; }
    float Pmf(int index) const { return anyPower ? choice.Pmf(index) : 0; }

  private:
    const LightTable& lights;
    Distribution1D choice;
    bool anyPower = false;
    Vec3f center = Vec3f::Zero();
    float radius = 1;  // of a sphere about the scene
};

}  // namespace lull
