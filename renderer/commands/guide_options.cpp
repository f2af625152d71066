#include "renderer/commands/guide_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "renderer/base/error.h"
#include "renderer/commands/option_values.h"

namespace lull {

void AddGuideOptions(CLI::App& app, GuideOptions* options) {
    auto* guide =
        AddChoiceOption(
            app, "--guide", &options->mode,
            "Guide paths by learned incident light; auto: where it saves time, and sample\n"
            "lights as each place sees them")
            ->group("Guiding");
    app.add_option("--guide-memory", options->megabytes,
                   "Limit the memory of the guiding distribution, in MB")
        ->group("Guiding")
        ->check(Between(2, 1 << 16))
        ->type_name("MB")
        ->needs(guide)
        ->capture_default_str();
}

void CheckGuide(const GuideOptions& options, const Scene& scene, Estimator estimator) {
    if (options.mode != GuideMode::On) return;
    if (const auto why = WhyNotGuided(scene, estimator))
        throw Error(fmt::format(
            "--guide on: {}, where paths cannot be guided; give --guide auto or off", *why));
}

}  // namespace lull
