#include "renderer/commands/guide_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "renderer/base/error.h"
#include "renderer/commands/choice_option.h"

namespace lull {

void AddGuideOptions(CLI::App& app, GuideOptions* options) {
    auto* guide = AddChoiceOption(
        app, "--guide", &options->mode,
        "Learn from the image's samples where light comes from and send paths there;\n"
        "auto: blocks that go on for long try it, and keep to it where it pays");
    app.add_option("--guide-memory", options->megabytes, "MB that what is learned may take")
        ->check(CLI::Range(2, 1 << 16))
        ->type_name("MB")
        ->needs(guide)
        ->capture_default_str();
}

void CheckGuide(const GuideOptions& options, const Scene& scene, Estimator estimator) {
    if (options.mode != GuideMode::On) return;
    if (const auto why = WhyNotGuided(scene, estimator))
        throw Error(fmt::format(
            "--guide on: {}, and paths are not guided there; give --guide auto or off", *why));
}

}  // namespace lull
