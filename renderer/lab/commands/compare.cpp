// `lull compare`: the automatic image, the image at human thresholds and the reference.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <filesystem>

#include "renderer/commands/command.h"
#include "renderer/commands/input_files.h"
#include "renderer/commands/interrupt.h"
#include "renderer/commands/session_options.h"
#include "renderer/commands/talk.h"
#include "renderer/input/scene_hash.h"
#include "renderer/lab/commands/compare_options.h"
#include "renderer/lab/commands/comparison_table.h"
#include "renderer/lab/comparison/compared_files.h"
#include "renderer/mpi/job.h"
#include "renderer/render/block_denoiser.h"
#include "renderer/results/block_files.h"
#include "renderer/results/image_files.h"
#include "stopping/rules/denoised.h"

namespace lull {

namespace {

// Writes figures and page beside what was written before, and prints the table and the names of
// all files. Throws Error where one is not where it should be.
void WriteReport(const CompareOptions& options, ComparisonReport report, ResultFiles results) {
    if (const std::string note = DisplayNote(report.comparison); !note.empty()) {
        TalkOf(options.render).Note(note);
        report.notes.push_back(note);
    }
    results.WriteText(options.output + ".compare.json", Dump(ComparisonJson(report)));
    if (!options.report.empty()) results.WriteText(options.report, MakeComparisonPage(report));
    fmt::print("{}", ComparisonTable(report));
    for (const std::string& file : results.Names()) fmt::print("{}\n", file);
    results.Check();
}

// Throws Error where a result would replace another or an input, or could not be written now;
// `rendered` are the images that come from the scene, if there is one.
void CheckFiles(const CompareOptions& options, const std::vector<std::string>& rendered,
                std::vector<NamedFile> inputs) {
    std::vector<NamedFile> outputs = {{"-o", options.output + ".compare.json"},
                                      {"--report", options.report},
                                      {"--checkpoint", options.render.checkpoint.file}};
    for (const std::string& image : rendered)
        for (const char* extension : {".exr", ".png"})
            outputs.push_back({"-o", fmt::format("{}.{}{}", options.output, image, extension)});
    if (!rendered.empty()) outputs.push_back({"-o", options.output + ".thresholds.csv"});
    inputs.push_back({"--automatic", options.automatic});
    inputs.push_back({"--human", options.human});
    inputs.push_back({"--reference", options.reference});
    AddFileOfRule("thresholds:" + options.human, &inputs);
    AddFileOfRule(options.rule, &inputs);
    CheckOutputs(outputs, inputs);
}

// Compares images from files.
ExitCode CompareFiles(CompareOptions options) {
    if (options.reference.empty() || (options.automatic.empty() && options.human.empty()))
        throw Error(
            "compare: a scene is missing, or images: --reference and --automatic or --human");
    if (!options.human.empty() && !IsImageFile(options.human))
        throw Error("--human " + options.human +
                    ": thresholds need a scene; without one, an image");
    options.output = BeginningOfNames(options.output, "lull");
    CheckFiles(options, {}, {});

    std::vector<ComparedFile> files;
    if (!options.automatic.empty())
        files.push_back(ReadComparedFile(options.automatic, "automatic"));
    if (!options.human.empty()) files.push_back(ReadComparedFile(options.human, "human"));
    files.push_back(ReadComparedFile(options.reference, "reference"));

    ComparisonReport report;
    report.title = std::filesystem::path(options.reference).filename().string();
    report.comparison = ComparisonOf(std::move(files), options.reference, options.render.schedule);
    Measure(&report.comparison);
    WriteReport(options, report, {});
    return kDone;
}

// Holds a scene that is ready, and the rules to be compared on it.
struct PreparedScene {
    std::unique_ptr<const Scene> scene;
    Provenance provenance;
    std::vector<ObservedRule> rules;
    RenderIdentity identity;
    std::map<std::string, int> warnings;
    std::shared_ptr<BlockDenoiser> denoiser;  // null: nothing is denoised
};

ObservedRule MakeRule(const std::string& name, const CriterionFactory& factory) {
    return {name, factory.rule, factory.smallestSide, factory.make};
}

// Loads the scene and checks all that can be wrong before the work begins.
PreparedScene Prepare(const CompareOptions& options, const Job& job) {
    const RenderSettings& settings = options.render;
    SceneInput input(settings.scene, {.grid = GridOf(settings.schedule)}, TalkOf(settings));

    PreparedScene prepared;
    const CriterionFactory automatic = ReadRule("--stop", options.rule, settings, input.region);
    prepared.rules.push_back(MakeRule("automatic", automatic));
    std::string humanChecksum = "none";
    if (!options.human.empty() && !IsImageFile(options.human)) {
        RenderSettings plain = settings;
        plain.caution = 1;
        const CriterionFactory human =
            ReadRule("--human", "thresholds:" + options.human, plain, input.region);
        prepared.rules.push_back(MakeRule("human", human));
        humanChecksum = human.checksum;
    }
    if (options.denoise) {
        CheckLayersFit({}, true, input.region);
        prepared.denoiser =
            std::make_shared<BlockDenoiser>(MakeBlocks(input.region, settings.schedule));
        ObservedRule& rule = prepared.rules.emplace_back(
            MakeRule("denoised", ReadRule("--denoise", denoisedRuleName, settings, input.region,
                                          {{denoisedRuleName, MeasureOf(prepared.denoiser)}})));
        rule.isDenoised = true;
    }
    if (job.Rank() == 0) {
        std::vector<std::string> rendered;
        for (const ObservedRule& rule : prepared.rules) rendered.push_back(rule.name);
        if (options.snapshots) rendered.push_back("reference");
        CheckFiles(options, rendered, InputsOf(settings.scene, input.description));
        CheckCheckpoint(settings.checkpoint);
    }
    prepared.scene = CompileScene(settings, &input);
    prepared.warnings = input.warnings.Counts();
    prepared.provenance = MakeProvenance(settings, *prepared.scene, input.film);
    prepared.provenance.criterion = automatic.rule;
    prepared.provenance.checksum = automatic.checksum;
    prepared.identity = IdentityOf(prepared.provenance, SceneHash(input.description));
    prepared.identity["human"] = humanChecksum;
    prepared.identity["snapshots"] = options.snapshots ? "yes" : "no";
    prepared.identity["curves"] = options.report.empty() ? "no" : "yes";
    return prepared;
}

// Renders the automatic image by itself.
Verification Verify(const PreparedScene& prepared, const RenderSettings& settings, int threads,
                    const ComparedImage& expected) {
    SessionOptions how = MakeSessionOptions(settings, prepared.provenance.sampler, true, nullptr);
    how.render.schedule.smallestSide = prepared.rules.front().smallestSide;
    how.render.threads = threads;
    how.render.makeCriterion = prepared.rules.front().make;
    if (!settings.quiet) TalkOf(settings).Note("the automatic image by itself");
    Session session(*prepared.scene, prepared.provenance.crop, how);
    const RenderResult result = session.Run();
    return VerificationOf(result, session.TheFilm(), expected);
}

ResultFiles WriteImages(const CompareOptions& options, const PreparedScene& prepared,
                        const Comparison& comparison) {
    ResultFiles results;
    const std::vector<Block> blocks = MakeBlocks(comparison.region, options.render.schedule);
    for (const ComparedImage& image : comparison.images) {
        if (image.wallSeconds) continue;  // is a file already
        const std::string base = options.output + "." + image.name;
        std::vector<int> spp;
        for (const BlockCost& cost : image.costs) spp.push_back(cost.spp);
        Provenance provenance = prepared.provenance;
        provenance.criterion =
            image.rule.empty() ? fmt::format("fixed:{}", comparison.cap) : image.rule;
        if (image.name != "automatic") provenance.checksum.clear();
        WriteImage({base + ".exr", base + ".png"}, {*prepared.scene, provenance},
                   {image.image, blocks, spp, SumCosts(comparison, image).seconds}, &results);
    }
    std::vector<int> thresholds;
    for (const BlockCost& cost : comparison.images.front().costs) thresholds.push_back(cost.spp);
    results.Write(options.output + ".thresholds.csv", [&](const std::string& file) {
        WriteThresholdsOf(file, options.render.scene.file, thresholds);
    });
    return results;
}

// Returns a comparison to which images are to be added.
Comparison Begin(const RenderSettings& settings, const PixelRect& region) {
    Comparison comparison = BeginComparison(region, settings.schedule);
    comparison.cap = settings.schedule.cap;
    return comparison;
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

// Takes all images from a render, adds those that were read, and measures them.
void AddImages(const CompareOptions& options, const std::vector<ObservedRule>& rules,
               const ObservedRender& observed, std::vector<ComparedImage> fromFiles,
               ComparisonReport* report) {
    Comparison& comparison = report->comparison;
    for (size_t i = 0; i < rules.size(); ++i)
        comparison.images.push_back(TakeImage(observed, rules, i));
    if (options.snapshots) comparison.images.push_back(TakeWholeImage(observed));
    for (ComparedImage& image : fromFiles) comparison.images.push_back(std::move(image));
    if (options.snapshots && IsImageFile(options.human))  // the reference is to be the last
        std::swap(comparison.images.back(), *(comparison.images.end() - 2));
    Measure(&comparison);
    if (options.snapshots)
        report->estimates = JudgeEstimates(comparison.images.front(), comparison.images.back());
}

ExitCode SayInterrupted(const RenderSettings& settings) {
    const std::string& file = settings.checkpoint.file;
    TalkOf(settings).Note("interrupted; " +
                          (file.empty() ? "nothing was written, as there is no --checkpoint"
                                        : "--resume goes on from " + file));
    return kInterrupted;
}

// The ranks share the render that all images come from; the first does the rest.
ExitCode CompareRenders(CompareOptions options, Job* job) {
    RenderSettings& settings = options.render;
    SetWording(settings, job);
    settings.schedule.cap = settings.cap.value_or(settings.schedule.cap);
    if (!options.snapshots && options.reference.empty())
        throw Error(
            "compare: a reference is missing: --snapshots renders one, to the cap; "
            "--reference R.exr takes one rendered before");
    options.output = BeginningOfNames(options.output, SceneName(settings.scene.file));
    const PreparedScene prepared = Prepare(options, *job);
    const PixelRect& region = prepared.provenance.crop;
    ComparisonReport report;
    report.comparison = Begin(settings, region);
    std::vector<ComparedImage> fromFiles = ReadImagesBeside(options, report.comparison);

    report.histories.resize(report.comparison.blocks.size());
    SessionOptions how =
        MakeSessionOptions(settings, prepared.provenance.sampler, !options.snapshots, job);
    how.render.makeCriterion = MakeObservers(prepared.rules, region, settings.schedule,
                                             {.snapshots = true,
                                              .noise = true,
                                              .curves = !options.report.empty(),
                                              .goesOn = options.snapshots},
                                             &report.histories);
    how.features = options.denoise;
    how.checkpoint = settings.checkpoint;
    how.identity = prepared.identity;
    Session session(*prepared.scene, region, how);
    if (options.denoise) prepared.denoiser->Show(&session.TheFilm(), session.Features());
    session.Resume();
    CatchInterrupts();
    const RenderResult result = session.Run();
    job->End();
    if (!session.Leads()) return kDone;
    if (result.cancelled) return SayInterrupted(settings);

    AddImages(options, prepared.rules,
              {session.Context(), session.Options(), result, report.histories},
              std::move(fromFiles), &report);
    for (const int threads : options.verify) {
        const Verification v =
            Verify(prepared, settings, threads, report.comparison.images.front());
        if (Interrupted()) break;
        report.verifications.push_back(v);
    }

    report.provenance = prepared.provenance;
    report.decisions = result.blocks;
    report.warnings = prepared.warnings;
    report.title = SceneName(settings.scene.file);
    if (options.snapshots)
        report.notes.push_back(
            "The reference holds the samples of the other images, so that errors near the cap are "
            "understated.");
    WriteReport(options, report, WriteImages(options, prepared, report.comparison));
    if (!settings.checkpoint.file.empty()) std::filesystem::remove(settings.checkpoint.file);
    return Interrupted() ? kInterrupted : kDone;
}

}  // namespace

void AddCompareCommand(CLI::App& app, Command* command, Job* job) {
    CLI::App* compare = app.add_subcommand(
        "compare", "Compares automatic stopping with people's thresholds and with a reference.");
    auto options = std::make_shared<CompareOptions>();
    AddCompareOptions(*compare, options.get());
    compare->callback([=] {
        *command = [=] {
            if (!options->render.scene.file.empty()) return CompareRenders(*options, job);
            return job->Rank() == 0 ? CompareFiles(*options) : kDone;
        };
    });
}

}  // namespace lull
