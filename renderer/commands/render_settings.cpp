#include "renderer/commands/render_settings.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>

#include "renderer/base/memory.h"
#include "renderer/commands/command.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"

namespace lull {

SamplerKind DefaultSampler(Purpose purpose, Estimator estimator, const Scene& scene) {
    if (purpose == Purpose::Recording) return SamplerKind::Random;
    return estimator == Estimator::Combined ? SamplerKind::SobolHalves : scene.sampler;
}

void AddEstimatorOption(CLI::App& app, Estimator* estimator) {
    AddChoiceOption(app, "--estimator", estimator,
                    "Estimate light with least noise, or with the noise of pbrt-v3")
        ->group("Advanced");
}

CLI::Option* AddCautionOption(CLI::App& app, double* caution) {
    const std::string rules = RuleNames([](const RuleEntry& rule) { return rule.takesCaution; });
    return app
        .add_option("--caution", *caution,
                    "Allow 1/X of the noise with " + rules +
                        ": multiply the noise that networks receive by X, divide limits by X")
        ->check(Between(0.01, 100.0))
        ->type_name("X")
        ->capture_default_str();
}

void AddRenderSettings(CLI::App& app, RenderSettings* s) {
    AddSceneOptions(app, &s->scene);
    app.add_option("--cap", s->cap, "Stop every block at N spp at the latest [10000]")
        ->group(kCommonOptions)
        ->check(Between(1, 1 << 24))
        ->type_name("N");
    app.add_option("--pass", s->schedule.passLength, "Decide every N spp")
        ->group("Stopping")
        ->check(Between(1, 1 << 20))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--block", s->schedule.blockSize, "Set the side of the blocks, in pixels")
        ->group("Stopping")
        ->check(Between(1, 1 << 16))
        ->type_name("N")
        ->capture_default_str();

    AddChoiceOption(app, "--sampler", &s->sampler,
                    "Choose the sampler [sobol-halves; by --estimator pbrt-v3 the scene's; study:\n"
                    "random]")
        ->group("Sampling");
    AddEstimatorOption(app, &s->estimator);
    app.add_option("--seed", s->seed, "Seed the random numbers")
        ->group("Sampling")
        ->check(WholeNumber())
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--quiet", s->quiet, "Print only warnings, errors and the names of files")
        ->group("Output");
    app.add_flag("--json-progress", s->jsonProgress,
                 "Print events as JSON, one object per line, on stderr")
        ->group("Output");
}

std::unique_ptr<const Scene> CompileScene(const RenderSettings& settings, SceneInput* input) {
    CompileOptions options = settings.scene.compile;
    options.lightsAsPbrtV3 = settings.estimator == Estimator::PbrtV3;
    auto scene = Compile(input->description, options, input->warnings);
    input->warnings.Summarize();
    MoveIntoLargePages();
    return scene;
}

bool IsRule(const std::string& rule, std::string_view name) {
    const RuleEntry* entry = FindRule(rule);
    return entry && entry->name == name;
}

int FixedSpp(const std::string& rule) {
    if (!IsRule(rule, "fixed")) return 0;
    const std::string argument = ArgumentOf(rule);
    int spp = 0;
    std::from_chars(argument.data(), argument.data() + argument.size(), spp);
    return spp;
}

std::string ModelFolder() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    return (program.parent_path().parent_path() / "share/lull/models").string();
}

Rule ReadRuleOption(const std::string& option, const std::string& rule,
                    const RenderSettings& settings, const PixelRect& region,
                    std::map<std::string, SignalMeasure> measures) try {
    if (IsRule(rule, kDenoisedRuleName) && measures.empty())
        throw UsageError(
            option + " " + rule +
            ": needs --denoise of lull render; lull compare --denoise adds a denoised image");
    const ScheduleOptions& schedule = settings.schedule;
    const RuleContext context{.passSpp = schedule.passLength,
                              .blockCount = int(MakeBlocks(region, schedule).size()),
                              .cap = schedule.cap,
                              .sceneName = SceneName(settings.scene.file),
                              .models = ModelFolder(),
                              .caution = settings.caution,
                              .measures = std::move(measures)};
    return ParseRule(rule, context);
} catch (const std::logic_error& e) {
    throw UsageError(option + ": " + e.what());
}

Provenance MakeProvenance(const RenderSettings& settings, const Scene& scene,
                          const FilmSettings& film) {
    return {.version = LULL_VERSION,
            .scene = settings.scene.file,
            .seed = settings.seed,
            .sampler = settings.sampler.value(),
            .estimator = settings.estimator,
            .criterion = "",
            .checksum = "",
            .schedule = settings.schedule,
            .maxDepth = MaxDepth(scene.integrator),
            .integrator = std::holds_alternative<PathIntegrator>(scene.integrator)
                              ? ""
                              : NameOf(scene.integrator, scene.isVolumetric),
            .threads = settings.scene.compile.threads,
            .substitute = settings.scene.substitute,
            .resolution = film.resolution,
            .crop = {film.cropMin, film.cropMax}};
}

ProgressPrinter MakePrinter(const RenderSettings& settings, bool adaptive) {
    return ProgressPrinter(StyleOfReports(settings.jsonProgress, settings.quiet), adaptive, stderr);
}

}  // namespace lull
