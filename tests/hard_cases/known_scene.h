// Makes small scenes from pbrt-v3 text and compares their radiance with known answers.
#pragma once

#include <memory>
#include <string>

#include "renderer/transport/integrator.h"
#include "tests/hard_cases/hard_case.h"

namespace lull {

struct TemporaryDirectory;

struct KnownScene {
    std::string world;                            // after WorldBegin
    std::string camera = "0 0 -3  0 0 0  0 1 0";  // LookAt
    double fov = 40;
    int size = 8;                 // pixels a side
    std::string integrator = "";  // parameters of Integrator "path"
    // Where files that the world names are, if any.
    const TemporaryDirectory* directory = nullptr;
};

// Compiles the scene. Throws Error as reading a scene does; warnings are silent.
std::unique_ptr<const Scene> MakeScene(const KnownScene&);

// Renders with both estimators and returns the worse comparison of the image's mean (green) with
// `answer`. The tolerance is relative * answer and 4.5 standard errors of the mean, as measured.
// A rejected sample makes it NaN, which fails.
HardCaseResult CompareRadiance(const Scene& scene, double answer, double relative, int samples,
                               const HardCaseOptions& options, const std::string& note = "");

inline const char* const kSky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

// Returns a trianglemesh as pbrt-v3 text.
std::string MeshText(const std::string& indices, const std::string& points);

// Returns the mesh of the box between two corners, its normals outwards.
std::string BoxText(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);

// Returns a square of the given half side around the origin, at height z, that faces -z: up.
std::string FloorText(double half, double z = 0);

}  // namespace lull
