// `lull render`: renders a scene until every block has stopped.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>

#include "renderer/commands/checkpoint_options.h"
#include "renderer/commands/command.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/render_files.h"
#include "renderer/commands/scene_options.h"
#include "renderer/input/scene_hash.h"

namespace lull {

namespace {

struct Options {
    SceneOptions scene;
    std::string output, report;  // empty: as the scene says; none
    std::string rule = defaultRule;
    int spp = 0;  // 0: as the rule says
    std::optional<int> cap;
    ScheduleOptions schedule;
    std::optional<SamplerKind> sampler;
    Estimator estimator = Estimator::Combined;
    uint64_t seed = 0;
    CheckpointOptions checkpoint;
    bool quiet = false, jsonProgress = false;
};

constexpr const char* kFooter =
    R"(Stopping rules (--stop):
  dammertz[:T]            until a block's mean error in square-root brightness is below T
  cycles:T                until every pixel of the block has an error below T
  luxtile:T               until the largest display error of the block is below T
  lnoise:T                until the visible noise in lightness (of 0 to 100) is below T
  learned[:MODEL.h5]      until a network that was trained on human judgements says so
  thresholds:FILE[:NAME]  until the spp that a thresholds file has for the block
  fixed:N                 until N samples per pixel

Files, beside each other:
  OUT.exr             linear image, with the samples per pixel in channel "spp"
  OUT.png             the same image for displays, 8-bit sRGB
  OUT.spp.png         samples per pixel of each block in false colours
  OUT.thresholds.csv  samples per pixel at which each block stopped, row by row

Examples:
  lull render scene.pbrt -o image.exr
  lull render scene.pbrt --stop dammertz:0.01 --cap 2000 --report report.json
  lull render scene.pbrt --spp 64 --resolution 400x300 --sampler sobol
  lull render scene.pbrt --checkpoint c.h5 --resume    # the same again after an interruption

Ctrl-C ends the render early and writes what there is; twice, it ends at once.
Exit codes: 0 done, 1 the input or the environment is at fault, 2 wrong usage, 130 interrupted.)";

void AddOptions(CLI::App& app, Options* o) {
    AddSceneOptions(app, &o->scene);
    app.add_option("-o,--output", o->output,
                   "Image to write, .exr or .png; both are written [the scene's file name]")
        ->check([](const std::string& file) {
            return HasImageExtension(file) ? "" : file + " ends neither in .exr nor in .png";
        })
        ->type_name("OUT.exr");
    auto* stop = app.add_option("--stop", o->rule, "When blocks stop; see below")
                     ->type_name("RULE")
                     ->capture_default_str();
    app.add_option("--spp", o->spp, "Samples per pixel, the same for all: --stop fixed:N")
        ->check(CLI::Range(1, 1 << 24))
        ->type_name("N")
        ->excludes(stop);
    app.add_option("--cap", o->cap, "Samples per pixel that no block exceeds [10000]")
        ->check(CLI::Range(1, 1 << 24))
        ->type_name("N");
    app.add_option("--pass", o->schedule.passLength, "Samples per pixel between two decisions")
        ->check(CLI::Range(1, 1 << 20))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--block", o->schedule.blockSize, "Pixels a side of the blocks")
        ->check(CLI::Range(1, 1 << 16))
        ->type_name("N")
        ->capture_default_str();

    const std::map<std::string, SamplerKind> samplers = {{"random", SamplerKind::Random},
                                                         {"sobol", SamplerKind::Sobol}};
    app.add_option_function<std::string>(
           "--sampler", [o, samplers](const std::string& s) { o->sampler = samplers.at(s); },
           "Where sample positions come from [as the scene says]")
        ->check(CLI::IsMember(samplers))
        ->type_name("random|sobol");
    const std::map<std::string, Estimator> estimators = {{"combined", Estimator::Combined},
                                                         {"pbrt-v3", Estimator::PbrtV3}};
    app.add_option_function<std::string>(
           "--estimator",
           [o, estimators](const std::string& s) { o->estimator = estimators.at(s); },
           "combined (default): least noise; pbrt-v3: the same noise as pbrt-v3's path")
        ->check(CLI::IsMember(estimators))
        ->type_name("combined|pbrt-v3");
    app.add_option("--seed", o->seed, "Another seed gives other, equally good, samples")
        ->check(CLI::NonNegativeNumber)
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--report", o->report, "Write what happened to each block as JSON")
        ->type_name("R.json");
    AddCheckpointOptions(app, &o->checkpoint);
    app.add_flag("--quiet", o->quiet, "Print only warnings, errors and the files written");
    app.add_flag("--json-progress", o->jsonProgress, "Print progress as JSON, an object a line");
    app.footer(kFooter);
}

// Returns N of "fixed:N", 0 for other rules.
int FixedSpp(const std::string& rule) {
    int spp = 0;
    if (rule.starts_with("fixed:"))
        std::from_chars(rule.data() + 6, rule.data() + rule.size(), spp);
    return spp;
}

// Makes the rule's factory and lets the schedule suit it.
CriterionFactory MakeFactory(const Options& options, const PixelRect& region,
                             ScheduleOptions* schedule) try {
    // A fixed number of samples is its own cap; with --cap the smaller of both holds.
    if (options.cap) schedule->cap = *options.cap;
    if (const int spp = FixedSpp(options.rule))
        schedule->cap = options.cap ? std::min(*options.cap, spp) : spp;

    const RuleContext context{.passSpp = std::min(schedule->passLength, schedule->cap),
                              .blockCount = int(MakeBlocks(region, *schedule).size()),
                              .sceneName = SceneName(options.scene.file),
                              .defaultModel = ""};
    const CriterionFactory factory = MakeCriterionFactory(options.rule, context);
    schedule->smallestSide = factory.smallestSide;
    return factory;
} catch (const std::logic_error& e) {
    throw Error(std::string("--stop: ") + e.what());
}

// Warns of blocks that no criterion will ever stop.
void CheckBlocks(const PixelRect& region, const ScheduleOptions& schedule, Warnings& warnings) {
    for (const Block& block : MakeBlocks(region, schedule))
        if (!block.votes && block.leader < 0)
            warnings.Add({}, fmt::format("block of less than {} pixels a side goes on to the cap, "
                                         "as it is too small to be judged",
                                         schedule.smallestSide));
}

ProgressPrinter MakePrinter(const Options& options) {
    const bool adaptive = FixedSpp(options.rule) == 0;
    const ProgressStyle style = options.jsonProgress    ? ProgressStyle::Json
                                : options.quiet         ? ProgressStyle::Silent
                                : isatty(STDERR_FILENO) ? ProgressStyle::Line
                                                        : ProgressStyle::Plain;
    return ProgressPrinter(style, adaptive, stderr);
}

void PrintSummary(const RenderResult& result, const Film& film, int cap) {
    const Savings savings = ComputeSavings(result, cap);
    fmt::print(stderr, "{}{} of {} blocks stopped, median {} spp; {} samples in {}",
               result.cancelled ? "interrupted: " : "", result.progress.stoppedBlocks,
               result.progress.blocks, result.progress.medianSpp,
               FormatCount(double(savings.samples)), FormatDuration(result.progress.seconds));
    if (!result.cancelled && savings.samples < savings.samplesAtCap)
        fmt::print(stderr, "; against {} spp everywhere {:.1f}% fewer samples, {:.1f}% less time",
                   cap, 100 * savings.SampleShare(), 100 * savings.SecondShare());
    fmt::print(stderr, "\n");
    if (const int64_t rejected = film.RejectedCount())
        fmt::print(stderr,
                   "lull: warning: {} samples were not finite or negative: taken as black\n",
                   rejected);
}

void PrintFiles(const RenderFiles& files, const RenderResult& result) {
    fmt::print("{}\n{}\n{}\n", files.exr, files.png, files.sppMap);
    if (!result.cancelled) fmt::print("{}\n", files.thresholds);
    if (!files.report.empty()) fmt::print("{}\n", files.report);
}

ExitCode RunRender(Options options) {
    if (options.spp > 0) options.rule = fmt::format("fixed:{}", options.spp);

    // Check all that can be wrong before the work begins.
    Warnings warnings = MakePrintedWarnings();
    const Description description = LoadDescription(options.scene, warnings);
    Warnings unheard;  // Compile() will give them again
    const FilmSettings filmSettings =
        MakeFilmSettings(description, options.scene.compile.film, unheard);
    const PixelRect region{filmSettings.cropMin, filmSettings.cropMax};
    CheckFilm(region);
    const CriterionFactory factory = MakeFactory(options, region, &options.schedule);
    CheckBlocks(region, options.schedule, warnings);
    const RenderFiles files =
        NameFiles(options.output.empty() ? filmSettings.filename : options.output, options.report);
    CheckWritable(files, options.scene.file);
    CheckCheckpoint(options.checkpoint);

    const std::unique_ptr<const Scene> scene =
        Compile(description, options.scene.compile, warnings);
    warnings.Summarize();

    const Provenance provenance{.version = LULL_VERSION,
                                .scene = options.scene.file,
                                .seed = options.seed,
                                .sampler = options.sampler.value_or(scene->sampler),
                                .estimator = options.estimator,
                                .criterion = factory.rule,
                                .checksum = factory.checksum,
                                .schedule = options.schedule,
                                .maxDepth = scene->maxDepth,
                                .threads = options.scene.compile.threads,
                                .substitute = options.scene.compile.substitute,
                                .resolution = filmSettings.resolution,
                                .crop = region};
    RenderIdentity identity;
    if (!options.checkpoint.file.empty()) identity = IdentityOf(provenance, SceneHash(description));
    Film film(region);
    const std::optional<RenderState> interrupted = Resume(options.checkpoint, identity, &film);

    ProgressPrinter printer = MakePrinter(options);
    CatchInterrupts();
    RenderOptions renderOptions;
    renderOptions.schedule = options.schedule;
    renderOptions.sampler = provenance.sampler;
    renderOptions.seed = options.seed;
    renderOptions.threads = options.scene.compile.threads;
    renderOptions.makeCriterion = factory.make;
    renderOptions.onProgress = [&](const RenderProgress& p) { printer.Print(p); };
    renderOptions.isCancelled = Interrupted;
    WriteCheckpoints(options.checkpoint, identity, film, &renderOptions);
    const RenderResult result = Render(SamplesOf(*scene, options.estimator), renderOptions, &film,
                                       interrupted ? &*interrupted : nullptr);
    printer.Finish(result.progress);

    if (!options.quiet) PrintSummary(result, film, options.schedule.cap);
    if (result.progress.samples == 0) return kInterrupted;  // there is nothing to write

    WriteFiles(files, *scene, film, provenance, result, warnings);
    PrintFiles(files, result);
    if (!result.cancelled && !options.checkpoint.file.empty())
        std::filesystem::remove(options.checkpoint.file);
    return result.cancelled ? kInterrupted : kDone;
}

}  // namespace

void AddRenderCommand(CLI::App& app, Command* command) {
    CLI::App* render =
        app.add_subcommand("render",
                           "Renders a scene, 20 samples per pixel a pass, until each\n"
                           "block of the image has stopped or is at the cap.");
    auto options = std::make_shared<Options>();
    AddOptions(*render, options.get());
    render->callback([=] { *command = [=] { return RunRender(*options); }; });
}

}  // namespace lull
