#include "renderer/lab/commands/compare_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/image/image_io.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/viewpoints/picture_folder.h"
#include "renderer/results/report.h"
#include "stopping/base/parallel.h"
#include "stopping/rules/thresholds.h"

namespace lull::compare {

namespace {

constexpr const char* kFooter =
    R"(With a scene and --snapshots, one render to the cap gives three images: "automatic", with blocks as
stopped by RULE, "human", with blocks at their human thresholds, and the "reference" at the cap.
Sample k of a pixel is always the same, so that three renders by this --sampler would give the same
bits. With --reference instead, each block is rendered to the larger of the two thresholds. Without a
scene, existing images are compared.

With --images the three images are made of another renderer's images. A block comes from the one
at which RULE stopped it, or from the first at or above its human threshold; the last image is the
reference. Names contain the samples per pixel, as for lull record --images.

With --denoise there is one more image, "denoised", that stops by the rule `denoised` and is
denoised as a whole; its samples are rendered again. The time of checks and denoising counts as the
rule's.

With --curves, that render also gives the error, time and samples of fixed sample counts and of the
stopping rules over a range of their settings: the measured CPU time divided by the number of threads.

Errors relative to the reference, for the image and each block: RMSE and relMSE (linear); RMSE of the
lightness L (0 to 100), PSNR, SSIM (Wang et al. 2004) and FLIP (Andersson et al. 2020) of the 8-bit
display image; "visible", its visible difference (ColorVideoVDP, Mantiuk et al. 2024) on --viewing,
0 for equal images; "seams", the jump of the noise level across block borders / inside blocks (1: no
seams). Images from files are .exr, or .png, .jpeg and 8-bit .tiff for displays, which have no linear
errors. Seconds are CPU time; "~" marks estimates.

Files, in one folder:
  OUT.automatic.exr .png, OUT.human..., OUT.denoised..., OUT.reference...   the images that
                       were rendered
  OUT.thresholds.csv   samples per pixel at which the rule stopped each block
  OUT.compare.json     all figures

Examples:
  lull compare scene.pbrt --snapshots --human human.csv:room-view0 -o room --report room.html
  lull compare scene.pbrt --snapshots --denoise -o room
  lull compare scene.pbrt --snapshots --curves --max-spp 2000 -o room --report room.html
  lull compare scene.pbrt --snapshots --stop lnoise:0.5 --max-spp 2000 --verify 0,1 -o room
  lull compare --images images/kitchen --human human.csv -o kitchen --report kitchen.html
  lull compare --automatic a.exr --human h.exr --reference r.exr -o room
  lull compare --automatic a.png --reference photo.jpg -o room

Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

}  // namespace

void AddCompareOptions(CLI::App& app, CompareOptions* o) {
    AddRenderSettings(app, &o->render);
    CLI::Option* scene = app.get_option("SCENE")->required(false);
    auto* images =
        AddOption(app, kOptions, "--images", &o->images,
                  "Images of another renderer, their spp in the file names, to make the\n"
                  "images of; NAME names the viewpoint [the folder's name]",
                  "DIR[:NAME]")
            ->excludes(scene);
    auto* stop = AddOption(app, kCommonOptions, "--stop", &o->rule,
                           "The automatic rule; see lull render --help", "RULE")
                     ->capture_default_str();
    AddCautionOptions(app, "Stopping", &o->render.caution);
    AddOption(app, kOptions, "--human", &o->human,
              "Compare human thresholds, or an image rendered with them",
              "H.csv[:NAME]|H.exr|H.png");
    AddOption(app, kOptions, "--automatic", &o->automatic,
              "Read the image of an automatic rule, instead of rendering", "A.exr|A.png")
        ->excludes(scene)
        ->excludes(images)
        ->excludes(stop);
    auto* reference = AddOption(app, kOptions, "--reference", &o->reference,
                                "Image to compare with", "R.exr|R.png")
                          ->excludes(images);
    AddOption(app, kOptions, "--snapshots", &o->snapshots,
              "Take all images from one render to the cap")
        ->needs(scene)
        ->excludes(reference);
    AddOption(app, kCommonOptions, "--denoise", &o->denoise,
              "Add \"denoised\", the image of `lull render --denoise`")
        ->needs(scene);
    AddOption(app, kCommonOptions, "--curves", &o->curves,
              "Add curves of error against time: fixed sample counts, stopping rules")
        ->needs(scene);
    AddViewingOption(app, &o->display);
    AddOption(app, kOptions, "--verify", &o->verify,
              "Measure cost and savings of the rule on N threads; 0: all", "N,N,...",
              Between(0, 4096))
        ->delimiter(',')
        ->needs(scene);
    AddOption(app, kCommonOptions, "-o,--output", &o->output,
              "Write files whose names begin with OUT, or to DIR/", "OUT|DIR/");
    AddOption(app, kCommonOptions, "--report", &o->report, "Write a page with images and tables",
              "R.html")
        ->check([](const std::string& file) {
            return file.ends_with(".html") ? "" : file + " does not end in .html";
        });
    AddCheckpointOptions(app, &o->render.checkpoint);
    app.footer(kFooter);
}

// `lull compare --images`: the images of a rule and of people, made of another renderer's pictures.

namespace {

std::vector<PictureRule> RulesOf(const CompareOptions& options, const PictureFolder& folder) {
    const ScheduleOptions& schedule = options.render.schedule;
    RuleContext context{.passSpp = PassOfPictures(folder.Spp()),
                        .blockCount = int(MakeBlocks(folder.Region(), schedule).size()),
                        .cap = folder.files.rbegin()->first,
                        .sceneName = folder.name,
                        .models = ModelFolder(),
                        .hasHalves = false};
    const auto read = [&](const char* option, const std::string& text) {
        try {
            return ParseRule(text, context);
        } catch (const std::logic_error& error) {
            throw UsageError("{}: {}", option, error.what());
        }
    };
    std::vector<PictureRule> rules;
    if (!options.human.empty())
        rules.push_back({"human", read("--human", "thresholds:" + options.human)});
    context.caution = options.render.caution;
    rules.insert(rules.begin(), {"automatic", read("--stop", options.rule)});
    return rules;
}

std::vector<NamedFile> OutputsOf(const CompareOptions& options,
                                 const std::vector<PictureRule>& rules) {
    std::vector<NamedFile> outputs = {{"-o", options.output + ".compare.json"},
                                      {"-o", options.output + ".thresholds.csv"},
                                      {"--report", options.report}};
    for (const PictureRule& rule : rules)
        outputs.push_back({"-o", fmt::format("{}.{}.png", options.output, rule.name)});
    outputs.push_back({"-o", options.output + ".reference.png"});
    return outputs;
}

ResultFiles WritePictures(const CompareOptions& options, const PictureFolder& folder,
                          const Comparison& comparison) {
    ResultFiles results;
    for (const ComparedImage& image : comparison.images) {
        std::vector<Rgb> pixels;
        for (size_t i = 0; i < image.image.values.size(); i += 3)
            pixels.emplace_back(image.image.values[i], image.image.values[i + 1],
                                image.image.values[i + 2]);
        results.Write(fmt::format("{}.{}.png", options.output, image.name),
                      [&](const std::string& file) {
                          WritePng(file, pixels, image.image.width, image.image.height);
                      });
    }
    std::vector<int> stops;
    for (const BlockCost& cost : comparison.images.front().costs) stops.push_back(cost.spp);
    results.Write(options.output + ".thresholds.csv", [&](const std::string& file) {
        WriteThresholds(file, {{.name = folder.name, .spp = stops}});
    });
    return results;
}

}  // namespace

ExitCode CompareFolder(CompareOptions options) {
    const PictureFolder folder = FindNamedPictures(options.images);
    options.output = BeginningOfNames(options.output, folder.name);
    std::vector<PictureRule> rules = RulesOf(options, folder);
    std::vector<NamedFile> inputs = InputsOf(folder);
    AddFileOfRule("thresholds:" + options.human, &inputs);
    AddFileOfRule(options.rule, &inputs);
    CheckOutputs(OutputsOf(options, rules), inputs);
    const std::optional<FileLock> lock = LockOutput(options.output + ".compare.json");

    ComparisonReport report;
    report.title = folder.name;
    RunWithThreads(options.render.scene.compile.threads, [&] {
        PictureComparison compared =
            ComparePictures(folder, options.render.schedule, std::move(rules));
        report.comparison = std::move(compared.comparison);
        for (const std::string& rule : compared.blind)
            report.notes.push_back(
                fmt::format("{} has checked no picture: it compares pictures, and these are too "
                            "far apart; its blocks are taken from the last one.",
                            rule));
        report.comparison.display = options.display;
        Measure(&report.comparison);
    });
    for (const std::string& note : report.notes) MessagesOf(options.render).Warn(note);
    ResultFiles results = WritePictures(options, folder, report.comparison);
    WriteComparison(options, std::move(report), std::move(results));
    return kDone;
}

}  // namespace lull::compare
