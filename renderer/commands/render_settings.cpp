#include "renderer/commands/render_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/input/scene_edits.h"
#include "renderer/render/provenance.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

bool ParseResolution(const std::string& text, std::optional<Vec2i>* resolution) {
    std::array<int, 2> size;
    if (!ParseNumbers(text, 'x', &size) || size[0] <= 0 || size[1] <= 0) return false;
    *resolution = Vec2i(size[0], size[1]);
    return true;
}

bool ParseCrop(const std::string& text, FilmOverrides* film) {
    const auto isOrdered = [](const auto& c) {
        return 0 <= c[0] && c[0] < c[1] && 0 <= c[2] && c[2] < c[3];
    };
    film->crop = {};
    film->cropInPixels = {};
    if (text.ends_with("px")) {
        std::array<int, 4> pixels;
        if (!ParseNumbers(text.substr(0, text.size() - 2), ',', &pixels) || !isOrdered(pixels))
            return false;
        film->cropInPixels = pixels;
        return true;
    }
    std::array<float, 4> c;
    if (!ParseNumbers(text, ',', &c) || !isOrdered(c) || !(c[1] <= 1 && c[3] <= 1)) return false;
    film->crop = c;
    return true;
}

bool ParseOrbit(const std::string& text, std::optional<std::array<float, 2>>* orbit) {
    std::array<float, 2> o;
    const bool valid = ParseNumbers(text, ',', &o) && std::abs(o[0]) <= 360 && std::abs(o[1]) <= 90;
    if (valid) *orbit = o;
    return valid;
}

bool ParseStereo(const std::string& text, std::vector<float>* stereo) {
    std::array<float, 1> distance;
    std::array<float, 2> both = {0, 0};
    if (ParseNumbers(text, ',', &distance))
        both[0] = distance[0];
    else if (!ParseNumbers(text, ',', &both))
        return false;
    if (!(both[0] > 0) || !(both[1] >= 0) || !(both[0] + both[1] < 1e6f)) return false;
    *stereo = {both[0], both[1]};
    return true;
}

void AddGltfOptions(CLI::App& app, GltfOptions* view) {
    auto* camera = AddOption(app, "Scene", "--camera", &view->camera,
                             "glTF: choose the camera, by name or number from 0 [0]", "NAME|N");
    AddOption(app, "Scene", "--orbit", ParseOrbit, &view->orbit,
              "azimuth,elevation in degrees, the elevation from -90 to 90",
              "glTF: view the whole scene, from degrees [without a camera: 30,15]",
              "azimuth,elevation")
        ->excludes(camera);
    auto* frame = AddOption(app, "Scene", "--frame", &view->frame,
                            "glTF: pose the animations at this time", "SECONDS", Between(0., 1e9));
    AddOption(app, "Scene", "--animation", &view->animation,
              "glTF: choose one animation, by name or number from 0 [all]", "NAME|N")
        ->needs(frame);
    AddOption(app, "Scene", "--shutter", &view->shutter,
              "glTF: open the shutter at --frame for this time [0]", "SECONDS", Between(0., 1e9))
        ->needs(frame);
    AddOption(app, "Scene", "--variant", &view->variant,
              "glTF: choose the material variant, by name or number; see lull info", "NAME|N");
    AddOption(app, "Scene", "--solid-glass", &view->solidGlass,
              "glTF: treat transmissive surfaces without a volume as solid");
}

struct Quality {
    std::string_view name;
    double caution;
};

constexpr Quality kQualities[] = {{"draft", 0.5}, {"good", 1}, {"final", 2}};

}  // namespace

