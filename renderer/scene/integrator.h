// The ways of finding the light that reaches the camera, each with its parameters: the scene's
// Integrator. Their work is in transport/.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "renderer/input/description.h"

namespace lull {

// Paths from the camera, with light sampled at each vertex: pbrt-v3's "path" and "volpath".
struct PathIntegrator {
    static constexpr bool kTracesFromLights = false;

    int maxDepth = 5;       // bounces, >= 0
    float rrThreshold = 1;  // Russian roulette ends paths of a throughput below

    static const char* Name(bool isVolumetric) { return isVolumetric ? "volpath" : "path"; }
};

// Paths from the camera and from lights, connected in all ways: pbrt-v3's "bdpt".
struct BdptIntegrator {
    static constexpr bool kTracesFromLights = true;
    // Of maxDepth: longer subpaths from lights would have to be kept.
    static constexpr int kMostBounces = 100;

    int maxDepth = 5;
    float rrThreshold = 1;

    static const char* Name(bool) { return "bdpt"; }
};

using Integrator = std::variant<PathIntegrator, BdptIntegrator>;

// Returns whether it starts paths from lights, in rounds (render/light_rounds.h).
inline bool TracesFromLights(const Integrator& integrator) {
    return std::visit([](const auto& kind) { return kind.kTracesFromLights; }, integrator);
}

// Returns the names of all kinds, where nothing is volumetric.
std::vector<std::string> IntegratorNames();
std::string NameOf(const Integrator&, bool isVolumetric);
std::string TextOf(const Integrator&);  // its parameters in words
int MaxDepth(const Integrator&);

// Reads a scene's directive, with a warning if it substitutes another kind. `beyondBdpt` is the
// reason for "path" in place of "bdpt"; null: none. `maxDepth`, unless negative, replaces the
// scene's, which may be `isVolumetric`. Throws Error for bad parameters.
Integrator MakeIntegrator(const Entity&, int maxDepth, bool isVolumetric, const char* beyondBdpt,
                          Warnings&);

}  // namespace lull
