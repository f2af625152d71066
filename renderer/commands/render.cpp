// `lull render`: renders a scene until every block has stopped.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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
#include "renderer/commands/path_printer.h"
#include "renderer/commands/picture_options.h"
#include "renderer/commands/render_files.h"
#include "renderer/commands/render_talk.h"
#include "renderer/commands/session_options.h"
#include "renderer/input/scene_hash.h"
#include "renderer/mpi/job.h"
#include "renderer/render/block_denoiser.h"
#include "renderer/render/film_picture.h"
#include "renderer/render/half_buffer.h"
#include "renderer/results/report.h"
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
    PathOfSample path;  // to print, instead
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
  lull render scene.pbrt --checkpoint c.h5 --resume --keep-checkpoint --cap 20000    # and more
  lull render scene.pbrt --preview 60                  # with a picture to look at every minute
  lull render scene.pbrt --until 09:00                 # as clean as it gets until then
  mpirun -n 4 lull render scene.pbrt                   # on several machines, if built with MPI

With --time or --until, blocks stop as without; when that is not enough for all, the worst is as
good as it can be. Every pixel gets its first sample, even if that takes longer. How many samples
the others got depends on the machine: --stop thresholds:OUT.thresholds.csv repeats the image. A
checkpoint is kept, to go on from.

Ctrl-C ends the render early and writes what there is; twice, it ends at once.
Exit codes: 0 done, 1 the input or the environment is at fault, 2 wrong usage, 130 interrupted.)";

bool IsHtml(const std::string& report) { return report.ends_with(".html"); }

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
                   "Write what happened to each block: .html to look at, .json for programs")
        ->check([](const std::string& file) {
            const bool isKnown = IsHtml(file) || file.ends_with(".json");
            return isKnown ? "" : file + " ends neither in .html nor in .json";
        })
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
    app.add_flag("--transparent", o->pictures.format.isTransparent,
                 "Leave out the background that the camera sees past everything: the PNG has\n"
                 "alpha, and the EXR colours multiplied by it with --aov alpha");
    AddPathOptions(app, &o->path);
    AddClockOptions(app, &o->clock);
    AddCheckpointOptions(app, &o->render.checkpoint);
    o->render.checkpoint.mayDiffer = MayDiffer::Stops;
    app.add_flag("--keep-checkpoint", o->render.checkpoint.isKept,
                 "Keep it when the render is done, too, to go on with a larger --cap, more\n"
                 "--caution or another rule")
        ->needs(app.get_option("--checkpoint"));
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
    provenance.trend = factory.trend;
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

// Where all samples belong to one half, nothing says how large their noise is.
void CheckSamplesSuffice(const Options& options) {
    if (CollectsFeatures(options) && options.spp > 0 && options.spp < int(leastDenoisedSpp))
        throw UsageError(
            fmt::format("--spp {}: {} needs at least {}, to know what is noise", options.spp,
                        options.denoise ? "--denoise" : "--denoise-layers", leastDenoisedSpp));
}

// Takes back what is said of blocks that have too few samples to know what is noise: they stay as
// they are, and may be as wrong as can be.
void DoubtBlocks(const RenderResult& result, const PixelRect& region, const Talk& talk,
                 DenoisedImage* denoised) {
    constexpr float mostLightness = 100;
    int count = 0;
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        if (result.blocks[i].block.spp >= int(leastDenoisedSpp)) continue;
        ++count;
        denoised->blocks[i].reset();
        const PixelRect& pixels = result.blocks[i].block.pixels;
        for (int y = pixels.min.y(); y < pixels.max.y(); ++y)
            std::fill_n(denoised->error.begin() + (y - region.min.y()) * region.Width() +
                            (pixels.min.x() - region.min.x()),
                        pixels.Width(), mostLightness);
    }
    if (count > 0)
        talk.Warn(
            fmt::format("{} of {} blocks are not denoised: they have fewer than {} samples per "
                        "pixel",
                        count, result.blocks.size(), leastDenoisedSpp));
}

// Prints the path of a sample instead.
ExitCode RunPath(const Options& options) {
    if (options.guide.mode != GuideMode::Off)
        throw UsageError(
            "--pixel: paths with a guide depend on all that it has learned, and are not printed; "
            "leave --guide out");
    const RenderSettings& settings = options.render;
    SceneInput input(settings.scene, {.withHalf = false}, TalkOf(settings));
    const std::unique_ptr<const Scene> scene = CompileScene(settings, &input);
    PrintPath(options.path, settings, MakeProvenance(settings, *scene, input.film).sampler,
              input.description, *scene);
    return kDone;
}

// A preview that cannot be written is a warning: the files may be written in the end.
void WritePreview(const RenderFiles& files, const PictureOrigin& origin, const Film& film,
                  const MatteFilm* mattes, const RenderResult& result, const PictureFormat& format,
                  const Talk& talk) try {
    ResultFiles written(Rescue::None);
    WriteImage({files.exr, files.png}, origin, film, nullptr, mattes, result, {}, format, &written);
    written.Check();
} catch (const Error& e) {
    talk.Warn(fmt::format("no preview: {}", e.what()));
}

