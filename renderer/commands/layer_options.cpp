#include "renderer/commands/layer_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/film/splat_plane.h"
#include "renderer/render/session.h"

namespace lull {

void AddAovOptions(CLI::App& app, AovSet* wanted) {
    auto* aov =
        app.add_option_function<std::vector<std::string>>(
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
            ->type_name("albedo|normal|depth|position|object|material|alpha|cryptomatte|noise,...");
    app.add_flag("--aov-through-specular", wanted->throughSpecular,
                 "Take AOVs from the reflected or refracted surface, not from mirrors and glass")
        ->group("Output")
        ->needs(aov);
}

void CheckLayersFit(const FilmOptions& film, const PixelRect& region, int64_t more) {
    const int64_t made = BytesOfLayers(film.layers) - Layers::Bytes(film.layers) + more;
    if (made == 0 && Layers::Bytes(film.layers) == 0) return;  // CheckFilmFits() has seen to it
    CheckMemory(
        Film::Bytes(region, film) + region.Area() * made,
        fmt::format("an image of {}x{} pixels with its layers", region.Width(), region.Height()),
        "render it in parts with --crop, or smaller with --resolution");
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
                              const Scene& scene, LayerOptions layers, const PixelRect& region) {
    if (names.empty()) return {};
    LightGroups& groups = layers.groups;
    try {
        groups = MakeLightGroups(names, description, scene);
    } catch (const Error& e) {
        throw Error(std::string("--light-groups: ") + e.what());
    }
    const int64_t splats =
        IsBidirectional(scene.integrator) ? groups.Count() * int64_t(sizeof(SplatPixel)) : 0;
    CheckMemory(region.Area() * (BytesOfLayers(layers) + splats),
                fmt::format("{} light groups of {}x{} pixels", groups.Count(), region.Width(),
                            region.Height()),
                "name fewer, or render in parts with --crop");
    return groups;
}

}  // namespace lull
