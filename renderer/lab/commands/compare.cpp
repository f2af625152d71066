// `lull compare`: the automatic image, the image at human thresholds and the reference.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <filesystem>

#include "renderer/commands/render_job.h"
#include "renderer/lab/commands/compare_options.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/commands/tables.h"
#include "renderer/lab/comparison/compared_files.h"
#include "renderer/lab/comparison/comparison.h"
#include "renderer/mpi/job.h"
#include "renderer/results/image_files.h"
#include "renderer/results/report.h"
#include "stopping/base/parallel.h"
#include "stopping/rules/baselines.h"

namespace lull::compare {

namespace {

// Those with an effect on images from files, and on those made of pictures.
constexpr const char* kOptionsOfFiles[] = {
    "--automatic", "--human",  "--reference", "--block", "--viewing",
    "--threads",   "--output", "--report",    "--quiet", "--json-progress"};
constexpr const char* kOptionsOfPictures[] = {
    "--images",  "--human",   "--stop",   "--caution", "--quality", "--block",
    "--viewing", "--threads", "--output", "--report",  "--quiet",   "--json-progress"};

std::vector<NamedFile> OutputsOf(const CompareOptions& options,
                                 const std::vector<std::string>& rendered) {
    std::vector<NamedFile> outputs = {{"-o", options.output + ".compare.json"},
                                      {"--report", options.report}};
    for (const std::string& image : rendered)
        for (const char* extension : {".exr", ".png"})
            outputs.push_back({"-o", fmt::format("{}.{}{}", options.output, image, extension)});
    if (!rendered.empty()) outputs.push_back({"-o", options.output + ".thresholds.csv"});
    return outputs;
}

std::vector<NamedFile> InputsOf(const CompareOptions& options) {
    std::vector<NamedFile> inputs = {{"--automatic", options.automatic},
                                     {"--human", options.human},
                                     {"--reference", options.reference}};
    AddFileOfRule("thresholds:" + options.human, &inputs);
    AddFileOfRule(options.rule, &inputs);
    return inputs;
}

ExitCode CompareFiles(CompareOptions options) {
    if (options.reference.empty() || (options.automatic.empty() && options.human.empty()))
        throw Error(
            "compare: a scene is missing, or images: --reference and --automatic or --human");
    if (!options.human.empty() && !IsImageFile(options.human))
        throw Error("--human {}: thresholds need a scene; without one, an image", options.human);
    options.output = BeginningOfNames(options.output, "lull");
    CheckOutputs(OutputsOf(options, {}), InputsOf(options));
    const std::optional<FileLock> lock = LockOutput(options.output + ".compare.json");

    std::vector<ComparedFile> files;
    if (!options.automatic.empty())
        files.push_back(ReadComparedFile(options.automatic, "automatic"));
    if (!options.human.empty()) files.push_back(ReadComparedFile(options.human, "human"));
    files.push_back(ReadComparedFile(options.reference, "reference"));

    ComparisonReport report;
    report.title = std::filesystem::path(options.reference).filename().string();
    report.comparison = ComparisonOf(std::move(files), options.reference, options.render.schedule);
    report.comparison.display = options.display;
    RunWithThreads(options.render.scene.compile.threads, [&] { Measure(&report.comparison); });
    WriteComparison(options, report, {});
    return kDone;
}

std::vector<ComparedImage> ReadImagesBeside(const CompareOptions& options,
                                            const Comparison& comparison) {
    std::vector<ComparedImage> images;
    if (IsImageFile(options.human))
        images.push_back(ReadImageBeside(options.human, "human", comparison));
    if (!options.reference.empty())
        images.push_back(ReadImageBeside(options.reference, "reference", comparison));
    return images;
}

struct Compared {
    Compared(const CompareOptions& options, MpiJob* ranks)
        : options(options), render(options.render, ranks) {
        this->options.render.schedule.eyeWidth = render.settings.schedule.eyeWidth;
    }

