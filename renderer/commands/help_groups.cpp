#include "renderer/commands/help_groups.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lull {

namespace {

constexpr std::array<std::string_view, 11> kCommon = {
    "output", "resolution", "denoise",    "stop",   "cap",    "spp",
    "time",   "report",     "checkpoint", "resume", "threads"};

struct Subject {
    const char* name;
    std::array<std::string_view, 12> options;  // long names
};
constexpr Subject kSubjects[] = {
    {"Scene",
     {"camera", "orbit", "frame", "frames", "animation", "shutter", "variant", "solid-glass",
      "environment", "environment-rotation", "substitute", "verbose"}},
    {"Image", {"resolution", "crop", "exposure", "tone-map", "ocio", "view", "transparent"}},
    {"Sampling", {"spp", "sampler", "seed", "integrator", "max-depth"}},
    {"Stopping", {"stop", "cap", "caution", "pass", "block"}},
    {"Denoising", {"denoise", "denoise-layers"}},
    {"Guiding", {"guide", "guide-memory"}},
    {"Output",
     {"output", "report", "aov", "aov-through-specular", "light-groups", "png-bits", "exr-half",
      "display", "preview", "quiet", "json-progress"}},
    {"Interruption",
     {"time", "until", "checkpoint", "checkpoint-interval", "resume", "keep-checkpoint"}},
    {"Advanced", {"threads", "estimator", "filtering", "pixel", "sample", "help", "help-all"}}};
constexpr const char* kOwn = "Options";  // the group of CLI11 for all others

bool HasName(const CLI::Option& option, std::string_view name) {
    return std::ranges::find(option.get_lnames(), name) != option.get_lnames().end();
}

// Returns the options with these names, in their order; "" is none.
std::vector<const CLI::Option*> OptionsNamed(const CLI::App& app,
                                             std::span<const std::string_view> names) {
    std::vector<const CLI::Option*> found;
    for (const std::string_view name : names)
        for (const CLI::Option* option : app.get_options())
            if (!name.empty() && HasName(*option, name)) found.push_back(option);
    return found;
}

class GroupFormatter : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        std::string text = make_description(app) + make_usage(app, name) + make_positionals(app);
        const auto append = [&](const char* title, const std::vector<const CLI::Option*>& options) {
            if (!options.empty()) text += make_group(title, false, options);
        };
        append(kOwn, app->get_options([](const CLI::Option* option) {
            return option->nonpositional() && option->get_group() == kOwn;
        }));
        if (mode == CLI::AppFormatMode::All) {
            for (const Subject& subject : kSubjects)
                append(subject.name, OptionsNamed(*app, subject.options));
        } else {
            append("Common options", OptionsNamed(*app, kCommon));
            text += fmt::format("\nlull {} --help-all lists all options.\n", app->get_name());
        }
        return text + '\n' + make_footer(app);
    }
};

}  // namespace

void GroupOptions(CLI::App* command) {
    command->set_help_flag("-h,--help", "Print the common options and exit");
    command->set_help_all_flag("--help-all", "Print all options and exit");
    if (!command->get_option_no_throw("--resolution")) return;
    for (CLI::Option* option : command->get_options())
        for (const Subject& subject : kSubjects)
            for (const std::string_view name : subject.options)
                if (!name.empty() && HasName(*option, name)) option->group(subject.name);
    command->formatter(std::make_shared<GroupFormatter>());
}

}  // namespace lull
