#include "renderer/commands/aov_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
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
               "Layers of the EXR, of what is seen first; noise is that of each pixel")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->type_name("albedo|normal|depth|position|object|material|alpha|cryptomatte|noise,...");
    app.add_flag("--aov-through-specular", wanted->throughSpecular,
                 "Of what is seen in mirrors and through glass, instead of these")
        ->needs(aov);
}

void CheckLayersFit(const AovSet& wanted, bool features, const PixelRect& region) {
    CheckMemory(region.Area() * BytesOfLayers(wanted, features),
                fmt::format("layers of {}x{} pixels", region.Width(), region.Height()),
                "render it in parts with --crop, or smaller with --resolution");
}

}  // namespace lull
