#include "renderer/commands/aov_options.h"

#include <CLI/CLI.hpp>

#include "renderer/base/error.h"

namespace lull {

void AddAovOptions(CLI::App& app, AovSet* wanted) {
    auto* aov =
        app.add_option_function<std::string>(
               "--aov",
               [=](const std::string& names) {
                   try {
                       const bool throughSpecular = wanted->throughSpecular;
                       *wanted = ParseAovs(names);
                       wanted->throughSpecular = throughSpecular;
                   } catch (const Error& e) {
                       throw CLI::ValidationError("--aov", e.what());
                   }
               },
               "Layers of the EXR, of what is seen first; noise is that of each pixel")
            ->type_name("albedo|normal|depth|position|object|material|alpha|cryptomatte|noise,...");
    app.add_flag("--aov-through-specular", wanted->throughSpecular,
                 "Of what is seen in mirrors and through glass, instead of these")
        ->needs(aov);
}

}  // namespace lull
