// `lull bench`: error against seconds and samples.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "renderer/base/clocks.h"
#include "renderer/commands/command.h"
#include "renderer/commands/input_files.h"
#include "renderer/commands/option_values.h"
#include "renderer/commands/render_job.h"
#include "renderer/files/result_files.h"
#include "renderer/input/scene_hash.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/comparison/bench.h"
#include "renderer/lab/comparison/compared_files.h"
#include "renderer/lab/pages/bench_page.h"
#include "stopping/rules/denoised.h"

namespace lull::bench {

namespace {

struct Options {
    RenderSettings render;
    std::vector<std::string> samplers;  // none: the usual ones
    std::vector<std::string> rules;     // beside those that are always measured
    bool denoise = false;
    DisplayModel display;
    std::string reference, external, output, report;
};

constexpr const char* kFooter =
    R"(One render to the cap with each sampler gives the images of all fixed sample counts, of `learned`,
and of the other stopping rules over a range of their settings. It also gives the cost of each: the
measured CPU time, divided by the number of threads. Errors are relative to --reference, or else to
the image of the first sampler at the cap. That image contains the samples of its sampler's other
images, so that their error is understated near the cap.

With --denoise, images that the rule `denoised` stops (with --rule also at other thresholds than
its own) are rendered again and denoised. The time of this and of the checks is counted.

Images of other renderers are added from a CSV with lines "name,seconds,file.exr".

An interrupted run leaves OUT.SAMPLER.checkpoint and continues from there the next time.

Files:
  OUT.csv   a line a point: rule, setting, sampler, spp, seconds, errors

Examples:
  lull bench scene.pbrt --resolution 400x400 --block 100 --cap 2000 -o room --report room.html
  lull bench scene.pbrt --rule learned:other.h5 --external others.csv -o room

Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

void AddOptions(CLI::App& app, Options* o) {
    AddRenderSettings(app, &o->render, false);
    app.add_option("--samplers", o->samplers, "Measure these samplers [sobol-halves,random]")
        ->delimiter(',')
        ->check(CLI::IsMember(ChoicesOf<SamplerKind>()))
        ->type_name("S,S");
    app.add_option("--rule", o->rules, "Measure this rule, too; can be given again")
        ->take_all()
        ->type_name("RULE");
    app.add_flag("--denoise", o->denoise, "Measure the rule `denoised` and its images, too")
        ->group(kCommonOptions);
    AddViewingOption(app, &o->display);
    app.add_option("--reference", o->reference, "Compare with this image")->type_name("R.exr");
    app.add_option("--external", o->external,
                   "Add images of other renderers: name,seconds,file.exr")
        ->type_name("E.csv");
    app.add_option("-o,--output", o->output,
                   "Write files whose names begin with OUT, or to DIR/ [the scene's name]")
        ->group(kCommonOptions)
        ->type_name("OUT|DIR/");
    app.add_option("--report", o->report, "Write a page with images and curves")
        ->group(kCommonOptions)
        ->check([](const std::string& file) {
            return file.ends_with(".html") ? "" : file + " does not end in .html";
        })
        ->type_name("R.html");
    AddCheckpointInterval(app, &o->render.checkpoint);
    app.footer(kFooter);
}

std::vector<MonitoredRule> MakeRules(const Options& options, const RenderJob& render) {
    const ScheduleOptions& schedule = options.render.schedule;
    std::vector<std::string> texts = BenchRules(schedule.passLength, schedule.cap);
    texts.push_back("learned");
    if (options.denoise) texts.push_back(kDenoisedRuleName);
    for (const std::string& rule : options.rules)
        if (std::ranges::find(texts, rule) == texts.end()) texts.push_back(rule);
    std::vector<MonitoredRule> rules;
    for (const std::string& text : texts) {
        const Rule rule = render.ReadRule("--rule", text);
        rules.push_back({text, rule.text, rule.smallestSide, CriteriaOf(rule),
                         IsRule(text, kDenoisedRuleName)});
    }
    return rules;
}

std::vector<SamplerKind> SamplersOf(const Options& options) {
    std::vector<SamplerKind> samplers;
    for (const std::string& name : options.samplers)
        samplers.push_back(*ValueNamed<SamplerKind>(name));
    return samplers;
}

void CheckSamplers(const std::vector<std::string>& samplers) {
    for (const std::string& sampler : samplers)
        if (std::ranges::count(samplers, sampler) > 1)
            throw UsageError("--samplers: " + sampler + " is given twice");
}

std::string CheckpointName(const Options& options, SamplerKind sampler) {
    return fmt::format("{}.{}.checkpoint", options.output, NameOf(sampler));
}

// All that the renders of the scene have in common.
struct Bench {
    Bench(const Options& options, MpiJob* ranks)
        : options(options), render(options.render, ranks) {}

