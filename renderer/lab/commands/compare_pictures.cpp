// `lull compare --images`: the images of a rule and of people, made of another renderer's pictures.
#include <fmt/format.h>

#include "renderer/commands/render_settings.h"
#include "renderer/image/image_io.h"
#include "renderer/lab/commands/compare_options.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/viewpoints/picture_folder.h"
#include "renderer/results/report.h"
#include "stopping/base/parallel.h"
#include "stopping/rules/thresholds.h"

namespace lull::compare {

namespace {

// Returns the automatic rule, and that of people where there is one.
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
