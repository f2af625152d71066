// `lull render`: renders a scene until every block has stopped.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "renderer/base/say.h"
#include "renderer/commands/aov_options.h"
#include "renderer/commands/choice_option.h"
#include "renderer/commands/clock_options.h"
#include "renderer/commands/command.h"
#include "renderer/commands/denoising.h"
#include "renderer/commands/guide_options.h"
#include "renderer/commands/input_files.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/picture_options.h"
#include "renderer/commands/render_files.h"
#include "renderer/commands/session_options.h"
#include "renderer/input/scene_hash.h"
#include "renderer/measure/report.h"
#include "renderer/measure/shortfall.h"
#include "renderer/mpi/job.h"
#include "renderer/render/block_denoiser.h"
#include "renderer/render/film_picture.h"
#include "renderer/render/half_buffer.h"
#include "stopping/rules/denoised.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

struct Options {
    RenderSettings render;
    ClockOptions clock;
    GuideOptions guide;
    HalfBuffer halfBuffer = HalfBuffer::Auto;
    std::string output, report;  // empty: as the scene says; none
    std::optional<std::string> stop;
    std::string rule;  // what --stop, --spp and --denoise come to
    int spp = 0;       // 0: as the rule says
    AovSet aovs;
    bool denoise = false, denoiseLayers = false;
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
good as it can be. Every pixel gets its first sample, even if that takes longer. How many samples
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
    auto* stop = app.add_option("--stop", o->stop,
                                "When blocks stop; see below [learned; with --denoise: denoised]")
                     ->type_name("RULE");
    AddCautionOption(app, &o->render.caution);
    app.add_option("--spp", o->spp, "Samples per pixel, the same for all: --stop fixed:N")
        ->check(CLI::Range(1, 1 << 24))
        ->type_name("N")
        ->excludes(stop);
    app.add_option("--report", o->report,
                   "Write what happened to each block: .html to look at, else JSON")
        ->type_name("R.html|R.json");
    app.add_flag("--denoise", o->denoise,
                 "Take the noise out of the image, with blocks that stop when it is clean then;\n"
                 "the EXR has the means of the samples as noisy.R, .G, .B, and the estimated\n"
                 "standard error of each pixel in lightness as error");
    app.add_flag("--denoise-layers", o->denoiseLayers,
                 "Keep in the EXR what `lull denoise` needs to do so later");
    AddGuideOptions(app, &o->guide);
    AddAovOptions(app, &o->aovs);
    AddPictureOptions(app, &o->pictures);
    AddClockOptions(app, &o->clock);
    AddCheckpointOptions(app, &o->render.checkpoint);
    AddChoiceOption<HalfBuffer>(
        app, "--half-buffer", &o->halfBuffer,
        {{"auto", HalfBuffer::Auto}, {"on", HalfBuffer::On}, {"off", HalfBuffer::Off}},
        "auto|on|off",
        "Keep the mean of half of the samples, 24 bytes a pixel: auto where it is needed, or\n"
        "may be when going on from a checkpoint");
    app.footer("Stopping rules (--stop); a block stops\n" + RuleHelp(100) + "\n" + kFooter);
}

// Returns the length of passes: shorter where the rule counts samples and stops blocks within the
// first, as one that repeats a render that was short of time.
int PassLengthFor(const CriterionFactory& factory, const PixelRect& region,
                  const ScheduleOptions& schedule) {
    int length = schedule.passLength;
    if (!factory.stopAt) return length;
    const int blocks = int(MakeBlocks(region, schedule).size());
    for (int i = 0; i < blocks; ++i)
        if (const int stop = factory.stopAt({.index = i}); stop < std::min(length, schedule.cap))
            length = std::gcd(length, stop);
    return std::max(1, length);
}

