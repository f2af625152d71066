// `lull bench`: error against seconds and samples.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "renderer/commands/command.h"
#include "renderer/commands/guide_options.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/render_files.h"
#include "renderer/commands/render_settings.h"
#include "renderer/input/scene_hash.h"
#include "renderer/measure/bench.h"
#include "renderer/measure/compared_files.h"
#include "renderer/output/file_io.h"
#include "renderer/pages/bench_page.h"
#include "renderer/ranks/job.h"

namespace lull {

namespace {

struct Options {
    RenderSettings render;
    GuideOptions guide;
    std::vector<std::string> samplers = {"sobol", "random"};
    std::vector<std::string> rules;  // beside those that are always measured
    std::string reference, external, output, report;
};

constexpr const char* kFooter =
    R"(One render to the cap with each sampler gives the images of all fixed numbers of samples, of
`learned`, and of the other stopping rules over a range of their settings, and what each would have
cost: the measured seconds of processors, divided by the number of threads. The errors are against
--reference, or else against the image of the first sampler at the cap; that one has the samples of
its sampler's other images in it, so that their error is understated near the cap.

With --guide, each sampler renders once more with paths that are guided, "sobol+guide"; learning
counts among the seconds of each of these points. With auto, only where the guide is used.

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
    app.add_option("--reference", o->reference, "Image to compare with")->type_name("R.exr");
    app.add_option("--external", o->external, "Images of other renderers: name,seconds,file.exr")
        ->type_name("E.csv");
    app.add_option("-o,--output", o->output, "Beginning of the names of the files [the scene's]")
        ->type_name("OUT");
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

std::vector<ObservedRule> MakeRules(const Options& options, const PixelRect& region) {
    const ScheduleOptions& schedule = options.render.schedule;
    std::vector<std::string> texts = BenchRules(schedule.passLength, schedule.cap);
    texts.push_back("learned");
    for (const std::string& rule : options.rules)
        if (std::ranges::find(texts, rule) == texts.end()) texts.push_back(rule);
    std::vector<ObservedRule> rules;
    for (const std::string& text : texts) {
        const CriterionFactory factory = ReadRule("--rule", text, options.render, region);
        rules.push_back({text, factory.rule, factory.smallestSide, factory.make});
    }
    return rules;
}

// Holds all that the renders of both samplers have in common.
struct Job {
    std::unique_ptr<const Scene> scene;
    std::string sceneHash;
    Provenance provenance;
    std::vector<ObservedRule> rules;
    std::vector<ExternalImage> external;
    std::vector<RgbImage> externalImages;
    std::optional<RgbImage> reference;  // set by the first render, unless it was given
};

Job Prepare(const Options& options, bool leads) {
    const RenderSettings& settings = options.render;
    SceneInput input(settings.scene);
    Job job;
    job.rules = MakeRules(options, input.region);
    if (!options.reference.empty())
        job.reference = ReadImageOfSize(options.reference, input.region);
    if (!options.external.empty()) job.external = ReadExternalImages(options.external);
    for (const ExternalImage& external : job.external)
        job.externalImages.push_back(ReadImageOfSize(external.file, input.region));
    if (leads) CheckWritable(options.output + ".csv");
    if (leads && !options.report.empty()) CheckWritable(options.report);
    job.scene = CompileScene(settings, &input);
    job.sceneHash = SceneHash(input.description);
    job.provenance = MakeProvenance(settings, *job.scene, input.film);
    return job;
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

// Says how far the comparisons are, at most once a second.
class PointCounter {
  public:
    PointCounter(size_t count, bool quiet) : count(count), quiet(quiet) {}
    void Add() {
        using namespace std::chrono;
        const double seconds = duration<double>(steady_clock::now() - start).count();
        ++done;
        if (quiet || (seconds < next && done < count)) return;
        next = seconds + 10;
        fmt::print(stderr, "lull: compared {} of {} images, {} left\n", done, count,
                   FormatDuration(seconds / double(done) * double(count - done)));
    }

  private:
    size_t count, done = 0;
    bool quiet;
    double next = 10;
    const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

// Learns, where the variant is guided. Returns nothing if it was interrupted; learning begins anew
// then, to the same bits.
std::optional<Learning> Learn(const Options& options, const Variant& variant, const Job& job,
                              const lull::Job& ranks) {
    if (!variant.isGuided) return Learning();
    return LearnGuide(options.guide, {.scene = *job.scene,
                                      .region = job.provenance.crop,
                                      .settings = options.render,
                                      .sampler = variant.sampler,
                                      .ranks = ranks.Count(),
                                      .clock = {},
                                      .keep = {},
                                      .kept = {}});
}

// Renders in one way, or takes what is left of an earlier run, and adds its points: none, where
// --guide auto does not guide. Returns false if it was interrupted. The ranks share the render, and
// the first measures.
bool BenchVariant(const Options& options, const Variant& variant, Job* job, lull::Job* ranks,
                  std::vector<BenchPoint>* points) {
    const bool leads = ranks->Rank() == 0;
    const RenderSettings& settings = options.render;
    const std::optional<Learning> learning = Learn(options, variant, *job, *ranks);
    if (!learning) return false;
    if (variant.isGuided && !learning->figures.isUsed) return true;
    Provenance provenance = job->provenance;
    provenance.sampler = variant.sampler;
    if (variant.isGuided) {
        provenance.guide = options.guide.mode;
        provenance.guideMegabytes = options.guide.megabytes;
    }
    for (const ObservedRule& rule : job->rules) provenance.criterion += rule.text + " ";
    RenderIdentity identity = IdentityOf(provenance, job->sceneHash);
    const CheckpointOptions checkpoint{
        .file = CheckpointName(options, variant),
        .interval = settings.checkpoint.interval,
        .resume = std::filesystem::exists(CheckpointName(options, variant))};

    Film film(provenance.crop);
    std::optional<RenderState> interrupted;
    if (leads) interrupted = Resume(checkpoint, identity, &film);
    std::vector<BlockHistory> histories(MakeBlocks(provenance.crop, settings.schedule).size());
    if (!settings.quiet) fmt::print(stderr, "lull: rendering with {}\n", NameOf(variant));
    ProgressPrinter printer = MakePrinter(settings, false);
    RenderOptions render = MakeRenderOptions(settings, variant.sampler, &printer);
    render.makeCriterion = MakeObservers(job->rules, provenance.crop, settings.schedule,
                                         {.snapshots = true, .goesOn = true}, &histories);
    render.checkpointAtEnd = true;
    WriteCheckpoints(checkpoint, identity, film, &render);
    const SampleSource source = variant.isGuided ? SamplesOf(*job->scene, learning->guide)
                                                 : SamplesOf(*job->scene, settings.estimator);
    ShareAmongRanks(ranks, &render);
    ranks->Begin(TextOf(identity));
    const RenderResult result =
        Render(source, render, &film, interrupted ? &*interrupted : nullptr);
    printer.Finish(result.progress);
    if (result.cancelled) return false;
    if (!leads) return true;

    const ObservedRender observed{source, render, film, result, histories};
    const bool makesReference = !job->reference;
    if (makesReference) job->reference = TakeWholeImage(observed).image;
    PointCounter counter(job->rules.size(), settings.quiet);
    for (BenchPoint point : MeasurePoints(observed, job->rules, *job->reference, result.threads,
                                          [&] { counter.Add(); })) {
        point.sampler = NameOf(variant);
        point.sharesReference = makesReference;
        point.seconds += learning->figures.seconds;
        point.threadSeconds += learning->figures.seconds * result.threads;
        points->push_back(std::move(point));
    }
    return true;
}

ExitCode RunBench(Options options, lull::Job* ranks) {
    RenderSettings& settings = options.render;
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    if (options.output.empty()) options.output = SceneName(settings.scene.file) + ".bench";
    Job job = Prepare(options, ranks->Rank() == 0);
    CheckGuide(options.guide, *job.scene, settings.estimator);
    CatchInterrupts();
    std::vector<BenchPoint> points;
    const std::vector<Variant> variants = Variants(options);
    std::vector<std::string> names;
    for (const Variant& variant : variants) {
        names.push_back(NameOf(variant));
        if (BenchVariant(options, variant, &job, ranks, &points)) continue;
        fmt::print(stderr, "lull: interrupted; the same command goes on from {}\n",
                   CheckpointName(options, variant));
        return kInterrupted;
    }
    ranks->End();
    if (ranks->Rank() > 0) return kDone;
    for (size_t i = 0; i < job.external.size(); ++i)
        points.push_back(MeasureExternal(job.external[i], job.externalImages[i], *job.reference));

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
            "The seconds of guided points have all the time that was taken to learn in them.");
    WriteFileAtomically(options.output + ".csv", BenchCsv(points));
    fmt::print("{}.csv\n", options.output);
    if (!options.report.empty()) {
        WriteFileAtomically(options.report,
                            MakeBenchPage(SceneName(settings.scene.file), job.provenance, points,
                                          names, *job.reference, notes));
        fmt::print("{}\n", options.report);
    }
    for (const Variant& variant : variants)
        std::filesystem::remove(CheckpointName(options, variant));
    return kDone;
}

}  // namespace

void AddBenchCommand(CLI::App& app, Command* command, lull::Job* ranks) {
    CLI::App* bench = app.add_subcommand(
        "bench", "Measures error against seconds and samples: fixed numbers, and stopping rules.");
    auto options = std::make_shared<Options>();
    AddOptions(*bench, options.get());
    bench->callback([=] { *command = [=] { return RunBench(*options, ranks); }; });
}

}  // namespace lull
