#include "renderer/commands/scene_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/input/scene_edits.h"
#include "renderer/render/provenance.h"
#include "renderer/render/session.h"

namespace lull {

namespace {

// Reads numbers with `separator` between them; false if `text` is anything else.
template <typename T, size_t N>
bool ParseNumbers(const std::string& text, char separator, std::array<T, N>* numbers) {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (size_t i = 0; i < N; ++i) {
        if (i > 0 && (at == end || *at++ != separator)) return false;
        const auto [next, error] = std::from_chars(at, end, (*numbers)[i]);
        if (error != std::errc()) return false;
        at = next;
    }
    return at == end;
}

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

// Turns "a bad value" into the error message of an option.
template <typename T>
auto Checked(bool (*parse)(const std::string&, T*), T* value, const std::string& wanted) {
    return [=](const std::string& text) {
        if (!parse(text, value)) throw CLI::ValidationError(text, "is not " + wanted);
    };
}

// The film's warnings come when the scene is compiled.
FilmSettings SilentFilmSettings(const Description& description, const SceneOptions& options) {
    Warnings unheard;
    return MakeFilmSettings(description, options.compile.film, unheard);
}

void AddFilmOptions(CLI::App& app, FilmOverrides* film) {
    app.add_option_function<std::string>(
           "--resolution",
           Checked(ParseResolution, &film->resolution, "a size in pixels such as 800x600"),
           "Set the size of the image, in pixels [the scene's; glTF: 800 high]")
        ->group(kCommonOptions)
        ->type_name("WxH");
    app.add_option_function<std::string>(
           "--crop",
           Checked(ParseCrop, film,
                   "x0,x1,y0,y1 with 0 <= x0 < x1 <= 1 and the same for y, or in pixels with px "
                   "after them"),
           "Render a part: fractions from the upper left, or pixels, ending in px")
        ->group("Image")
        ->type_name("x0,x1,y0,y1[px]");
}

void AddCompileOptions(CLI::App& app, CompileOptions* options) {
    app.add_option("--max-depth", options->maxDepth, "Limit paths to N bounces [the scene's]")
        ->group("Sampling")
        ->check(Between(0, 1000000))
        ->type_name("N");
    app.add_option("--threads", options->threads, "Render on N threads; 0: one per core")
        ->group(kCommonOptions)
        ->check(Between(0, 4096))
        ->type_name("N")
        ->capture_default_str();
}

void AddEnvironmentOptions(CLI::App& app, SceneOptions* options) {
    app.add_option("--exposure", options->exposure,
                   "Multiply the radiance by 2^EV, in the EXR as well [0]")
        ->group("Image")
        ->check(Between(-100., 100.))
        ->type_name("EV");
    auto* environment =
        app.add_option("--environment", options->environment,
                       "Replace the environment map by this latitude-longitude image")
            ->group("Scene")
            ->type_name("FILE.exr|.hdr");
    app.add_option("--environment-rotation", options->environmentRotation,
                   "Rotate the environment map, in degrees, counterclockwise from above [0]")
        ->group("Scene")
        ->needs(environment)
        ->check(Between(-360., 360.))
        ->type_name("DEG");
}

void AddStereoOptions(CLI::App& app, SceneOptions* options) {
    auto* stereo = app.add_option_function<std::string>(
                          "--stereo",
                          Checked(ParseStereo, &options->stereo,
                                  "D or D,C: the distance of the eyes, above 0, and the distance "
                                  "where both see the same"),
                          "Render a pair for two eyes, D apart, that see the same at the distance "
                          "C [parallel]")
                       ->group("Scene")
                       ->type_name("D[,C]");
    app.add_option("--eye", options->eye, "Render one eye of the pair alone")
        ->group("Scene")
        ->needs(stereo)
        ->check(CLI::IsMember({"left", "right"}))
        ->type_name("left|right");
}

void AddAnimationOptions(CLI::App& app, GltfOptions* view) {
    auto* frame = app.add_option("--frame", view->frame, "glTF: pose the animations at this time")
                      ->group("Scene")
                      ->check(Between(0., 1e9))
                      ->type_name("SECONDS");
    app.add_option("--animation", view->animation,
                   "glTF: choose one animation, by name or number from 0 [all]")
        ->group("Scene")
        ->needs(frame)
        ->type_name("NAME|N");
    app.add_option("--shutter", view->shutter,
                   "glTF: open the shutter at --frame for this time [0]")
        ->group("Scene")
        ->needs(frame)
        ->check(Between(0., 1e9))
        ->type_name("SECONDS");
}

void AddGltfOptions(CLI::App& app, GltfOptions* view) {
    auto* camera = app.add_option("--camera", view->camera,
                                  "glTF: choose the camera, by name or number from 0 [0]")
                       ->group("Scene")
                       ->type_name("NAME|N");
    app.add_option_function<std::string>(
           "--orbit",
           Checked(ParseOrbit, &view->orbit,
                   "azimuth,elevation in degrees, the elevation from -90 to 90"),
           "glTF: view the whole scene, from degrees [without a camera: 30,15]")
        ->group("Scene")
        ->excludes(camera)
        ->type_name("azimuth,elevation");
    AddAnimationOptions(app, view);
    app.add_option("--variant", view->variant,
                   "glTF: choose the material variant, by name or number; see lull info")
        ->group("Scene")
        ->type_name("NAME|N");
    app.add_flag("--solid-glass", view->solidGlass,
                 "glTF: treat transmissive surfaces without a volume as solid")
        ->group("Scene");
}

}  // namespace

void AddSceneOptions(CLI::App& app, SceneOptions* options) {
    app.add_option("SCENE", options->file,
                   "Scene to read: pbrt-v3, pbrt-v4, or glTF 2.0 (.gltf, .glb)")
        ->required();
    app.add_option("--pbrt", options->pbrt,
                   "Read the scene as for this version of pbrt [as its directives show]")
        ->group("Scene")
        ->check(CLI::IsMember({3, 4}))
        ->type_name("3|4");
    AddFilmOptions(app, &options->compile.film);
    const std::vector<std::string> integrators = IntegratorNames();
    app.add_option("--integrator", options->integrator,
                   "Find light by paths from the camera, or from lights too [the scene's]")
        ->group("Sampling")
        ->check(OneOf(integrators))
        ->type_name(fmt::format("{}", fmt::join(integrators, "|")));
    AddCompileOptions(app, &options->compile);
    app.add_flag("--substitute", options->substitute,
                 "Replace missing and unsupported parts of the scene, with warnings")
        ->group("Scene");
    app.add_flag("--verbose", options->isVerbose, "Print warnings without effect on the image, too")
        ->group("Scene");
    AddStereoOptions(app, options);
    AddEnvironmentOptions(app, options);
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

SceneInput::SceneInput(const SceneOptions& options, const FilmOptions& filmOptions,
                       const Messages& messages)
    : warnings(MakePrintedWarnings(options, messages)),
      description(LoadDescription(options, warnings)),
      film(SilentFilmSettings(description, options)),
      region(film.Region()) {
    CheckFilmFits(region, filmOptions);
}

}  // namespace lull
