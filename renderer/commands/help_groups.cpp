#include "renderer/commands/help_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace lull {

namespace {

constexpr const char* kCommon = "Common options";
constexpr const char* kOwn = "Options";  // CLI11's group of those that are in no other

struct HelpGroup {
    const char* name;
    std::array<const char*, 12> options;  // their long names
};
constexpr HelpGroup kGroups[] = {
    {kCommon,
     {"output", "denoise", "stop", "spp", "resolution", "threads", "report", "time", "checkpoint",
      "resume", "quiet", "help"}},
    {"Scene",
     {"substitute", "filtering", "environment", "environment-rotation", "camera", "orbit", "frame",
      "animation", "shutter", "variant", "solid-glass", "verbose"}},
    {"Image",
     {"crop", "exposure", "tone-map", "png-bits", "exr-half", "transparent", "aov",
      "aov-through-specular", "denoise-layers"}},
    {"Sampling",
     {"sampler", "seed", "estimator", "max-depth", "guide", "guide-memory", "pixel", "sample"}},
    {"Stopping", {"caution", "cap", "pass", "block", "until"}},
    {"Progress and interruption",
     {"preview", "display", "json-progress", "checkpoint-interval", "keep-checkpoint"}}};

// Returns the group of an option; nullptr where it is of one command alone.
const char* GroupOf(const CLI::Option& option) {
    for (const HelpGroup& group : kGroups)
        for (const char* name : group.options)
            if (name && std::ranges::count(option.get_lnames(), name) > 0) return group.name;
    return nullptr;
}

// Leaves the groups of subjects to --help-all.
class GroupFormatter : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        if (mode != CLI::AppFormatMode::Normal)
            return CLI::Formatter::make_help(app, std::move(name), mode);
        const auto optionsOf = [&](auto&& isWanted) {
            return app->get_options([&](const CLI::Option* option) {
                return option->nonpositional() && isWanted(option->get_group());
            });
        };
        std::string text = make_description(app) + make_usage(app, name) + make_positionals(app);
        for (const std::string group : {kCommon, kOwn}) {
            const auto options = optionsOf([&](const std::string& of) { return of == group; });
            if (!options.empty()) text += make_group(group, false, options);
        }
        text += fmt::format("\nlull {} --help-all lists all options.\n", app->get_name());
        return text + '\n' + make_footer(app);
    }
};

}  // namespace

void GroupOptions(CLI::App* command) {
    command->set_help_all_flag("--help-all", "Print this help with all options and exit")
        ->group(kCommon);
    for (CLI::Option* option : command->get_options())
        if (const char* group = GroupOf(*option)) option->group(group);
    command->formatter(std::make_shared<GroupFormatter>());
}

}  // namespace lull
