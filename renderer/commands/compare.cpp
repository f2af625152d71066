// `lull compare`: the automatic image, the image at human thresholds and the reference.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <filesystem>
#include <sstream>

#include "renderer/commands/command.h"
#include "renderer/commands/compare_options.h"
#include "renderer/commands/comparison_table.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/render_files.h"
#include "renderer/input/scene_hash.h"
#include "renderer/measure/compared_files.h"
#include "renderer/output/file_io.h"
#include "renderer/ranks/job.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

// Writes figures and page, and prints the table and the names of the files, `images` first.
void WriteReport(const CompareOptions& options, ComparisonReport report,
                 const std::vector<std::string>& images) {
    if (const std::string note = DisplayNote(report.comparison); !note.empty()) {
        fmt::print(stderr, "lull: {}\n", note);
        report.notes.push_back(note);
    }
    const std::string json = options.output + ".compare.json";
    WriteFileAtomically(json, Dump(ComparisonJson(report)));
    if (!options.report.empty()) WriteFileAtomically(options.report, MakeComparisonPage(report));
    fmt::print("{}", ComparisonTable(report));
    for (const std::string& file : images) fmt::print("{}\n", file);
    fmt::print("{}\n", json);
    if (!options.report.empty()) fmt::print("{}\n", options.report);
}

void CheckOutputs(const CompareOptions& options) {
    CheckWritable(options.output + ".compare.json");
    if (!options.report.empty()) CheckWritable(options.report);
}

// Compares images from files.
ExitCode CompareFiles(CompareOptions options) {
    if (options.output.empty()) options.output = "lull";
    if (options.reference.empty() || (options.automatic.empty() && options.human.empty()))
        throw Error(
            "compare: a scene is missing, or images: --reference and --automatic or --human");
    if (!options.human.empty() && !IsImageFile(options.human))
        throw Error("--human " + options.human +
                    ": thresholds need a scene; without one, an image");
    CheckOutputs(options);

    std::vector<ComparedFile> files;
    if (!options.automatic.empty())
        files.push_back(ReadComparedFile(options.automatic, "automatic"));
    if (!options.human.empty()) files.push_back(ReadComparedFile(options.human, "human"));
    files.push_back(ReadComparedFile(options.reference, "reference"));

    ComparisonReport report;
    report.title = options.reference;
    report.comparison = ComparisonOf(std::move(files), options.reference, options.render.schedule);
    Measure(&report.comparison);
    WriteReport(options, report, {});
    return kDone;
}

// Holds a scene that is ready, and the rules to be compared on it.
struct Job {
    std::unique_ptr<const Scene> scene;
    Provenance provenance;
    std::vector<ObservedRule> rules;
    RenderIdentity identity;
    std::map<std::string, int> warnings;
};

ObservedRule MakeRule(const std::string& name, const CriterionFactory& factory) {
    return {name, factory.rule, factory.smallestSide, factory.make};
}

// Loads the scene and checks all that can be wrong before the work begins.
Job Prepare(const CompareOptions& options, bool leads) {
    const RenderSettings& settings = options.render;
    SceneInput input(settings.scene);

    Job job;
    const CriterionFactory automatic = ReadRule("--stop", options.rule, settings, input.region);
    job.rules.push_back(MakeRule("automatic", automatic));
    std::string humanChecksum = "none";
    if (!options.human.empty() && !IsImageFile(options.human)) {
        RenderSettings plain = settings;
        plain.caution = 1;
        const CriterionFactory human =
            ReadRule("--human", "thresholds:" + options.human, plain, input.region);
        job.rules.push_back(MakeRule("human", human));
        humanChecksum = human.checksum;
    }
    if (leads) CheckOutputs(options);
    if (leads) CheckCheckpoint(settings.checkpoint);
    job.scene = CompileScene(settings, &input);
    job.warnings = input.warnings.Counts();
    job.provenance = MakeProvenance(settings, *job.scene, input.film);
    job.provenance.criterion = automatic.rule;
    job.provenance.checksum = automatic.checksum;
    job.identity = IdentityOf(job.provenance, SceneHash(input.description));
    job.identity["human"] = humanChecksum;
    job.identity["snapshots"] = options.snapshots ? "yes" : "no";
    job.identity["curves"] = options.report.empty() ? "no" : "yes";
    return job;
}

// Renders the automatic image by itself.
Verification Verify(const Job& job, const RenderSettings& settings, int threads,
                    const ComparedImage& expected) {
    ProgressPrinter printer = MakePrinter(settings, true);
    RenderOptions options = MakeRenderOptions(settings, job.provenance.sampler, &printer);
    options.schedule.smallestSide = job.rules.front().smallestSide;
    options.threads = threads;
    options.makeCriterion = job.rules.front().make;
    Film film(job.provenance.crop);
    if (!settings.quiet) fmt::print(stderr, "lull: the automatic image by itself\n");
    const RenderResult result = Render(SamplesOf(*job.scene, settings.estimator), options, &film);
    printer.Finish(result.progress);

    return VerificationOf(result, film, expected);
}

