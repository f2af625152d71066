// Options of all commands that load a scene or render by stopping rules.
#pragma once

#include <CLI/App.hpp>

#include "renderer/commands/command.h"
#include "renderer/files/outputs.h"
#include "renderer/film/film.h"
#include "renderer/input/gltf_loader.h"
#include "renderer/render/session.h"
#include "renderer/scene/scene.h"
#include "stopping/rules/rule.h"

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

Warnings MakePrintedWarnings(const SceneOptions&, const Messages& = {});

// Reads the scene's file. Throws Error, and leaves others in the warnings, as ParsePbrt() does.
Description LoadDescription(const SceneOptions&, Warnings&);

// Returns the image to write where the command names none: the scene's `filename`, or the name of
// the scene if that is empty or "scene", as of many scenes.
std::string DefaultOutput(const std::string& filename, const std::string& scene);

// Returns the sampler where neither user nor command name one: that of least noise with independent
// halves, from which noise is estimated; with pbrt-v3's noise, the scene's.
SamplerKind DefaultSampler(Estimator, const Scene&);

struct RenderSettings {
    SceneOptions scene;
    std::optional<int> cap;
    ScheduleOptions schedule;
    std::optional<SamplerKind> sampler;  // else DefaultSampler()
    Estimator estimator = Estimator::Combined;
    uint64_t seed = 0;
    CheckpointOptions checkpoint;
    double caution = 1;  // see RuleContext
    bool quiet = false, jsonProgress = false;
};

// The cap by its name and by a shorter one.
inline constexpr const char* kCapOption = "--max-spp,--cap";

// Adds the options of the scene, --max-spp, --pass, --block, --sampler, --estimator, --seed,
// --quiet and --json-progress.
void AddRenderSettings(CLI::App& app, RenderSettings* settings);

// Adds --estimator, which stays as it is where the user says nothing.
void AddEstimatorOption(CLI::App& app, Estimator* estimator);

// Adds --caution, and its names, --quality, to a group of the help.
void AddCautionOptions(CLI::App& app, const char* group, double* caution);

void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options);

// Adds --checkpoint-interval alone, for commands that name the file themselves.
CLI::Option* AddCheckpointInterval(CLI::App& app, CheckpointOptions* options);

// Returns whether a text NAME[:ARGUMENT] is of the rule of this name.
bool IsRule(const std::string& rule, std::string_view name);
// Returns N of "fixed:N", 0 for other rules.
int FixedSpp(const std::string& rule);

// Adds the file that a stopping rule names, "learned:M.h5" or "thresholds:F.csv:NAME", if it does.
void AddFileOfRule(const std::string& rule, std::vector<NamedFile>* inputs);

// Returns the folder of installed models, next to the program.
std::string ModelFolder();

inline Messages MessagesOf(const RenderSettings& settings) {
    return {.isJson = settings.jsonProgress};
}

}  // namespace lull
