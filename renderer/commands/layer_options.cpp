#include "renderer/commands/layer_options.h"

#include <CLI/CLI.hpp>

#include "renderer/base/error.h"

namespace lull {

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
