// Types of all kinds of light: their traits, and samples of their light.
#pragma once

#include <fmt/format.h>

#include <string>

#include "renderer/base/math.h"
#include "renderer/input/description.h"

namespace lull {

// Tells lights apart by how paths find them. Rays meet none of the delta lights.
enum class LightType { DeltaPosition, DeltaDirection, Area, Infinite };

// Light that may arrive at a point.
struct LightSample {
    Rgb L;                  // radiance arriving, or for delta lights radiant intensity / distance^2
    Vec3f wi;               // towards the light, unit, world
    float pdf = 1;          // 1/sr; 1 for delta lights
    bool isDelta = false;   // no other strategy can find this direction
    bool isHidden = false;  // the emitter is invisible to rays; only light sampling finds it
    // L is 1: the map's radiance is left to LightTable::Radiance(), unless the light is occluded.
    bool isOnMap = false;
    // The point on the light, of one at infinity on its map: (s, t, 0); n is zero for point lights.
    bool isAtInfinity = false;
    Vec3f p = Vec3f::Zero(), pError = Vec3f::Zero(), n = Vec3f::Zero();
};

struct Emitted {
    Rgb L;      // radiance
    float pdf;  // 1/sr, with which sampling the light finds the same direction
};

// Follows Conty Estevez and Kulla 2018 (section 4.1): light leaves at angles of up to theta_e from
// normals that lie within theta_o of an axis.
struct LightBounds {
    Bounds3f box{};  // world
    Vec3f axis = Vec3f::UnitZ();
    float cosNormals = 1;   // cos(theta_o)
    float cosEmission = 0;  // cos(theta_e)
    float power = 0;        // luminance, W; nonnegative and finite, 0 for a light that is black
    bool isTwoSided = false;
};

// Returns the value that LightBounds has for a light of this power: positive unless the light is
// black, and small enough that float can hold sums over many lights.
inline float BoundedPower(const Rgb& power) {
    constexpr float kLeast = 1e-30f, kMost = 1e27f;
    const float luminance = Luminance(power.abs());
    return std::isnan(luminance) || luminance == 0 ? 0 : std::clamp(luminance, kLeast, kMost);
}

// Returns the colour of a light: its parameter `name` times "scale". Parts of it below 0, as
// colours outside of sRGB have, and numbers that are mistyped, count as black, with a warning.
inline Rgb LightColor(const Entity& entity, const std::string& name, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    const Rgb color =
        params.GetSpectrum(name, Rgb::Ones()) * params.GetSpectrum("scale", Rgb::Ones());
    if (!(color < 0).any()) return color;
    warnings.Add(entity.loc, "a light has a negative part, which counts as black",
                 fmt::format("\"{}\" of \"{}\"", name, entity.name));
    return color.max(0.f);
}

struct LightReader {
    const Description& description;  // relative file names start at its directory
    const LightEntity& entity;
    float worldRadius;   // of a sphere about the scene
    bool isCompensated;  // environment maps leave dim texels to BSDF sampling: EnvironmentMap
    Warnings& warnings;
};

// Returns the parameter "string lightgroup" of a LightSource or AreaLightSource, which RenderMan
// has under this name too; empty without one.
inline std::string LightGroupOf(const Entity& entity) {
    return entity.parameters.GetString("lightgroup", "");
}

// Returns whether a matrix scales all axes alike, but for rounding.
inline bool ScalesEvenly(const Mat3f& m) {
    const Mat3f square = m * m.transpose();
    const float scale2 = square.trace() / 3;
    return (square - scale2 * Mat3f::Identity()).norm() <= 1e-4f * scale2;
}

}  // namespace lull