// Reads the rule and lets the schedule suit it.
CriterionFactory ReadRule(const Options& options, const PixelRect& region,
                          std::shared_ptr<BlockDenoiser>* denoiser, RenderSettings* settings) {
    // A fixed number of samples is its own cap; with --cap the smaller of both holds.
    if (settings->cap) settings->schedule.cap = *settings->cap;
    if (const int spp = FixedSpp(options.rule))
        settings->schedule.cap = settings->cap ? std::min(*settings->cap, spp) : spp;
    std::map<std::string, SignalMeasure> measures;
    if (options.denoise) {
        *denoiser = std::make_shared<BlockDenoiser>(MakeBlocks(region, settings->schedule));
        measures[denoisedRuleName] = MeasureOf(*denoiser);
    }
    const CriterionFactory factory =
        ReadRule("--stop", options.rule, *settings, region, std::move(measures));
    settings->schedule.smallestSide = factory.smallestSide;
    settings->schedule.passLength = PassLengthFor(factory, region, settings->schedule);
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

// Says which blocks have ended, and how: what a rule was not content with at the cap is not
// stopped.
std::string EndsOf(const RenderResult& result, RuleTrend::Kind kind) {
    const int atCap = BlocksAtCap(result), stopped = result.progress.stoppedBlocks - atCap;
    if (kind == RuleTrend::Samples)
        return fmt::format("{} of {} blocks done", stopped + atCap, result.progress.blocks);
    std::string text = fmt::format("{} of {} blocks stopped", stopped, result.progress.blocks);
    if (atCap > 0) text += fmt::format(", {} at the cap and not stopped", atCap);
    return text;
}

void PrintSummary(const RenderResult& result, const Film& film, int cap, RuleTrend::Kind kind) {
    const Savings savings = ComputeSavings(result, cap);
    Say("{}{}, median {} spp; {} samples in {}",
        result.cancelled ? "interrupted: "
        : result.timeUp  ? "the time is up: "
                         : "",
        EndsOf(result, kind), result.progress.medianSpp, FormatCount(double(savings.samples)),
        FormatDuration(result.progress.seconds));
    if (!result.cancelled && savings.samples < savings.samplesAtCap)
        Say("; against {} spp everywhere {:.1f}% fewer samples, {:.1f}% less time", cap,
            100 * savings.SampleShare(), 100 * savings.SecondShare());
    Say("\n");
    if (const int64_t rejected = film.RejectedCount())
        Say("lull: warning: {} samples were not finite or negative: taken as black\n", rejected);
}

// Says how much ranks of different speed had to do in the end.
void PrintShares(const std::vector<double>& shares) {
    const auto [least, most] = std::ranges::minmax(shares);
    if (most - least < 0.01) return;
    Say("shares of the ranks at the end, in percent:");
    for (const double share : shares) Say(" {:.0f}", 100 * share);
    Say("\n");
}

// Says what was missing when the time was up. Of blocks within their first pass nobody knows the
// noise, nor how long they would have taken.
void PrintShortfall(const Provenance& provenance, const RenderResult& result) {
    constexpr size_t shown = 8;
    std::vector<NoisyBlock> noisy = FindShortfall(provenance, result);
    const auto unknown =
        std::erase_if(noisy, [](const NoisyBlock& block) { return !std::isfinite(block.noise); });
    if (unknown > 0)
        Say("{} blocks have less than a pass of {} spp, too little to tell how noisy they are\n",
            unknown, provenance.schedule.passLength);
    if (noisy.empty()) return;
    Say("not stopped, and the noise that is visible, in lightness of 0 to 100:\n");
    for (size_t i = 0; i < std::min(shown, noisy.size()); ++i) {
        const Block& block = result.blocks[size_t(noisy[i].block)].block;
        Say("  block {} at {},{}: {:.2f} at {} spp; probably until {} spp, {}\n", noisy[i].block,
            block.pixels.min.x(), block.pixels.min.y(), noisy[i].noise, block.spp,
            noisy[i].neededSpp, FormatDuration(NeededSeconds({noisy[i]}, result)));
    }
    if (noisy.size() > shown)
        Say("  and {} more, of {:.2f} or less\n", noisy.size() - shown, noisy[shown].noise);
    if (unknown == 0)
        Say("about {} more would have been enough for all\n",
            FormatDuration(NeededSeconds(noisy, result)));
}

// Throws Error where a result would replace another or an input, or could not be written now.
void CheckFiles(const Options& options, const RenderFiles& files, const Description& description) {
    std::vector<NamedFile> outputs = OutputsOf(files);
    outputs.push_back({"--checkpoint", options.render.checkpoint.file});
    std::vector<NamedFile> inputs = InputsOf(options.render.scene, description);
    AddFileOfRule(options.rule, &inputs);
    CheckOutputs(outputs, inputs);
    CheckCheckpoint(options.render.checkpoint);
}

// Says whether it collects what a denoiser is shown.
bool CollectsFeatures(const Options& options) { return options.denoise || options.denoiseLayers; }

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

// Says how the film is kept. Throws Error where the memory cannot hold it, or where it cannot be as
// the user wants it.
FilmOptions CheckedFilm(const Options& options, const CriterionFactory& factory,
                        const PixelRect& region) {
    const RenderSettings& settings = options.render;
    const HalfUse use{.rule = LooksAtHalf(factory, settings.schedule) ? factory.rule : "",
                      .clock = !options.clock.Text().empty(),
                      .page = IsHtml(options.report),
                      .denoiser = CollectsFeatures(options),
                      .checkpoint = !settings.checkpoint.file.empty()};
    const FilmOptions film{.grid = GridOf(settings.schedule),
                           .withHalf = KeepsHalf(options.halfBuffer, use)};
    CheckFilmFits(region, film);
    return film;
}

Provenance ProvenanceOf(const Options& options, const CriterionFactory& factory, const Scene& scene,
                        const FilmSettings& film) {
    Provenance provenance = MakeProvenance(options.render, scene, film);
    provenance.criterion = factory.rule;
    provenance.checksum = factory.checksum;
    provenance.clock = options.clock.Text();
    provenance.logRatios = factory.logRatios;
    provenance.guide = options.guide.mode;
    provenance.guideMegabytes = options.guide.megabytes;
    return provenance;
}

// Returns what checkpoints and ranks have to agree on; nothing where there are none, as the hash of
// a large scene takes its time.
RenderIdentity IdentityFor(const Options& options, const Provenance& provenance,
                           const Description& description, const Job& job) {
    if (options.render.checkpoint.file.empty() && job.Count() == 1) return {};
    RenderIdentity identity = IdentityOf(provenance, SceneHash(description));
    identity["curves"] = IsHtml(options.report) ? "yes" : "no";
    return identity;
}

// Prints what came of it.
void PrintResult(const RenderSettings& settings, const Provenance& provenance,
                 const RenderResult& result, const Film& film, RuleTrend::Kind kind) {
    if (settings.quiet) return;
    PrintSummary(result, film, settings.schedule.cap, kind);
    if (!result.shares.empty()) PrintShares(result.shares);
    if (result.timeUp) PrintShortfall(provenance, result);
}

ExitCode RunRender(Options options, Job* job) {
    options.rule = options.spp > 0
                       ? fmt::format("fixed:{}", options.spp)
                       : options.stop.value_or(options.denoise ? denoisedRuleName : defaultRule);
    RenderSettings& settings = options.render;
    const bool leads = job->Rank() == 0;  // prints, and has to do with files
    const std::function<double()> clock = StartClock(options.clock);

    // Check all that can be wrong before the work begins.
    SceneInput input(settings.scene, {.grid = GridOf(settings.schedule), .withHalf = false});
    const PixelRect& region = input.region;
    std::shared_ptr<BlockDenoiser> denoiser;
    const CriterionFactory factory = ReadRule(options, region, &denoiser, &settings);
    CheckBlocks(region, settings.schedule, input.warnings);
    const FilmOptions film = CheckedFilm(options, factory, region);
    const RenderFiles files =
        NameFiles(options.output.empty() ? input.film.filename : options.output, options.report);
    if (leads) CheckFiles(options, files, input.description);
    CheckLayersFit(options.aovs, CollectsFeatures(options), region);
    const std::unique_ptr<Display> display = MakeDisplay(
        options.pictures, std::filesystem::path(files.exr).filename(), region, job->Count());
    const std::unique_ptr<const Scene> scene = CompileScene(settings, &input);

    Provenance provenance = ProvenanceOf(options, factory, *scene, input.film);
    std::vector<BlockHistory> histories(MakeBlocks(region, settings.schedule).size());
    ProgressPrinter printer = MakePrinter(settings, FixedSpp(options.rule) == 0);
    SessionOptions how = MakeSessionOptions(settings, provenance.sampler, &printer, job);
    how.render.makeCriterion = MakeCriteria(factory, IsHtml(options.report), &histories);
    how.render.trend = factory.trend;
    how.render.display = display.get();
    if (clock)
        how.render.onProgress = WarnOfFirstSamples(region.Area(), std::move(how.render.onProgress));
    how.film = film;
    how.aovs = options.aovs;
    how.features = CollectsFeatures(options);
    how.guide = options.guide;
    how.checkpoint = settings.checkpoint;
    how.identity = IdentityFor(options, provenance, input.description, *job);
    how.clock = clock;
    Session session(*scene, region, how);
    if (denoiser) denoiser->Show(&session.TheFilm(), session.Features());
    if (denoiser && display)
        denoiser->ShowPictures([&](const PixelRect& pixels, std::span<const float> rgb) {
            display->ShowDenoised(pixels, rgb);
        });
    session.Resume();
    CatchInterrupts();
    if (!session.Learn()) {
        Say("interrupted while learning\n");
        return kInterrupted;
    }
    provenance.guideFigures = session.Guidance();
    const RenderResult result = session.Run();
    job->End();
    if (!leads) return kDone;
    printer.Finish(result.progress);
    PrintResult(settings, provenance, result, session.TheFilm(), factory.trend.kind);
    if (result.progress.samples == 0) return kInterrupted;  // there is nothing to write
    std::optional<DenoisedImage> denoised;
    std::vector<ExrChannel> halves;
    NoisyPicture picture;
    if (session.Features()) picture = PictureOf(session.TheFilm(), *session.Features(), region);
    session.TheFilm().DropHalf();  // what follows needs the memory
    session.DropFeatures();
    if (options.denoiseLayers) halves = MakeHalfChannels(picture);
    if (options.denoise)
        denoised = DenoiseAndSay(std::move(picture), region, MakeBlocks(region, settings.schedule),
                                 settings.quiet);
    if (display && denoised) display->ShowDenoised(region, denoised->image.values);

    const ResultFiles written = WriteFiles(files, {{*scene, provenance},
                                                   session.TheFilm(),
                                                   result,
                                                   histories,
                                                   input.warnings,
                                                   session.Aovs(),
                                                   denoised ? &*denoised : nullptr,
                                                   halves,
                                                   input.description,
                                                   options.pictures.format});
    for (const std::string& name : written.Names()) fmt::print("{}\n", name);
    if (display) display->Finish();
    written.Check();
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
