#include "renderer/commands/output_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <set>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/commands/command.h"
#include "renderer/image/grade.h"

namespace lull {

void AddPictureOptions(CLI::App& app, PictureOptions* options) {
    AddChoiceOption(app, "--tone-map", &options->format.grade.toneMap,
                    "Map the tones of the PNG; filmic keeps highlights up to 5.6 times white")
        ->group("Image");
    CLI::Option* toneMap = app.get_option("--tone-map");
    app.add_option("--ocio", options->ocio,
                   "Map the PNG by a view of this OpenColorIO configuration [with --view: $OCIO]")
        ->group("Image")
        ->type_name("CONFIG.ocio")
        ->excludes(toneMap);
    app.add_option("--view", options->view, "Choose OpenColorIO's view [that of the configuration]")
        ->group("Image")
        ->type_name("NAME")
        ->excludes(toneMap);
    app.add_option("--view-exposure", options->format.grade.exposure,
                   "Brighten the PNG by EV stops, and judge noise in it as it is shown")
        ->group("Image")
        ->check(Between(-100.f, 100.f))
        ->type_name("EV")
        ->capture_default_str();
    app.add_option("--png-bits", options->format.pngBits, "Set the bits per channel of the PNG")
        ->group("Output")
        ->check(OneOf(std::set{8, 16}))
        ->type_name("8|16")
        ->capture_default_str();
    app.add_flag("--exr-half", options->format.exrHalf,
                 "Write colours and normals of the EXR with 16 bits, up to 65504")
        ->group("Output");
    app.add_option("--display", options->display, "Show the render live in tev at this address")
        ->group("Output")
        ->check([](const std::string& text) -> std::string {
            try {
                ParseDisplayAddress(text);
                return "";
            } catch (const Error& e) {
                return e.what();
            }
        })
        ->type_name("HOST:PORT");
    app.add_option("--preview", options->preview, "Write the current image every SECONDS")
        ->group("Output")
        ->check(Between(0.1, 1e6))
        ->type_name("SECONDS");
}

void LoadView(PictureOptions* options) {
    if (options->ocio || options->view)
        options->format.grade.view =
            LoadView(options->ocio.value_or(""), options->view.value_or(""));
}

std::unique_ptr<Display> MakeDisplay(const PictureOptions& options, const std::string& name,
                                     const PixelRect& region, int ranks, const Messages& messages) {
    if (options.display.empty()) return nullptr;
    if (ranks > 1)
        throw Error("--display: needs one process, as no rank has the whole image before the end");
    CheckMemory(region.Area() * int64_t(5 * sizeof(float) + 1),
                fmt::format("--display of {}x{} pixels", region.Width(), region.Height()),
                "leave it out");
    return std::make_unique<Display>(
        ParseDisplayAddress(options.display), name, region,
        [messages](const std::string& message) { messages.Warn(message); });
}

void AddAovOptions(CLI::App& app, AovSet* wanted) {
    auto* aov = app.add_option_function<std::vector<std::string>>(
                       "--aov",
                       [=](const std::vector<std::string>& names) {
                           try {
                               const bool throughSpecular = wanted->throughSpecular;
                               *wanted = ParseAovs(names);
                               wanted->throughSpecular = throughSpecular;
                           } catch (const Error& e) {
                               throw CLI::ValidationError("--aov", e.what());
                           }
                       },
                       "Write these AOVs of the first hits to the EXR")
                    ->group("Output")
                    ->delimiter(',')
                    ->allow_extra_args(false)
                    ->type_name(AllAovs("|") + ",...");
    app.add_flag("--aov-through-specular", wanted->throughSpecular,
                 "Take AOVs from the reflected or refracted surface, not from mirrors and glass")
        ->group("Output")
        ->needs(aov);
}

void AddLightGroupOption(CLI::App& app, std::vector<std::string>* names) {
    app.add_option(
           "--light-groups", *names,
           "Write the light of these lamps, objects, materials or kinds as layers; each: all")
        ->group("Output")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAME,...|each");
}

LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description& description,
                              const Scene& scene) {
    if (names.empty()) return {};
    try {
        return MakeLightGroups(names, description, scene);
    } catch (const Error& e) {
        throw Error(std::string("--light-groups: ") + e.what());
    }
}

}  // namespace lull
