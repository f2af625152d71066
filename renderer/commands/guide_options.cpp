#include "renderer/commands/guide_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "renderer/commands/choice_option.h"
#include "renderer/commands/interrupt.h"
#include "renderer/output/progress.h"
#include "renderer/render/learning_state.h"

namespace lull {

namespace {

// Says what came of learning, in a line.
std::string Summary(const GuideFigures& f, GuideMode mode) {
    std::string text = fmt::format("guide: {}: {}", f.isUsed ? "used" : "not used", f.why);
    if (f.rounds == 0) return text;
    text += fmt::format("; learned from {} spp in {}, {:.1f} MB", f.samples,
                        FormatDuration(f.seconds), double(f.bytes) / (1 << 20));
    if (mode == GuideMode::Auto)
        text += fmt::format("; variance {:.2f} +- {:.2f}, vertices {:.2f} of those without",
                            f.variance, f.varianceError, f.vertices);
    return text;
}

Learning NotGuided(const std::string& why) {
    Learning learning;
    learning.isDone = true;
    learning.figures.why = why;
    return learning;
}

// Lets learning take a part of the time: a round takes as long as all before it and a bit more.
// When half of the time is gone nevertheless, the render goes on without.
void HeedClock(const std::function<double()>& clock, LearningOptions* options) {
    constexpr double kStartsNoRound = 0.05, kGivesUp = 0.5;
    const double all = clock();
    options->isEnough = [=] { return all - clock() > kStartsNoRound * all; };
    options->isCancelled = [=] { return Interrupted() || all - clock() > kGivesUp * all; };
}

}  // namespace

void AddGuideOptions(CLI::App& app, GuideOptions* options) {
    auto* guide = AddChoiceOption<GuideMode>(
        app, "--guide", &options->mode,
        {{"off", GuideMode::Off}, {"auto", GuideMode::Auto}, {"on", GuideMode::On}}, "off|auto|on",
        "Learn where light comes from and send paths there; auto: where a trial in\n"
        "the scene shows that it pays, for renders of many samples");
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

std::optional<Learning> LearnGuide(const GuideOptions& options, const LearningContext& context) {
    if (options.mode == GuideMode::Off) return NotGuided("");
    const RenderSettings& settings = context.settings;
    CheckGuide(options, context.scene, settings.estimator);
    if (const auto why = WhyNotGuided(context.scene, settings.estimator)) return NotGuided(*why);
    LearningOptions learningOptions{.mode = options.mode,
                                    .megabytes = options.megabytes,
                                    .sampler = context.sampler,
                                    .seed = settings.seed,
                                    .threads = settings.scene.compile.threads,
                                    .cap = settings.schedule.cap,
                                    .isCancelled = Interrupted,
                                    .isEnough = {}};
    // Several ranks have to come to the same.
    if (context.ranks > 1)
        learningOptions.isCancelled = {};
    else if (context.clock)
        HeedClock(context.clock, &learningOptions);
    Learning learning;
    if (!context.kept.empty()) try {
            learning = RestoreLearning(context.kept);
        } catch (const std::runtime_error& e) {
            throw Error(settings.checkpoint.file + ": " + e.what());
        }
    const bool isNew = !learning.isDone;
    if (isNew && !settings.quiet && !settings.jsonProgress)
        fmt::print(stderr, "lull: learning where light comes from\n");
    const auto onRound = [&](const Learning& l) {
        if (context.keep) context.keep(SaveLearning(l));
    };
    if (!Learn(context.scene, context.region, learningOptions, &learning, onRound)) {
        if (Interrupted()) return {};
        learning = NotGuided("the time did not suffice for learning");
    }
    if (isNew && !settings.quiet && !settings.jsonProgress)
        fmt::print(stderr, "lull: {}\n", Summary(learning.figures, options.mode));
    return learning;
}

}  // namespace lull