void AddSceneOptions(CLI::App& app, SceneOptions* options) {
    app.add_option("SCENE", options->file,
                   "Scene to read: pbrt-v3, pbrt-v4, or glTF 2.0 (.gltf, .glb)")
        ->required();
    AddOption(app, "Scene", "--pbrt", &options->pbrt,
              "Read the scene as for this version of pbrt [as its directives show]", "3|4",
              CLI::IsMember({3, 4}));
    AddOption(app, kCommonOptions, "--resolution", ParseResolution,
              &options->compile.film.resolution, "a size in pixels such as 800x600",
              "Set the size of the image, in pixels [the scene's; glTF: 800 high]", "WxH");
    AddOption(app, "Image", "--crop", ParseCrop, &options->compile.film,
              "x0,x1,y0,y1 with 0 <= x0 < x1 <= 1 and the same for y, or in pixels with px "
              "after them",
              "Render a part: fractions from the upper left, or pixels, ending in px",
              "x0,x1,y0,y1[px]");
    const std::vector<std::string> integrators = IntegratorNames();
    AddOption(app, "Sampling", "--integrator", &options->integrator,
              "Find light by paths from the camera, or from lights too [the scene's]",
              fmt::format("{}", fmt::join(integrators, "|")), OneOf(integrators));
    AddOption(app, "Sampling", "--max-depth", &options->compile.maxDepth,
              "Limit paths to N bounces [the scene's]", "N", Between(0, 1000000));
    AddOption(app, kCommonOptions, "--threads", &options->compile.threads,
              "Render on N threads; 0: one per core", "N", Between(0, 4096));
    AddOption(app, "Scene", "--substitute", &options->substitute,
              "Replace missing and unsupported parts of the scene, with warnings");
    AddOption(app, "Scene", "--verbose", &options->isVerbose,
              "Print warnings without effect on the image, too");
    auto* stereo =
        AddOption(app, "Scene", "--stereo", ParseStereo, &options->stereo,
                  "D or D,C: the distance of the eyes, above 0, and the distance "
                  "where both see the same",
                  "Render a pair for two eyes, D apart, that see the same at the distance "
                  "C [parallel]",
                  "D[,C]");
    AddOption(app, "Scene", "--eye", &options->eye, "Render one eye of the pair alone",
              "left|right", CLI::IsMember({"left", "right"}))
        ->needs(stereo);
    AddOption(app, "Image", "--exposure", &options->exposure,
              "Multiply the radiance by 2^EV, in the EXR as well [0]", "EV", Between(-100., 100.));
    auto* environment =
        AddOption(app, "Scene", "--environment", &options->environment,
                  "Replace the environment map by this latitude-longitude image", "FILE.exr|.hdr");
    AddOption(app, "Scene", "--environment-rotation", &options->environmentRotation,
              "Rotate the environment map, in degrees, counterclockwise from above [0]", "DEG",
              Between(-360., 360.))
        ->needs(environment);
    AddGltfOptions(app, &options->view);
}

Warnings MakePrintedWarnings(const SceneOptions& options, const Messages& messages) {
    return Warnings([messages](const std::string& message) { messages.Print("warning", message); },
                    options.substitute, options.isVerbose);
}

Description LoadDescription(const SceneOptions& options, Warnings& warnings) {
    const bool isGltf = IsGltf(options.file);
    if (!isGltf && options.view.IsGiven())
        throw Error(
            options.file +
            ": not a glTF file; --camera, --orbit, --frame, --variant and --solid-glass are for "
            "glTF, set them in the scene");
    std::optional<PbrtVersion> version;
    if (options.pbrt != 0) version = options.pbrt == 3 ? PbrtVersion::V3 : PbrtVersion::V4;
    Description description = isGltf ? ParseGltf(options.file, options.view, warnings)
                                     : ParsePbrt(options.file, warnings, version);
    if (!options.stereo.empty()) SetStereo(options.stereo, options.eye, &description);
    if (!options.integrator.empty()) SetIntegrator(options.integrator, &description);
    if (options.exposure != 0) SetExposure(options.exposure, &description);
    if (!options.environment.empty())
        SetEnvironment(options.environment, options.environmentRotation, &description);
    if (isGltf) LightIfDark(&description, warnings);
    return description;
}

std::string DefaultOutput(const std::string& filename, const std::string& scene) {
    const std::filesystem::path given = filename;
    if (!given.stem().empty() && given.stem() != "scene") return filename;
    return std::filesystem::path(given).replace_filename(SceneName(scene) + ".exr").string();
}

SamplerKind DefaultSampler(Estimator estimator, const Scene& scene) {
    return estimator == Estimator::Combined ? SamplerKind::SobolHalves : scene.sampler;
}

