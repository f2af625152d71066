// `lull bench`: error against seconds and samples.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "renderer/base/seconds_since.h"
#include "renderer/commands/command.h"
#include "renderer/commands/guide_options.h"
#include "renderer/commands/input_files.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/session_options.h"
#include "renderer/files/file_io.h"
#include "renderer/input/scene_hash.h"
#include "renderer/lab/comparison/bench.h"
#include "renderer/lab/comparison/compared_files.h"
#include "renderer/lab/pages/bench_page.h"
#include "renderer/mpi/job.h"
#include "renderer/render/block_denoiser.h"
#include "stopping/rules/denoised.h"

namespace lull {

namespace {

struct Options {
    RenderSettings render;
    GuideOptions guide;
    std::vector<std::string> samplers = {"sobol", "random"};
    std::vector<std::string> rules;  // beside those that are always measured
    bool denoise = false;
    std::string reference, external, output, report;
};

constexpr const char* kFooter =
    R"(One render to the cap with each sampler gives the images of all fixed numbers of samples, of
`learned`, and of the other stopping rules over a range of their settings, and what each would have
cost: the measured seconds of processors, divided by the number of threads. The errors are against
--reference, or else against the image of the first sampler at the cap; that one has the samples of
its sampler's other images in it, so that their error is understated near the cap.

With --guide, each sampler renders once more with paths that are guided, "sobol+guide"; the time
between rounds of learning counts among the seconds of each of these points. With auto, there are
such points only where the guide is used.

With --denoise, images where the rule `denoised` stops (with --rule also at other thresholds than
its own) are rendered again and denoised. What that takes is counted, as are the looks at blocks.

Images of other renderers join in from a CSV with lines "name,seconds,file.exr".

Interrupted, it leaves OUT.SAMPLER.checkpoint and goes on from there the next time.

Files:
  OUT.csv   a line a point: rule, setting, sampler, spp, seconds, errors

Examples:
  lull bench scene.pbrt --resolution 400x400 --block 100 --cap 2000 -o room --report room.html
  lull bench scene.pbrt --rule learned:other.h5 --external others.csv -o room

Exit codes: 0 done, 1 the input or the environment is at fault, 2 wrong usage, 130 interrupted.)";

void AddOptions(CLI::App& app, Options* o) {
    AddRenderSettings(app, &o->render, false);
    app.add_option("--samplers", o->samplers, "Where sample positions come from [sobol,random]")
        ->delimiter(',')
        ->check(CLI::IsMember({"random", "sobol"}))
        ->type_name("S,S");
    AddGuideOptions(app, &o->guide);
    app.add_option("--rule", o->rules, "Another stopping rule to measure; can be given again")
        ->take_all()
        ->type_name("RULE");
    app.add_flag("--denoise", o->denoise,
                 "Also measure `denoised`, and images that are denoised where it stops");
    app.add_option("--reference", o->reference, "Image to compare with")->type_name("R.exr");
    app.add_option("--external", o->external, "Images of other renderers: name,seconds,file.exr")
        ->type_name("E.csv");
    app.add_option("-o,--output", o->output,
                   "Beginning of the names of the files, or their folder\n[the scene's]")
        ->type_name("OUT|DIR/");
    app.add_option("--report", o->report, "Write a page to look at")
        ->check([](const std::string& file) {
            return file.ends_with(".html") ? "" : file + " does not end in .html";
        })
        ->type_name("R.html");
    app.add_option("--checkpoint-interval", o->render.checkpoint.interval,
                   "Seconds between checkpoints")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str();
    app.footer(kFooter);
}

std::vector<ObservedRule> MakeRules(const Options& options, const PixelRect& region,
                                    const std::shared_ptr<BlockDenoiser>& denoiser) {
    const ScheduleOptions& schedule = options.render.schedule;
    std::vector<std::string> texts = BenchRules(schedule.passLength, schedule.cap);
    texts.push_back("learned");
    std::map<std::string, SignalMeasure> measures;
    if (denoiser) {
        texts.push_back(denoisedRuleName);
        measures[denoisedRuleName] = MeasureOf(denoiser);
    }
    for (const std::string& rule : options.rules)
        if (std::ranges::find(texts, rule) == texts.end()) texts.push_back(rule);
    std::vector<ObservedRule> rules;
    for (const std::string& text : texts) {
        const CriterionFactory factory = ReadRule("--rule", text, options.render, region, measures);
        rules.push_back({text, factory.rule, factory.smallestSide, factory.make,
                         text.starts_with(denoisedRuleName)});
    }
    return rules;
}

// One way of rendering: what a curve is drawn for.
struct Variant {
    SamplerKind sampler = SamplerKind::Sobol;
    bool isGuided = false;
};

std::string NameOf(const Variant& variant) {
    return NameOf(variant.sampler) + (variant.isGuided ? "+guide" : "");
}

std::vector<Variant> Variants(const Options& options) {
    std::vector<Variant> variants;
    for (const bool isGuided : {false, true})
        for (const std::string& name : options.samplers)
            if (!isGuided || options.guide.mode != GuideMode::Off)
                variants.push_back(
                    {name == "random" ? SamplerKind::Random : SamplerKind::Sobol, isGuided});
    return variants;
}

std::string CheckpointName(const Options& options, const Variant& variant) {
    return fmt::format("{}.{}.checkpoint", options.output, NameOf(variant));
}

// Holds a scene that is ready, and all that its renders have in common.
struct PreparedScene {
    std::unique_ptr<const Scene> scene;
    std::string sceneHash;
    Provenance provenance;
    std::vector<ObservedRule> rules;
    std::shared_ptr<BlockDenoiser> denoiser;  // null: nothing is denoised
    std::vector<ExternalImage> external;
    std::vector<RgbImage> externalImages;
    std::optional<RgbImage> reference;  // set by the first render, unless it was given
};

// Throws Error where a result would replace another or an input, or could not be written now.
void CheckFiles(const Options& options, const Description& description,
                const std::vector<ExternalImage>& external) {
    std::vector<NamedFile> outputs = {{"-o", options.output + ".csv"},
                                      {"--report", options.report}};
    for (const Variant& variant : Variants(options))
        outputs.push_back({"the checkpoint", CheckpointName(options, variant)});
    std::vector<NamedFile> inputs = InputsOf(options.render.scene, description);
    inputs.push_back({"--reference", options.reference});
    inputs.push_back({"--external", options.external});
    for (const ExternalImage& image : external)
        inputs.push_back({"an image of --external", image.file});
    for (const std::string& rule : options.rules) AddFileOfRule(rule, &inputs);
    CheckOutputs(outputs, inputs);
}

PreparedScene Prepare(const Options& options, const Job& job) {
    const RenderSettings& settings = options.render;
    SceneInput input(settings.scene, {.grid = GridOf(settings.schedule)}, TalkOf(settings));
    PreparedScene prepared;
    if (options.denoise) {
        CheckLayersFit({}, true, input.region);
        prepared.denoiser =
            std::make_shared<BlockDenoiser>(MakeBlocks(input.region, settings.schedule));
    }
    prepared.rules = MakeRules(options, input.region, prepared.denoiser);
    if (!options.external.empty()) prepared.external = ReadExternalImages(options.external);
    if (job.Rank() == 0) CheckFiles(options, input.description, prepared.external);
    if (!options.reference.empty())
        prepared.reference = ReadImageOfSize(options.reference, input.region);
    for (const ExternalImage& external : prepared.external)
        prepared.externalImages.push_back(ReadImageOfSize(external.file, input.region));
    prepared.scene = CompileScene(settings, &input);
    prepared.sceneHash = SceneHash(input.description);
    prepared.provenance = MakeProvenance(settings, *prepared.scene, input.film);
    return prepared;
}

// Says how far the comparisons are, at most once a second.
class PointCounter {
  public:
    PointCounter(size_t count, const RenderSettings& settings)
        : count(count), quiet(settings.quiet), talk(TalkOf(settings)) {}
    void Add() {
        const double seconds = SecondsSince(start);
        ++done;
        if (quiet || (seconds < next && done < count)) return;
        next = seconds + 10;
        talk.Note(fmt::format("compared {} of {} images, {} left", done, count,
                              FormatDuration(seconds / double(done) * double(count - done))));
    }

