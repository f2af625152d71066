#include "renderer/commands/scene_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "renderer/base/memory.h"
#include "renderer/base/say.h"
#include "renderer/commands/choice_option.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/input/scene_edits.h"
#include "renderer/render/provenance.h"

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
           "Size of the whole image in pixels, WxH, instead of the scene's; glTF: 800 high, as\n"
           "wide as its camera sees")
        ->type_name("WxH");
    app.add_option_function<std::string>(
           "--crop",
           Checked(ParseCrop, film,
                   "x0,x1,y0,y1 with 0 <= x0 < x1 <= 1 and the same for y, or in pixels with px "
                   "after them"),
           "Render only this part of the image, as fractions of its sides from the upper left,\n"
           "or as pixels: 100,300,50,250px")
        ->type_name("x0,x1,y0,y1[px]");
}

void AddCompileOptions(CLI::App& app, CompileOptions* options) {
    app.add_option("--max-depth", options->maxDepth,
                   "Longest path in bounces, instead of the scene's")
        ->check(CLI::Range(0, 1000000))
        ->type_name("N");
    app.add_option("--threads", options->threads, "Threads; 0: one for each core")
        ->check(CLI::Range(0, 4096))
        ->type_name("N")
        ->capture_default_str();
    AddChoiceOption(
        app, "--filtering", &options->filtering,
        "Look up image textures on their finest level, or as pbrt-v3 does where the camera\n"
        "sees them: trilinear or EWA, from smaller copies, which need memory");
}

void AddEnvironmentOptions(CLI::App& app, SceneOptions* options) {
    app.add_option("--exposure", options->exposure,
                   "Exposure compensation in stops: multiply all values by 2^EV, also in the EXR,\n"
                   "whose header records it [0]")
        ->check(CLI::Range(-100., 100.))
        ->type_name("EV");
    auto* environment =
        app.add_option(
               "--environment", options->environment,
               "Replace the environment map by this latitude-longitude image of radiance; its\n"
               "top is glTF's +y, or the axis nearest to the camera's up vector")
            ->type_name("FILE.exr|.hdr");
    app.add_option("--environment-rotation", options->environmentRotation,
                   "Rotate it by DEG degrees, counterclockwise as seen from the top [0]")
        ->needs(environment)
        ->check(CLI::Range(-360., 360.))
        ->type_name("DEG");
}

void AddAnimationOptions(CLI::App& app, GltfOptions* view) {
    auto* frame = app.add_option("--frame", view->frame,
                                 "glTF: pose nodes, skins, morph targets and cameras as the file's "
                                 "animation\nhas them at this time")
                      ->check(CLI::Range(0., 1e9))
                      ->type_name("SECONDS");
    app.add_option("--animation", view->animation,
                   "glTF: the animation of this name or number, from 0 [the first one]")
        ->needs(frame)
        ->type_name("NAME|N");
    app.add_option("--shutter", view->shutter,
                   "glTF: blur what moves, nodes and cameras, from then on for so long")
        ->needs(frame)
        ->check(CLI::Range(0., 1e9))
        ->type_name("SECONDS");
}

void AddGltfOptions(CLI::App& app, GltfOptions* view) {
    auto* camera = app.add_option("--camera", view->camera,
                                  "glTF: look through the camera of this name or number, from 0")
                       ->type_name("NAME|N");
    app.add_option_function<std::string>(
           "--orbit",
           Checked(ParseOrbit, &view->orbit,
                   "azimuth,elevation in degrees, the elevation from -90 to 90"),
           "glTF: show the whole scene, seen from this direction [without a camera: 30,15]")
        ->excludes(camera)
        ->type_name("azimuth,elevation");
    AddAnimationOptions(app, view);
    app.add_option("--variant", view->variant,
                   "glTF: use the materials of this variant, a name or number, from 0, that `lull\n"
                   "info` lists")
        ->type_name("NAME|N");
    app.add_flag("--solid-glass", view->solidGlass,
                 "glTF: let all that transmits light be solid; without a volume's thickness it is\n"
                 "a thin sheet, as the format says");
}

}  // namespace

void AddSceneOptions(CLI::App& app, SceneOptions* options) {
    app.add_option("SCENE", options->file, "The scene: a pbrt-v3 file, or glTF 2.0 (.gltf, .glb)")
        ->required();
    AddFilmOptions(app, &options->compile.film);
    AddCompileOptions(app, &options->compile);
    app.add_flag("--substitute", options->substitute,
                 "Continue with substitutes for names, files, materials, textures, shapes and\n"
                 "lights that are missing or not modelled, each with a warning, as pbrt-v3 does");
    app.add_flag("--verbose", options->isVerbose,
                 "Print warnings that do not concern the image as well, as of zero-area triangles");
    AddEnvironmentOptions(app, options);
    AddGltfOptions(app, &options->view);
}

Warnings MakePrintedWarnings(const SceneOptions& options, const Talk& talk) {
    return Warnings([talk](const std::string& message) { talk.Say("warning", message); },
                    options.substitute, options.isVerbose);
}

Description LoadDescription(const SceneOptions& options, Warnings& warnings) {
    const bool isGltf = IsGltf(options.file);
    if (!isGltf && options.view.IsGiven())
        throw Error(
            options.file +
            ": is no glTF file; --camera, --orbit, --frame, --variant and --solid-glass are "
            "for these, as a pbrt-v3 scene says all of that itself");
    Description description = isGltf ? ParseGltf(options.file, options.view, warnings)
                                     : ParsePbrt(options.file, warnings);
    if (options.exposure != 0) SetExposure(options.exposure, &description);
    if (!options.environment.empty())
        SetEnvironment(options.environment, options.environmentRotation, &description);
    if (isGltf) LightIfDark(&description, warnings);
    return description;
}

void CheckFilmFits(const PixelRect& region, const FilmOptions& options) {
    CheckMemory(Film::Bytes(region, options),
                fmt::format("an image of {}x{} pixels", region.Width(), region.Height()),
                "render it in parts with --crop, or smaller with --resolution");
}

SceneInput::SceneInput(const SceneOptions& options, const FilmOptions& filmOptions,
                       const Talk& talk)
    : warnings(MakePrintedWarnings(options, talk)),
      description(LoadDescription(options, warnings)),
      film(SilentFilmSettings(description, options)),
      region{film.cropMin, film.cropMax} {
    CheckFilmFits(region, filmOptions);
}

}  // namespace lull
