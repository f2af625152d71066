#include "renderer/commands/guide_options.h"

#include <CLI/CLI.hpp>

#include "renderer/commands/choice_option.h"

namespace lull {

void AddGuideOptions(CLI::App& app, GuideOptions* options) {
    auto* guide = AddChoiceOption<GuideMode>(
        app, "--guide", &options->mode,
        {{"off", GuideMode::Off}, {"auto", GuideMode::Auto}, {"on", GuideMode::On}}, "off|auto|on",
        "Learn from the image's samples where light comes from and send paths there;\n"
        "auto: blocks that go on for long try it, and keep to it where it pays");
    app.add_option("--guide-memory", options->megabytes, "MB that what is learned may take")
        ->check(CLI::Range(2, 1 << 16))
        ->type_name("MB")
        ->needs(guide)
        ->capture_default_str();
}

}  // namespace lull
