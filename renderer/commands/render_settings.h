// Options of all commands that render by stopping rules.
#pragma once

#include "renderer/commands/checkpoint_options.h"
#include "renderer/commands/scene_options.h"
#include "stopping/rules/rule.h"

namespace lull {

// What a render is for: an image of little noise, or the noise of the images that observers judged.
enum class Purpose { Image, Recording };

// Returns the sampler where the user names none. Images have that of least noise with independent
// halves, from which noise is estimated; with pbrt-v3's noise, the scene's. Recordings have
// independent samples.
SamplerKind DefaultSampler(Purpose, Estimator, const Scene&);

struct RenderSettings {
    SceneOptions scene;
    Purpose purpose = Purpose::Image;
    std::optional<int> cap;
    ScheduleOptions schedule;
    std::optional<SamplerKind> sampler;  // else DefaultSampler()
    Estimator estimator = Estimator::Combined;
    uint64_t seed = 0;
    CheckpointOptions checkpoint;
    double caution = 1;  // see RuleContext
    bool quiet = false, jsonProgress = false;
};

// Adds the options of the scene, --cap, --pass, --block, --sampler, --estimator, --seed, --quiet
// and --json-progress.
void AddRenderSettings(CLI::App& app, RenderSettings* settings);

// Adds --estimator, which stays as it is where the user says nothing.
void AddEstimatorOption(CLI::App& app, Estimator* estimator);

// Adds --caution.
CLI::Option* AddCautionOption(CLI::App& app, double* caution);

// Compiles the scene for a render, prints how often there was each of its warnings, and has it lie
// in memory where it is quick to read. With pbrt-v3's estimator lights are chosen by pbrt-v3's
// tables, however many there are. Throws Error.
std::unique_ptr<const Scene> CompileScene(const RenderSettings&, SceneInput*);

// Returns whether a text NAME[:ARGUMENT] is of the rule of this name.
bool IsRule(const std::string& rule, std::string_view name);
// Returns N of "fixed:N", 0 for other rules.
int FixedSpp(const std::string& rule);

// Returns the folder of installed models, next to the program.
std::string ModelFolder();

// Reads a stopping rule for a scene. `option` names the option that the rule was given with in the
// Error that a bad rule is; `measures` are RuleContext's.
Rule ReadRuleOption(const std::string& option, const std::string& rule,
                    const RenderSettings& settings, const PixelRect& region,
                    std::map<std::string, SignalMeasure> measures = {});

// Returns the provenance of an image, without the rule.
Provenance MakeProvenance(const RenderSettings&, const Scene&, const FilmSettings&);

// Returns the format of messages.
inline Messages MessagesOf(const RenderSettings& settings) {
    return {.isJson = settings.jsonProgress};
}

// Creates the printer of progress on stderr; `adaptive` says whether blocks stop by themselves.
ProgressPrinter MakePrinter(const RenderSettings&, bool adaptive);

}  // namespace lull
