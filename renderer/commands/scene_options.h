// Options of all commands that load a scene.
#pragma once

#include <CLI/App.hpp>
#include <memory>

#include "renderer/commands/command.h"
#include "renderer/film/film.h"
#include "renderer/input/gltf_loader.h"
#include "renderer/scene/scene.h"

namespace lull {

struct SceneOptions {
    std::string file;
    bool substitute = false;  // continue without missing and unsupported parts
    bool isVerbose = false;   // print warnings that do not concern the image
    CompileOptions compile;
    std::string integrator;  // empty: the scene's
    int pbrt = 0;            // the version, 3 or 4, that the scene is written for; 0: as it shows
    GltfOptions view;
    std::vector<float> stereo;  // distance and convergence of two eyes; empty: the scene's
    std::string eye;            // "left" or "right": of these, one alone
    std::string environment;    // empty: the scene's own
    double environmentRotation = 0, exposure = 0;
};

// Adds SCENE, --pbrt, --resolution, --crop, --integrator, --max-depth, --threads, --substitute,
// --exposure, --environment, --environment-rotation, --camera, --orbit, --frame,
// --animation, --shutter, --variant, --solid-glass.
void AddSceneOptions(CLI::App& app, SceneOptions* options);

// Prints warnings on stderr as they occur.
Warnings MakePrintedWarnings(const SceneOptions&, const Messages& = {});

// Reads the scene's file. Throws Error, and leaves others in the warnings, as ParsePbrt() does.
Description LoadDescription(const SceneOptions&, Warnings&);

// A scene that has been read, and its film as the options change it, before it is compiled,
// which will give the film's warnings.
struct SceneInput {
    // Throws Error, also if the memory cannot hold such a film.
    explicit SceneInput(const SceneOptions&, const FilmOptions& = {}, const Messages& = {});

    Warnings warnings;  // printed as they occur
    Description description;
    FilmSettings film;
    PixelRect region;  // the film's crop
};

}  // namespace lull