  private:
    size_t count, done = 0;
    bool quiet;
    Talk talk;
    double next = 10;
    const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

// Returns how to render a variant.
SessionOptions MakeOptions(const Options& options, const Variant& variant,
                           const PreparedScene& prepared, Job* job) {
    Provenance provenance = prepared.provenance;
    provenance.sampler = variant.sampler;
    if (variant.isGuided) {
        provenance.guide = options.guide.mode;
        provenance.guideMegabytes = options.guide.megabytes;
    }
    for (const ObservedRule& rule : prepared.rules) provenance.criterion += rule.text + " ";
    SessionOptions how = MakeSessionOptions(options.render, variant.sampler, false, job);
    if (variant.isGuided) how.guide = options.guide;
    how.checkpoint =
        ResumeIfThere(CheckpointName(options, variant), options.render.checkpoint.interval);
    how.identity = IdentityOf(provenance, prepared.sceneHash);
    how.checkpoint.isKept = true;
    how.features = options.denoise;
    return how;
}

// Adds the points of a variant, of which the first render's whole image is the reference, unless
// another was given.
void AddPoints(const Options& options, const Variant& variant, const ObservedRender& observed,
               const GuideFigures& guidance, PreparedScene* prepared,
               std::vector<BenchPoint>* points) {
    const bool makesReference = !prepared->reference;
    const int threads = observed.result.threads;
    if (makesReference) prepared->reference = TakeWholeImage(observed).image;
    PointCounter counter(prepared->rules.size(), options.render);
    for (BenchPoint point : MeasurePoints(observed, prepared->rules, *prepared->reference, threads,
                                          [&] { counter.Add(); })) {
        point.sampler = NameOf(variant);
        point.sharesReference = makesReference;
        point.seconds += guidance.seconds;
        point.threadSeconds += guidance.seconds * threads;
        points->push_back(std::move(point));
    }
}

// Renders in one way, or takes what is left of an earlier run, and adds its points: none, where
// --guide auto does not guide. Returns false if it was interrupted. The ranks share the render, and
// the first measures.
bool BenchVariant(const Options& options, const Variant& variant, PreparedScene* prepared, Job* job,
                  std::vector<BenchPoint>* points) {
    const RenderSettings& settings = options.render;
    const PixelRect& region = prepared->provenance.crop;
    std::vector<BlockHistory> histories(MakeBlocks(region, settings.schedule).size());
    SessionOptions how = MakeOptions(options, variant, *prepared, job);
    how.render.makeCriterion = MakeObservers(prepared->rules, region, settings.schedule,
                                             {.snapshots = true, .goesOn = true}, &histories);
    Session session(*prepared->scene, region, how);
    if (options.denoise) prepared->denoiser->Show(&session.TheFilm(), session.Features());
    session.Resume();
    if (!settings.quiet) TalkOf(settings).Note("rendering with " + NameOf(variant));
    const RenderResult result = session.Run();
    if (result.cancelled) return false;
    if (variant.isGuided && !session.Guidance().isUsed) return true;
    if (session.Leads())
        AddPoints(options, variant, {session.Context(), session.Options(), result, histories},
                  session.Guidance(), prepared, points);
    return true;
}

// Says what has to be known of the points.
std::vector<std::string> Notes(const Options& options) {
    std::vector<std::string> notes;
    if (options.reference.empty())
        notes.push_back(fmt::format(
            "The reference is the image of {} at the cap: it holds the samples of that sampler's "
            "other images, so that their errors are understated near the cap.",
            options.samplers.front()));
    notes.push_back(
        "Seconds are the measured seconds of processors, of the samples and of the rule, divided "
        "by the number of threads.");
    if (options.guide.mode != GuideMode::Off)
        notes.push_back(
            "The seconds of guided points have all the time between rounds of learning in them.");
    return notes;
}

ExitCode RunBench(Options options, Job* job) {
    RenderSettings& settings = options.render;
    SetWording(settings, job);
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    options.output = BeginningOfNames(options.output, SceneName(settings.scene.file) + ".bench");
    PreparedScene prepared = Prepare(options, *job);
    CheckGuide(options.guide, *prepared.scene, settings.estimator);
    CatchInterrupts();
    std::vector<BenchPoint> points;
    const std::vector<Variant> variants = Variants(options);
    std::vector<std::string> names;
    for (const Variant& variant : variants) {
        names.push_back(NameOf(variant));
        if (!BenchVariant(options, variant, &prepared, job, &points))
            return SayInterrupted(options.render, CheckpointName(options, variant));
    }
    job->End();
    if (job->Rank() > 0) return kDone;
    for (size_t i = 0; i < prepared.external.size(); ++i)
        points.push_back(
            MeasureExternal(prepared.external[i], prepared.externalImages[i], *prepared.reference));

    WriteFileAtomically(options.output + ".csv", BenchCsv(points));
    fmt::print("{}.csv\n", options.output);
    if (!options.report.empty()) {
        WriteFileAtomically(options.report,
                            MakeBenchPage(SceneName(settings.scene.file), prepared.provenance,
                                          points, names, *prepared.reference, Notes(options)));
        fmt::print("{}\n", options.report);
    }
    for (const Variant& variant : variants)
        std::filesystem::remove(CheckpointName(options, variant));
    return kDone;
}

}  // namespace

void AddBenchCommand(CLI::App& app, Command* command, Job* job) {
    CLI::App* bench = app.add_subcommand(
        "bench", "Measures error against seconds and samples: fixed numbers, and stopping rules.");
    auto options = std::make_shared<Options>();
    AddOptions(*bench, options.get());
    bench->callback([=] { *command = [=] { return RunBench(*options, job); }; });
}

}  // namespace lull
