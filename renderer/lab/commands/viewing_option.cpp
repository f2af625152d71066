#include "renderer/lab/commands/viewing_option.h"

#include <CLI/CLI.hpp>

#include "renderer/base/error.h"

namespace lull {

void AddViewingOption(CLI::App& app, DisplayModel* display) {
    app.add_option_function<std::string>(
           "--viewing",
           [display](const std::string& text) {
               try {
                   *display = ParseDisplay(text);
               } catch (const Error& e) {
                   throw CLI::ValidationError("--viewing", e.what());
               }
           },
           "Display for visible differences: peak luminance in cd/m2, pixels per degree\n"
           "and ambient light in lux [" +
               NameOf(DisplayModel()) + "]")
        ->type_name("Lcd,Nppd,Elux");
}

}  // namespace lull