    CompareOptions options;
    RenderJob render;
    std::vector<MonitoredRule> rules;  // after those of the images, those of the curves
    size_t imageCount = 0;
    std::string humanChecksum = "none";
    ComparisonReport report;
    std::vector<ComparedImage> fromFiles;
};

MonitoredRule MakeRule(const std::string& name, const Rule& rule) {
    return {name, rule.text, rule.smallestSide, CriteriaOf(rule)};
}

void AddOtherRules(Compared* compared) {
    const CompareOptions& options = compared->options;
    if (!options.human.empty() && !IsImageFile(options.human)) {
        const Rule human = compared->render.ReadRule("--human", "thresholds:" + options.human, 1);
        compared->rules.push_back(MakeRule("human", human));
        compared->humanChecksum = human.checksum;
    }
    if (!options.denoise) return;
    CheckFilmFits(compared->render.region, {.layers = {.features = true}});
    compared->render.DenoiseBlocks();
    compared->rules.push_back(
        MakeRule("denoised", compared->render.ReadRule("--denoise", kDenoisedRuleName)));
    compared->rules.back().isDenoised = true;
}

void AddCurveRules(Compared* compared) {
    const ScheduleOptions& schedule = compared->options.render.schedule;
    for (const std::string& text : CurveRules(schedule.passLength, schedule.cap))
        compared->rules.push_back(MakeRule(text, compared->render.ReadRule("--curves", text)));
}

std::unique_ptr<Compared> Prepare(const CompareOptions& given, MpiJob* ranks) {
    auto compared = std::make_unique<Compared>(given, ranks);
    const CompareOptions& options = compared->options;
    RenderJob& render = compared->render;
    const PixelRect& region = render.region;
    const Rule automatic = render.ReadRule("--stop", options.rule);
    compared->rules.push_back(MakeRule("automatic", automatic));
    AddOtherRules(compared.get());
    std::vector<std::string> rendered;
    for (const MonitoredRule& rule : compared->rules) rendered.push_back(rule.name);
    compared->imageCount = compared->rules.size();
    if (options.curves) AddCurveRules(compared.get());
    if (options.snapshots) rendered.push_back("reference");
    render.CheckFiles(OutputsOf(options, rendered), InputsOf(options));
    render.LockResults(options.output + ".compare.json");
    render.Compile();
    render.CheckSampler();
    render.provenance.criterion = automatic.text;
    render.provenance.checksum = automatic.checksum;
    Comparison& comparison = compared->report.comparison;
    comparison = BeginComparison(region, options.render.schedule);
    comparison.cap = options.render.schedule.cap;
    compared->fromFiles = ReadImagesBeside(options, comparison);
    compared->report.histories.resize(comparison.blocks.size());
    return compared;
}

SessionOptions MakeOptions(Compared* compared) {
    const CompareOptions& options = compared->options;
    const bool hasPage = !options.report.empty();
    SessionOptions how = compared->render.MakeSessionOptions(!options.snapshots);
    how.render.makeCriterion = MakeMonitors(
        compared->rules, compared->render.region, options.render.schedule,
        {.snapshots = true, .noise = true, .curves = hasPage, .goesOn = options.snapshots},
        &compared->report.histories);
    how.film.layers.features = options.denoise;
    how.identity = compared->render.Identity();
    how.identity["human"] = compared->humanChecksum;
    how.identity["snapshots"] = options.snapshots ? "yes" : "no";
    how.identity["curves"] = hasPage ? "yes" : "no";
    how.identity["error curves"] = options.curves ? "yes" : "no";
    return how;
}

// Renders the automatic image by itself.
Verification Verify(const Compared& compared, int threads, const ComparedImage& expected) {
    const RenderJob& render = compared.render;
    SessionOptions how = render.MakeSessionOptions(true, false);
    how.render.schedule.smallestSide = compared.rules.front().smallestSide;
    how.render.threads = threads;
    how.render.makeCriterion = compared.rules.front().make;
    if (!render.settings.quiet) MessagesOf(render.settings).Note("the automatic image by itself");
    Session session(*render.scene, render.region, how);
    const RenderResult result = session.Run();
    return VerificationOf(result, session.GetFilm(), expected);
}

ResultFiles WriteImages(const Compared& compared) {
    const CompareOptions& options = compared.options;
    const RenderJob& render = compared.render;
    const Comparison& comparison = compared.report.comparison;
    ResultFiles results;
    const std::vector<Block> blocks = MakeBlocks(comparison.region, options.render.schedule);
    for (const ComparedImage& image : comparison.images) {
        if (image.wallSeconds) continue;  // is a file already
        const std::string base = options.output + "." + image.name;
        std::vector<int> spp;
        for (const BlockCost& cost : image.costs) spp.push_back(cost.spp);
        Provenance provenance = render.provenance;
        provenance.criterion =
            image.rule.empty() ? fmt::format("fixed:{}", comparison.cap) : image.rule;
        if (image.name != "automatic") provenance.checksum.clear();
        WriteImage({base + ".exr", base + ".png"}, {*render.scene, provenance},
                   {image.image, blocks, spp, SumCosts(comparison, image).seconds}, &results);
    }
    std::vector<int> thresholds;
    for (const BlockCost& cost : comparison.images.front().costs) thresholds.push_back(cost.spp);
    results.Write(options.output + ".thresholds.csv", [&](const std::string& file) {
        WriteThresholdsOf(file, options.render.scene.file, thresholds);
    });
    return results;
}

void AddImages(const MonitoredRender& monitored, Compared* compared) {
    const CompareOptions& options = compared->options;
    ComparisonReport* report = &compared->report;
    Comparison& comparison = report->comparison;
    for (size_t i = 0; i < compared->imageCount; ++i)
        comparison.images.push_back(TakeImage(monitored, compared->rules, i));
    if (options.snapshots) comparison.images.push_back(TakeWholeImage(monitored));
    for (ComparedImage& image : compared->fromFiles) comparison.images.push_back(std::move(image));
    if (options.snapshots && IsImageFile(options.human))  // the reference is to be the last
        std::swap(comparison.images.back(), *(comparison.images.end() - 2));
    comparison.display = options.display;
    Measure(&comparison);
    if (options.snapshots)
        report->estimates = CompareEstimates(comparison.images.front(), comparison.images.back());
    if (!options.curves) return;
    if (!options.render.quiet) MessagesOf(options.render).Note("measuring the curves");
    report->curvePoints =
        MeasureCurves(monitored, compared->rules, compared->imageCount, comparison);
    report->curvesShareReference = options.snapshots;
}

// Renders the automatic image by itself on as many threads as asked for, until it is interrupted.
void VerifyAll(Compared* compared) {
    ComparisonReport& report = compared->report;
    for (const int threads : compared->options.verify) {
        const Verification v = Verify(*compared, threads, report.comparison.images.front());
        if (Interrupted()) break;
        report.verifications.push_back(v);
    }
}

void WriteResults(const RenderResult& result, Compared* compared) {
    const CompareOptions& options = compared->options;
    const RenderJob& render = compared->render;
    ComparisonReport& report = compared->report;
    report.provenance = render.provenance;
    report.decisions = result.blocks;
    report.warnings = render.warnings.Counts();
    report.title = SceneName(render.settings.scene.file);
    if (options.snapshots)
        report.notes.push_back(
            "The reference holds the samples of the other images, so that errors near the cap are "
            "understated.");
    WriteComparison(options, report, WriteImages(*compared));
}

ExitCode CompareRenders(CompareOptions options, MpiJob* ranks) {
    RenderSettings& settings = options.render;
    SetWording(settings, ranks);
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    if (!options.snapshots && options.reference.empty())
        throw Error(
            "compare: a reference is missing: --snapshots renders one, to the cap; "
            "--reference R.exr takes one rendered before");
    options.output = BeginningOfNames(options.output, SceneName(settings.scene.file));
    const std::unique_ptr<Compared> compared = Prepare(options, ranks);
    const RenderJob& render = compared->render;
    Session session(*render.scene, render.region, MakeOptions(compared.get()));
    const RenderResult result = render.Run(&session);
    if (const auto code = render.End(result.cancelled)) return *code;

    AddImages({session.Options(), result, compared->report.histories}, compared.get());
    VerifyAll(compared.get());
    WriteResults(result, compared.get());
    render.RemoveCheckpoint();
    return Interrupted() ? kInterrupted : kDone;
}

}  // namespace

void WriteComparison(const CompareOptions& options, ComparisonReport report, ResultFiles results) {
    if (const std::string note = DisplayNote(report.comparison); !note.empty()) {
        MessagesOf(options.render).Note(note);
        report.notes.push_back(note);
    }
    results.WriteText(options.output + ".compare.json", Dump(ComparisonJson(report)));
    if (!options.report.empty()) results.WriteText(options.report, MakeComparisonPage(report));
    fmt::print("{}", ComparisonTable(report));
    results.PrintAndCheck();
}

void AddCommand(CLI::App& app, Command* command, MpiJob* job) {
    CLI::App* compare = app.add_subcommand(
        "compare", "Compares automatic stopping with human thresholds and with a reference.");
    auto options = std::make_shared<CompareOptions>();
    AddCompareOptions(*compare, options.get());
    compare->callback([=] {
        const bool hasPictures = !options->render.scene.file.empty() || !options->images.empty();
        if (compare->count("--stop") > 0 && !hasPictures)
            throw CLI::ValidationError("--stop", "needs a SCENE, or --images");
        if (!options->images.empty())
            AllowOnly(*compare, kOptionsOfPictures, "with --images");
        else if (!hasPictures)
            AllowOnly(*compare, kOptionsOfFiles, "without a SCENE");
        *command = [=] {
            if (!options->render.scene.file.empty()) return CompareRenders(*options, job);
            if (job->Rank() > 0) return kDone;
            return options->images.empty() ? CompareFiles(*options) : CompareFolder(*options);
        };
    });
}

}  // namespace lull::compare