ExitCode RunRender(Options options, Job* job) {
    if (options.path.pixel) return job->Rank() == 0 ? RunPath(options) : kDone;
    CheckSamplesSuffice(options);
    options.aovs.alpha |= options.pictures.format.isTransparent;
    options.rule = options.spp > 0
                       ? fmt::format("fixed:{}", options.spp)
                       : options.stop.value_or(options.denoise ? denoisedRuleName : defaultRule);
    RenderSettings& settings = options.render;
    SetWording(settings, job);
    const bool leads = job->Rank() == 0;  // prints, and has to do with files
    const std::function<double()> clock = StartClock(options.clock);

    // Check all that can be wrong before the work begins.
    const Talk talk = TalkOf(settings);
    SceneInput input(settings.scene, {.grid = GridOf(settings.schedule), .withHalf = false}, talk);
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
        options.pictures, std::filesystem::path(files.exr).filename(), region, job->Count(), talk);
    const std::unique_ptr<const Scene> scene = CompileScene(settings, &input);

    Provenance provenance = ProvenanceOf(options, factory, *scene, input.film);
    std::vector<BlockHistory> histories(MakeBlocks(region, settings.schedule).size());
    SessionOptions how =
        MakeSessionOptions(settings, provenance.sampler, FixedSpp(options.rule) == 0, job);
    how.render.makeCriterion = MakeCriteria(factory, IsHtml(options.report), &histories);
    how.render.trend = factory.trend;
    how.render.display = display.get();
    if (clock)
        how.render.events.onProgress =
            WarnOfFirstSamples(region.Area(), talk, std::move(how.render.events.onProgress));
    if (talk.isJson) how.render.events.onStop = StopEvents(factory.trend.kind);
    how.film = film;
    how.aovs = options.aovs;
    how.features = CollectsFeatures(options);
    how.guide = options.guide;
    how.checkpoint = settings.checkpoint;
    how.identity = IdentityFor(options, provenance, input.description, *job);
    how.clock = clock;
    if (clock) job->SetClock(clock);
    Session session(*scene, region, how);
    if (denoiser) denoiser->Show(&session.TheFilm(), session.Features());
    if (denoiser && display)
        denoiser->ShowPictures([&](const PixelRect& pixels, std::span<const float> rgb) {
            display->ShowDenoised(pixels, rgb);
        });
    session.Resume();
    if (options.pictures.preview > 0)
        session.Preview(options.pictures.preview, [&](const RenderResult& result) {
            WritePreview(files, {*scene, provenance}, session.TheFilm(), session.Mattes(), result,
                         options.pictures.format, talk);
        });
    CatchInterrupts();
    const RenderResult result = session.Run();
    provenance.guideFigures = session.Guidance();
    job->End();
    if (!leads) return kDone;
    PrintResult(settings, provenance, result, session.TheFilm().RejectedCount());
    if (result.progress.samples == 0) return kInterrupted;  // there is nothing to write
    std::optional<DenoisedImage> denoised;
    std::vector<ExrChannel> halves;
    NoisyPicture picture;
    if (options.denoiseLayers)
        halves = MakeHalfChannels(session.TheFilm(), *session.Features(), region);
    if (options.denoise) picture = FeaturesOf(session.TheFilm(), *session.Features(), region);
    session.DropFeatures();  // what follows needs the memory
    if (options.denoise) picture.colour = ColoursOf(session.TheFilm(), region);
    session.TheFilm().DropHalf();
    if (options.denoise) {
        denoised = DenoiseAndSay(std::move(picture), region, MakeBlocks(region, settings.schedule),
                                 settings.quiet, talk);
        DoubtBlocks(result, region, talk, &*denoised);
    }
    if (display && denoised) display->ShowDenoised(region, denoised->image.values);

    const ResultFiles written = WriteFiles(files, {{*scene, provenance},
                                                   session.TheFilm(),
                                                   result,
                                                   histories,
                                                   input.warnings,
                                                   {options.aovs, session.Aovs(), session.Mattes()},
                                                   denoised ? &*denoised : nullptr,
                                                   halves,
                                                   input.description,
                                                   options.pictures.format});
    for (const std::string& name : written.Names()) fmt::print("{}\n", name);
    if (display) display->Finish();
    const CheckpointOptions& checkpoint = settings.checkpoint;
    const bool goesOn = result.cancelled || (result.timeUp && !checkpoint.file.empty());
    if (goesOn && !settings.quiet) talk.Note(HowToGoOn(checkpoint.file));
    if (talk.isJson) SayEnd(written, result, session.TheFilm().RejectedCount());
    written.Check();
    const bool isDone = !result.cancelled && !result.timeUp;
    if (isDone && !checkpoint.file.empty() && !checkpoint.isKept)
        std::filesystem::remove(checkpoint.file);
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