void AddEstimatorOption(CLI::App& app, Estimator* estimator) {
    AddChoiceOption(app, "--estimator", estimator,
                    "Estimate light with least noise, or with the noise of pbrt-v3")
        ->group("Advanced");
}

void AddCautionOptions(CLI::App& app, const char* group, double* caution) {
    const std::string rules = RuleNames([](const RuleEntry& rule) { return rule.takesCaution; });
    auto* number =
        AddOption(app, group, "--caution", caution,
                  "Allow 1/X of the noise with " + rules +
                      ": multiply the noise that networks receive by X, divide limits by X",
                  "X", Between(0.01, 100.0));
    std::vector<std::string> names;
    for (const auto& [name, value] : kQualities) names.emplace_back(name);
    app.add_option_function<std::string>(
           "--quality",
           [caution](const std::string& name) {
               *caution = std::ranges::find(kQualities, name, &Quality::name)->caution;
           },
           "Allow twice the noise of good, the default, or half: --caution 0.5, 1 or 2")
        ->group(group)
        ->check(OneOf(names))
        ->type_name(fmt::format("{}", fmt::join(names, "|")))
        ->excludes(number);
}

void AddRenderSettings(CLI::App& app, RenderSettings* s) {
    AddSceneOptions(app, &s->scene);
    AddOption(app, kCommonOptions, kCapOption, &s->cap,
              "Stop every block at N spp at the latest [10000]", "N", Between(1, 1 << 24));
    AddOption(app, "Stopping", "--pass", &s->schedule.passLength, "Decide every N spp", "N",
              Between(1, 1 << 20));
    AddOption(app, "Stopping", "--block", &s->schedule.blockSize,
              "Set the side of the blocks, in pixels", "N", Between(1, 1 << 16));

    AddChoiceOption(app, "--sampler", &s->sampler,
                    "Choose the sampler [sobol-halves; by --estimator pbrt-v3 the scene's; study:\n"
                    "random]")
        ->group("Sampling");
    AddEstimatorOption(app, &s->estimator);
    AddOption(app, "Sampling", "--seed", &s->seed, "Seed the random numbers", "N", WholeNumber());
    AddOption(app, "Output", "--quiet", &s->quiet,
              "Print only warnings, errors and the names of files");
    AddOption(app, "Output", "--json-progress", &s->jsonProgress,
              "Print events as JSON, one object per line, on stderr");
}

CLI::Option* AddCheckpointInterval(CLI::App& app, CheckpointOptions* options) {
    return AddOption(app, "Interruption", "--checkpoint-interval", &options->interval,
                     "Save the checkpoint every S seconds", "S", Between(0.1, 1e6));
}

void AddCheckpointOptions(CLI::App& app, CheckpointOptions* options) {
    auto* file = AddOption(app, kCommonOptions, "--checkpoint", &options->file,
                           "Save the state of the render, to resume it", "F.h5");
    AddCheckpointInterval(app, options)->needs(file);
    AddOption(app, kCommonOptions, "--resume", &options->resume,
              "Resume from the checkpoint, if it exists")
        ->needs(file);
}

bool IsRule(const std::string& rule, std::string_view name) {
    const RuleEntry* entry = FindRule(rule);
    return entry && entry->name == name;
}

int FixedSpp(const std::string& rule) {
    if (!IsRule(rule, "fixed")) return 0;
    const std::string argument = ArgumentOf(rule);
    int spp = 0;
    std::from_chars(argument.data(), argument.data() + argument.size(), spp);
    return spp;
}

void AddFileOfRule(const std::string& rule, std::vector<NamedFile>* inputs) {
    const size_t colon = rule.find(':');
    if (colon == std::string::npos) return;
    const std::string rest = rule.substr(colon + 1);
    // A name may follow the file's, whose own may have colons.
    for (const std::string& file : {rest, rest.substr(0, rest.rfind(':'))}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(file, error))
            return inputs->push_back({"the file of the rule,", file});
    }
}

std::string ModelFolder() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    return (program.parent_path().parent_path() / "share/lull/models").string();
}

}  // namespace lull
