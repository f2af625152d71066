#include "renderer/lab/commands/lab_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "renderer/base/error.h"

namespace lull {

void AddSplitOption(CLI::App& app, std::string* file, const std::string& help) {
    const std::string kind = "paper:";
    app.add_option_function<std::string>(
           "--split",
           [=](const std::string& text) {
               if (!text.starts_with(kind) || text.size() == kind.size())
                   throw CLI::ValidationError("--split", text + " is not paper:FILE");
               *file = text.substr(kind.size());
           },
           help)
        ->type_name("paper:FILE");
}

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

void AllowOnly(const CLI::App& app, std::span<const char* const> names, const std::string& where) {
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        const bool isAllowed =
            std::ranges::any_of(names, [&](std::string_view allowed) { return name == allowed; });
        if (option->count() > 0 && !isAllowed)
            throw CLI::ValidationError(name, "has no effect " + where);
    }
}

}  // namespace lull
