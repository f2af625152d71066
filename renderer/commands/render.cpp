// `lull render`: renders a scene until every block has stopped.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "renderer/commands/clock_options.h"
#include "renderer/commands/command.h"
#include "renderer/commands/guide_options.h"
#include "renderer/commands/half_buffer.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/render_files.h"
#include "renderer/commands/render_settings.h"
#include "renderer/input/scene_hash.h"
#include "renderer/measure/shortfall.h"
#include "renderer/ranks/job.h"
#include "renderer/render/learning_state.h"
#include "renderer/render/time_limit.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

struct Options {
    RenderSettings render;
    ClockOptions clock;
    GuideOptions guide;
    HalfBuffer halfBuffer = HalfBuffer::Auto;
    std::string output, report;  // empty: as the scene says; none
    std::string rule = defaultRule;
    int spp = 0;  // 0: as the rule says
    AovSet aovs;
    PictureOptions pictures;
};

constexpr const char* kFooter =
    R"(Files, beside each other:
  OUT.exr             linear image, with the samples per pixel in channel "spp"
  OUT.png             the same image for displays, 8-bit sRGB
  OUT.spp.png         samples per pixel of each block in false colours
  OUT.thresholds.csv  samples per pixel at which each block stopped, row by row
  OUT.ranges.csv      between which samples per pixel people would have stopped each block, in 80 of
                      100 cases, where the model of the rule knows; also in the report

Examples:
  lull render scene.pbrt -o image.exr
  lull render scene.pbrt --stop lnoise:0.3 --cap 2000 --report report.html
  lull render scene.pbrt --spp 64 --resolution 400x300 --sampler sobol
  lull render scene.pbrt --checkpoint c.h5 --resume    # the same again after an interruption
  lull render scene.pbrt --until 09:00                 # as clean as it gets until then
  mpirun -n 4 lull render scene.pbrt                   # on several machines, if built with MPI

With --time or --until, blocks stop as without; when that is not enough for all, the worst is as
good as it can be. Every block gets its first pass, even if that takes longer. How many samples
the others got depends on the machine: --stop thresholds:OUT.thresholds.csv repeats the image. A
checkpoint is kept, to go on from.

Ctrl-C ends the render early and writes what there is; twice, it ends at once.
Exit codes: 0 done, 1 the input or the environment is at fault, 2 wrong usage, 130 interrupted.)";

void AddOptions(CLI::App& app, Options* o) {
    AddRenderSettings(app, &o->render);
    app.add_option("-o,--output", o->output,
                   "Image to write, .exr or .png; both are written [the scene's file name]")
        ->check([](const std::string& file) {
            return HasImageExtension(file) ? "" : file + " ends neither in .exr nor in .png";
        })
        ->type_name("OUT.exr");
    auto* stop = app.add_option("--stop", o->rule, "When blocks stop; see below")
                     ->type_name("RULE")
                     ->capture_default_str();
    AddCautionOption(app, &o->render.caution);
    app.add_option("--spp", o->spp, "Samples per pixel, the same for all: --stop fixed:N")
        ->check(CLI::Range(1, 1 << 24))
        ->type_name("N")
        ->excludes(stop);
    app.add_option("--report", o->report,
                   "Write what happened to each block: .html to look at, else JSON")
        ->type_name("R.html|R.json");
    AddGuideOptions(app, &o->guide);
    AddAovOptions(app, &o->aovs);
    AddPictureOptions(app, &o->pictures);
    AddClockOptions(app, &o->clock);
    AddCheckpointOptions(app, &o->render.checkpoint);
    AddHalfBufferOption(app, &o->halfBuffer);
    app.footer("Stopping rules (--stop); a block stops\n" + RuleHelp(100) + "\n" + kFooter);
}

// Reads the rule and lets the schedule suit it.
CriterionFactory ReadRule(const Options& options, const PixelRect& region,
                          RenderSettings* settings) {
    // A fixed number of samples is its own cap; with --cap the smaller of both holds.
    if (settings->cap) settings->schedule.cap = *settings->cap;
    if (const int spp = FixedSpp(options.rule))
        settings->schedule.cap = settings->cap ? std::min(*settings->cap, spp) : spp;
    const CriterionFactory factory = ReadRule("--stop", options.rule, *settings, region);
    settings->schedule.smallestSide = factory.smallestSide;
    return factory;
}

// Warns of blocks that no criterion will ever stop.
void CheckBlocks(const PixelRect& region, const ScheduleOptions& schedule, Warnings& warnings) {
    for (const Block& block : MakeBlocks(region, schedule))
        if (!block.votes && block.leader < 0)
            warnings.Add({}, fmt::format("block of less than {} pixels a side goes on to the cap, "
                                         "as it is too small to be judged",
                                         schedule.smallestSide));
}

