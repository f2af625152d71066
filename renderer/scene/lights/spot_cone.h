// How the light of spots falls off to the sides.
#pragma once

#include "renderer/input/description.h"

namespace lull {

// The light is whole up to the angle whose cosine is cosFalloffStart, and falls smoothly to none at
// that of cosTotalWidth: by the fourth power of how far the cosine is from there, as in pbrt-v3, or
// by its square, as KHR_lights_punctual proposes.
struct SpotCone {
    Vec3f axis;  // unit, world
    float cosTotalWidth, cosFalloffStart;
    bool isSquared = false;

    // Reads "from", "to", "coneangle" and "conedeltaangle", degrees. Throws Error where the points
    // are the same.
    static SpotCone Make(const Entity&, const Mat4d& worldFromLight, bool isSquared);

    // Returns the fraction of the light that leaves towards w, unit.
    float Falloff(const Vec3f& w) const {
        const float cosTheta = w.dot(axis);
        if (cosTheta < cosTotalWidth) return 0;
        const float x = cosTheta >= cosFalloffStart
                            ? 1.f
                            : (cosTheta - cosTotalWidth) / (cosFalloffStart - cosTotalWidth);
        return isSquared ? Sqr(x) : Sqr(Sqr(x));
    }
    // Returns about how many steradians the whole light would fill, as pbrt-v3 has it.
    float SolidAngle() const { return 2 * kPi * (1 - 0.5f * (cosFalloffStart + cosTotalWidth)); }
    // Returns the cosines of the angle where the light begins to fall off, and of that from there
    // to where it ends: LightBounds.
    Vec2f CosinesOfBounds() const;
};

}  // namespace lull