    Options options;
    RenderJob render;
    std::string sceneHash;
    std::vector<MonitoredRule> rules;
    std::vector<ExternalImage> external;
    std::vector<RgbImage> externalImages;
    std::optional<RgbImage> reference;  // set by the first render, unless it was given
    std::vector<BenchPoint> points;
};

void CheckFiles(Bench* bench) {
    const Options& options = bench->options;
    std::vector<NamedFile> outputs = {{"-o", options.output + ".csv"},
                                      {"--report", options.report}};
    for (const SamplerKind sampler : SamplersOf(options))
        outputs.push_back({"the checkpoint", CheckpointName(options, sampler)});
    std::vector<NamedFile> inputs = {{"--reference", options.reference},
                                     {"--external", options.external}};
    for (const ExternalImage& image : bench->external)
        inputs.push_back({"an image of --external", image.file});
    for (const std::string& rule : options.rules) AddFileOfRule(rule, &inputs);
    bench->render.CheckFiles(std::move(outputs), std::move(inputs));
    bench->render.LockResults(options.output + ".csv");
}

// Checks all that can be wrong before the work begins.
std::unique_ptr<Bench> Prepare(const Options& options, MpiJob* ranks) {
    auto bench = std::make_unique<Bench>(options, ranks);
    RenderJob& render = bench->render;
    const PixelRect& region = render.input.region;
    if (options.denoise) {
        CheckFilmFits(region, {.layers = {.features = true}});
        render.DenoiseBlocks();
    }
    bench->rules = MakeRules(options, render);
    if (!options.external.empty()) bench->external = ReadExternalImages(options.external);
    CheckFiles(bench.get());
    if (!options.reference.empty()) bench->reference = ReadImageOfSize(options.reference, region);
    for (const ExternalImage& external : bench->external)
        bench->externalImages.push_back(ReadImageOfSize(external.file, region));
    render.Compile();
    for (const SamplerKind sampler : SamplersOf(options)) render.CheckSampler(sampler);
    bench->sceneHash = SceneHash(render.input.description);
    return bench;
}

// Prints how far the comparisons are, at most once in ten seconds.
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

// Returns how to render with a sampler.
SessionOptions MakeOptions(const Bench& bench, SamplerKind sampler) {
    Provenance provenance = bench.render.provenance;
    provenance.sampler = sampler;
    for (const MonitoredRule& rule : bench.rules) provenance.criterion += rule.text + " ";
    SessionOptions how = bench.render.MakeSessionOptions(false);
    how.render.sampler = sampler;
    how.checkpoint.isKept = true;
    how.identity = IdentityOf(provenance, bench.sceneHash);
    how.film.layers.features = bench.options.denoise;
    return how;
}

// Adds the points of a sampler. The whole image of the first is the reference, unless another was
// given.
void AddPoints(SamplerKind sampler, const MonitoredRender& monitored, Bench* bench) {
    const bool makesReference = !bench->reference;
    const int threads = monitored.result.threads;
    if (makesReference) bench->reference = TakeWholeImage(monitored).image;
    PointCounter counter(bench->rules.size(), bench->options.render);
    for (BenchPoint point :
         MeasurePoints(monitored, bench->rules, *bench->reference, bench->options.display, threads,
                       [&] { counter.Add(); })) {
        point.sampler = NameOf(sampler);
        point.sharesReference = makesReference;
        bench->points.push_back(std::move(point));
    }
}

// Renders with a sampler, or continues an earlier run, and adds its points. Returns false if it was
// interrupted. The ranks share the render, and the first measures.
bool BenchSampler(SamplerKind sampler, Bench* bench) {
    RenderJob& render = bench->render;
    RenderSettings& settings = render.settings;
    const PixelRect& region = render.input.region;
    settings.checkpoint = ResumeIfThere(CheckpointName(bench->options, sampler),
                                        bench->options.render.checkpoint.interval);
    render.LockCheckpoint();
    std::vector<BlockHistory> histories(MakeBlocks(region, settings.schedule).size());
    SessionOptions how = MakeOptions(*bench, sampler);
    how.render.makeCriterion = MakeMonitors(bench->rules, region, settings.schedule,
                                            {.snapshots = true, .goesOn = true}, &histories);
    Session session(*render.scene, region, how);
    if (!settings.quiet) TalkOf(settings).Note("rendering with " + NameOf(sampler));
    const RenderResult result = render.Run(&session);
    if (result.cancelled) return false;
    if (session.Leads())
        AddPoints(sampler, {session.Context(), session.Options(), result, histories}, bench);
    return true;
}

// Returns notes for the reader of the points.
std::vector<std::string> Notes(const Options& options) {
    std::vector<std::string> notes;
    if (options.reference.empty())
        notes.push_back(fmt::format(
            "The reference is the image of {} at the cap: it holds the samples of that sampler's "
            "other images, so that their errors are understated near the cap.",
            options.samplers.front()));
    notes.push_back(
        "Seconds are the measured CPU time, of the samples and of the rule, divided "
        "by the number of threads.");
    return notes;
}

// Writes the points, and the page. Throws Error where one of them is not where it should be.
void WriteBench(const Bench& bench, const std::vector<std::string>& names) {
    const Options& options = bench.options;
    ResultFiles results;
    results.WriteText(options.output + ".csv", BenchCsv(bench.points));
    if (!options.report.empty())
        results.WriteText(
            options.report,
            MakeBenchPage(SceneName(options.render.scene.file), bench.render.provenance,
                          bench.points, names, *bench.reference, options.display, Notes(options)));
    for (const std::string& name : results.Names()) fmt::print("{}\n", name);
    results.Check();
}

ExitCode RunBench(Options options, MpiJob* ranks) {
    RenderSettings& settings = options.render;
    SetWording(settings, ranks);
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    if (options.samplers.empty()) options.samplers = {"sobol-halves", "random"};
    CheckSamplers(options.samplers);
    options.output = BeginningOfNames(options.output, SceneName(settings.scene.file) + ".bench");
    const std::unique_ptr<Bench> bench = Prepare(options, ranks);
    const std::vector<SamplerKind> samplers = SamplersOf(options);
    bool isInterrupted = false;
    std::vector<std::string> names;
    for (const SamplerKind sampler : samplers) {
        names.push_back(NameOf(sampler));
        if ((isInterrupted = !BenchSampler(sampler, bench.get()))) break;
    }
    if (const auto code = bench->render.End(isInterrupted)) return *code;
    for (size_t i = 0; i < bench->external.size(); ++i)
        bench->points.push_back(MeasureExternal(bench->external[i], bench->externalImages[i],
                                                *bench->reference, options.display));
    WriteBench(*bench, names);
    for (const SamplerKind sampler : samplers)
        std::filesystem::remove(CheckpointName(options, sampler));
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command, MpiJob* job) {
    CLI::App* bench = app.add_subcommand(
        "bench",
        "Plots error against time and samples, for fixed sample counts and stopping rules.");
    auto options = std::make_shared<Options>();
    AddOptions(*bench, options.get());
    bench->callback([=] { *command = [=] { return RunBench(*options, job); }; });
}

}  // namespace lull::bench