std::vector<std::string> WriteImages(const CompareOptions& options, const Job& job,
                                     const Comparison& comparison) {
    std::vector<std::string> names;
    const std::vector<Block> blocks = MakeBlocks(comparison.region, options.render.schedule);
    for (const ComparedImage& image : comparison.images) {
        if (image.wallSeconds) continue;  // is a file already
        const std::string base = options.output + "." + image.name;
        std::vector<int> spp;
        for (const BlockCost& cost : image.costs) spp.push_back(cost.spp);
        Provenance provenance = job.provenance;
        provenance.criterion =
            image.rule.empty() ? fmt::format("fixed:{}", comparison.cap) : image.rule;
        if (image.name != "automatic") provenance.checksum.clear();
        WriteImage(base + ".exr", base + ".png", *job.scene, image.image, blocks, spp, provenance,
                   SumCosts(comparison, image).seconds);
        names.insert(names.end(), {base + ".exr", base + ".png"});
    }
    ThresholdsRow row{SceneName(options.render.scene.file), {}};
    for (const BlockCost& cost : comparison.images.front().costs) row.spp.push_back(cost.spp);
    std::ostringstream text;
    WriteThresholds(text, {row});
    names.push_back(options.output + ".thresholds.csv");
    WriteFileAtomically(names.back(), text.str());
    return names;
}

// The ranks share the render that all images come from; the first does the rest.
ExitCode CompareRenders(CompareOptions options, lull::Job* ranks) {
    const bool leads = ranks->Rank() == 0;
    RenderSettings& settings = options.render;
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    if (options.output.empty()) options.output = SceneName(settings.scene.file);
    if (!options.snapshots && options.reference.empty())
        throw Error(
            "compare: a reference is missing: --snapshots renders one, to the cap; "
            "--reference R.exr takes one rendered before");
    const Job job = Prepare(options, leads);
    const PixelRect& region = job.provenance.crop;

    ComparisonReport report;
    Comparison& comparison = report.comparison;
    comparison = BeginComparison(region, settings.schedule);
    comparison.cap = settings.schedule.cap;
    std::vector<ComparedImage> fromFiles;
    if (IsImageFile(options.human))
        fromFiles.push_back(ReadImageBeside(options.human, "human", comparison));
    if (!options.reference.empty())
        fromFiles.push_back(ReadImageBeside(options.reference, "reference", comparison));

    Film film(region);
    std::optional<RenderState> interrupted;
    if (leads) interrupted = Resume(settings.checkpoint, job.identity, &film);
    report.histories.resize(comparison.blocks.size());
    ProgressPrinter printer = MakePrinter(settings, !options.snapshots);
    CatchInterrupts();
    RenderOptions render = MakeRenderOptions(settings, job.provenance.sampler, &printer);
    render.makeCriterion = MakeObservers(job.rules, region, settings.schedule,
                                         {.snapshots = true,
                                          .noise = true,
                                          .curves = !options.report.empty(),
                                          .goesOn = options.snapshots},
                                         &report.histories);
    WriteCheckpoints(settings.checkpoint, job.identity, film, &render);
    const SampleSource source = SamplesOf(*job.scene, settings.estimator);
    ShareAmongRanks(ranks, &render);
    ranks->Begin(TextOf(job.identity));
    const RenderResult result =
        Render(source, render, &film, interrupted ? &*interrupted : nullptr);
    ranks->End();
    if (!leads) return kDone;
    printer.Finish(result.progress);
    if (result.cancelled) {
        fmt::print(stderr, "lull: interrupted{}\n",
                   settings.checkpoint.file.empty()
                       ? "; nothing was written, as there is no --checkpoint"
                       : "; --resume goes on from " + settings.checkpoint.file);
        return kInterrupted;
    }

    const ObservedRender observed{source, render, film, result, report.histories};
    for (size_t i = 0; i < job.rules.size(); ++i)
        comparison.images.push_back(TakeImage(observed, job.rules, i));
    if (options.snapshots) comparison.images.push_back(TakeWholeImage(observed));
    for (ComparedImage& image : fromFiles) comparison.images.push_back(std::move(image));
    if (options.snapshots && IsImageFile(options.human))  // the reference is to be the last
        std::swap(comparison.images.back(), *(comparison.images.end() - 2));
    Measure(&comparison);
    if (options.snapshots)
        report.estimates = JudgeEstimates(comparison.images.front(), comparison.images.back());
    for (const int threads : options.verify) {
        const Verification v = Verify(job, settings, threads, comparison.images.front());
        if (Interrupted()) break;
        report.verifications.push_back(v);
    }

    report.provenance = job.provenance;
    report.decisions = result.blocks;
    report.warnings = job.warnings;
    report.title = SceneName(settings.scene.file);
    if (options.snapshots)
        report.notes.push_back(
            "The reference holds the samples of the other images, so that errors near the cap are "
            "understated.");
    WriteReport(options, report, WriteImages(options, job, comparison));
    if (!settings.checkpoint.file.empty()) std::filesystem::remove(settings.checkpoint.file);
    return Interrupted() ? kInterrupted : kDone;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Command* command, lull::Job* ranks) {
    CLI::App* compare = app.add_subcommand(
        "compare", "Compares automatic stopping with people's thresholds and with a reference.");
    auto options = std::make_shared<CompareOptions>();
    AddCompareOptions(*compare, options.get());
    compare->callback([=] {
        *command = [=] {
            if (!options->render.scene.file.empty()) return CompareRenders(*options, ranks);
            return ranks->Rank() == 0 ? CompareFiles(*options) : kDone;
        };
    });
}

}  // namespace lull