void PrintSummary(const RenderResult& result, const Film& film, int cap) {
    const Savings savings = ComputeSavings(result, cap);
    fmt::print(stderr, "{}{} of {} blocks stopped, median {} spp; {} samples in {}",
               result.cancelled ? "interrupted: "
               : result.timeUp  ? "the time is up: "
                                : "",
               result.progress.stoppedBlocks, result.progress.blocks, result.progress.medianSpp,
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

// Says how much ranks of different speed had to do in the end.
void PrintShares(const std::vector<double>& shares) {
    const auto [least, most] = std::ranges::minmax(shares);
    if (most - least < 0.01) return;
    fmt::print(stderr, "shares of the ranks at the end, in percent:");
    for (const double share : shares) fmt::print(stderr, " {:.0f}", 100 * share);
    fmt::print(stderr, "\n");
}

// Says what was missing when the time was up.
void PrintShortfall(const Provenance& provenance, const RenderResult& result) {
    constexpr size_t shown = 8;
    const std::vector<NoisyBlock> noisy = FindShortfall(provenance, result);
    if (noisy.empty()) return;
    fmt::print(stderr, "not stopped, and the noise that is visible, in lightness of 0 to 100:\n");
    for (size_t i = 0; i < std::min(shown, noisy.size()); ++i) {
        const Block& block = result.blocks[size_t(noisy[i].block)].block;
        fmt::print(stderr, "  block {} at {},{}: {:.2f} at {} spp; probably until {} spp, {}\n",
                   noisy[i].block, block.pixels.min.x(), block.pixels.min.y(), noisy[i].noise,
                   block.spp, noisy[i].neededSpp,
                   FormatDuration(NeededSeconds({noisy[i]}, result)));
    }
    if (noisy.size() > shown)
        fmt::print(stderr, "  and {} more, of {:.2f} or less\n", noisy.size() - shown,
                   noisy[shown].noise);
    fmt::print(stderr, "about {} more would have been enough for all\n",
               FormatDuration(NeededSeconds(noisy, result)));
}

void PrintFiles(const RenderFiles& files, const RenderResult& result) {
    fmt::print("{}\n{}\n{}\n", files.exr, files.png, files.sppMap);
    if (!result.cancelled) fmt::print("{}\n", files.thresholds);
    if (!result.cancelled && !files.ranges.empty()) fmt::print("{}\n", files.ranges);
    if (!files.report.empty()) fmt::print("{}\n", files.report);
}

bool IsHtml(const std::string& report) { return report.ends_with(".html"); }

// Makes the criteria; for a page, they also keep the curves of each block.
std::function<std::unique_ptr<Criterion>(const BlockInfo&)> MakeCriteria(
    const CriterionFactory& factory, bool withCurves, std::vector<BlockHistory>* histories) {
    if (!withCurves) return factory.make;
    return [=, &factory](const BlockInfo& info) {
        std::vector<std::unique_ptr<Criterion>> rules;
        rules.push_back(factory.make(info));
        return std::make_unique<BlockObserver>(std::move(rules), ObserverOptions{.curves = true},
                                               &(*histories)[size_t(info.index)]);
    };
}

// Lets learning write checkpoints, where they are wanted.
std::function<void(std::span<const std::byte>)> KeepsLearning(const CheckpointOptions& options,
                                                              const RenderIdentity& identity,
                                                              bool leads) {
    if (options.file.empty() || !leads) return {};
    return [&](std::span<const std::byte> guide) {
        WriteLearningCheckpoint(options, identity, guide);
    };
}

HalfUse UseOfHalf(const Options& options, const CriterionFactory& factory, bool withCurves) {
    const RenderSettings& settings = options.render;
    return {.rule = LooksAtHalf(factory, settings.schedule) ? factory.rule : "",
            .clock = !options.clock.Text().empty(),
            .page = withCurves,
            .checkpoint = !settings.checkpoint.file.empty()};
}

ExitCode RunRender(Options options, Job* job) {
    if (options.spp > 0) options.rule = fmt::format("fixed:{}", options.spp);
    RenderSettings& settings = options.render;
    const bool leads = job->Rank() == 0;  // prints, and has to do with files
    const std::function<double()> clock = StartClock(options.clock);

    // Check all that can be wrong before the work begins.
    const TileGrid grid = GridOf(settings.schedule);
    SceneInput input(settings.scene, {.grid = grid, .withHalf = false});
    const PixelRect& region = input.region;
    const CriterionFactory factory = ReadRule(options, region, &settings);
    CheckBlocks(region, settings.schedule, input.warnings);
    const bool withCurves = IsHtml(options.report);
    const FilmOptions filmOptions{
        .grid = grid,
        .withHalf = KeepsHalf(options.halfBuffer, UseOfHalf(options, factory, withCurves))};
    CheckFilmFits(region, filmOptions);
    const RenderFiles files =
        NameFiles(options.output.empty() ? input.film.filename : options.output, options.report,
                  !factory.logRatios.empty());
    if (leads) CheckWritable(files, settings.scene.file);
    if (leads) CheckCheckpoint(settings.checkpoint);
    std::optional<AovFilm> layers = MakeAovFilm(options.aovs, region);
    AovFilm* const aovs = layers ? &*layers : nullptr;
    const std::unique_ptr<Display> display = MakeDisplay(
        options.pictures, std::filesystem::path(files.exr).filename(), region, job->Count());

    const std::unique_ptr<const Scene> scene = CompileScene(settings, &input);

    Provenance provenance = MakeProvenance(settings, *scene, input.film);
    provenance.criterion = factory.rule;
    provenance.checksum = factory.checksum;
    provenance.clock = options.clock.Text();
    provenance.logRatios = factory.logRatios;
    provenance.guide = options.guide.mode;
    provenance.guideMegabytes = options.guide.megabytes;
    RenderIdentity identity;
    if (!settings.checkpoint.file.empty() || job->Count() > 1) {
        identity = IdentityOf(provenance, SceneHash(input.description));
        identity["curves"] = withCurves ? "yes" : "no";
        if (aovs) identity["aov"] = TextOf(options.aovs);
    }
    Film film(region, filmOptions);
    std::optional<RenderState> interrupted;
    std::vector<std::byte> guide;  // what was learned, for checkpoints
    if (leads) interrupted = Resume(settings.checkpoint, identity, &film, &guide, aovs);

    CatchInterrupts();
    const std::optional<Learning> learning =
        LearnGuide(options.guide, {.scene = *scene,
                                   .region = region,
                                   .settings = settings,
                                   .sampler = provenance.sampler,
                                   .ranks = job->Count(),
                                   .clock = clock,
                                   .keep = KeepsLearning(settings.checkpoint, identity, leads),
                                   .kept = guide});
    if (!learning) {
        fmt::print(stderr, "interrupted while learning\n");
        return kInterrupted;
    }
    provenance.guideFigures = learning->figures;
    if (options.guide.mode != GuideMode::Off && !settings.checkpoint.file.empty())
        guide = SaveLearning(*learning);
    if (interrupted && interrupted->blocks.empty()) interrupted.reset();

    std::vector<BlockHistory> histories(MakeBlocks(region, settings.schedule).size());
    ProgressPrinter printer = MakePrinter(settings, FixedSpp(options.rule) == 0);
    RenderOptions renderOptions = MakeRenderOptions(settings, provenance.sampler, &printer);
    renderOptions.makeCriterion = MakeCriteria(factory, withCurves, &histories);
    renderOptions.trend = factory.trend;
    if (clock)
        renderOptions.secondsLeft = [&, reserve = SecondsToWrite(region.Area())] {
            return clock() - reserve;
        };
    if (display && interrupted) display->Show(region, film);
    WriteCheckpoints(settings.checkpoint, identity, film, &renderOptions, guide, aovs);
    ShareAmongRanks(job, &renderOptions);
    job->Begin(TextOf(identity) + (film.HasHalf() ? "half" : ""));
    const bool isGuided = learning->figures.isUsed;
    const SampleSource source =
        isGuided ? SamplesOf(*scene, learning->guide) : SamplesOf(*scene, settings.estimator);
    const RenderResult result =
        Render(source, renderOptions, &film, interrupted ? &*interrupted : nullptr,
               {.aovs = aovs,
                .aovSource = isGuided ? AovSamplesOf(*scene, learning->guide, options.aovs)
                                      : AovSamplesOf(*scene, settings.estimator, options.aovs),
                .display = display.get()});
    job->End();
    if (!leads) return kDone;
    printer.Finish(result.progress);
    if (display) display->Show(region, film);  // some may have been undone
    film.DropHalf();                           // what follows needs the memory

    if (!settings.quiet) PrintSummary(result, film, settings.schedule.cap);
    if (!settings.quiet && !result.shares.empty()) PrintShares(result.shares);
    if (!settings.quiet && result.timeUp) PrintShortfall(provenance, result);
    if (result.progress.samples == 0) return kInterrupted;  // there is nothing to write

    WriteFiles(files, *scene, film, provenance, result, input.warnings, histories,
               aovs ? MakeExtraLayers(*aovs, film, input.description, *scene) : ExtraLayers(),
               options.pictures);
    PrintFiles(files, result);
    if (display) display->Finish();
    if (!result.cancelled && !result.timeUp && !settings.checkpoint.file.empty())
        std::filesystem::remove(settings.checkpoint.file);
    return result.cancelled ? kInterrupted : kDone;
}

}  // namespace

void AddRenderCommand(CLI::App& app, Command* command, Job* job) {
    CLI::App* render =
        app.add_subcommand("render",
                           "Renders a scene, 20 samples per pixel a pass, until each\n"
                           "block of the image has stopped or is at the cap.");
    auto options = std::make_shared<Options>();
    AddOptions(*render, options.get());
    render->callback([=] { *command = [=] { return RunRender(*options, job); }; });
}

}  // namespace lull
