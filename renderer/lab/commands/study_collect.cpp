// `lull study --collect`: computes human thresholds from observers' answers.
#include <fmt/format.h>

#include <map>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/commands/study_options.h"
#include "renderer/lab/pages/study_page.h"
#include "stopping/lab/observers/observers.h"

namespace lull::study {

namespace {

void Tell(const Collected& collected) {
    for (const RefusedAnswers& refused : collected.refused)
        PrintToStderr("lull: {}: {}; left out\n", refused.file, refused.reason);
    for (const CheckedObserver& observer : collected.observers)
        if (!observer.leftOut.empty())
            PrintToStderr("lull: {}: {} {}; left out\n", observer.answers.file,
                          observer.answers.observer, observer.leftOut);
        else if (!observer.doubts.empty())
            PrintToStderr("lull: {}: {} counts, but {}\n", observer.answers.file,
                          observer.answers.observer, observer.doubts);
}

// Prints how far the thresholds of a viewpoint can be relied on.
void SayCertainty(const CollectedViewpoint& viewpoint) {
    PrintToStderr("lull: {}: {} observer{}\n", viewpoint.name, viewpoint.observers,
                  viewpoint.observers == 1 ? "" : "s");
    if (const int fewest = FewestAnswers(viewpoint); fewest < kEnoughAnswers)
        PrintToStderr(
            "lull: {}: thresholds of blocks rest on as few as {} answer{}; they are rough with "
            "fewer than {}\n",
            viewpoint.name, fewest, fewest == 1 ? "" : "s", kEnoughAnswers);
}

// Returns the files of single answers with their contents; with more than one viewpoint each has
// its own.
std::map<std::string, std::string> SingleAnswers(const Collected& collected,
                                                 const std::string& base) {
    std::map<std::string, std::string> files;
    for (const CollectedViewpoint& viewpoint : collected.viewpoints) {
        const std::string name =
            collected.viewpoints.size() > 1 ? base + "." + viewpoint.name : base;
        const std::string text = SingleAnswersCsv(collected, viewpoint.name);
        if (!text.empty()) files.emplace(name + ".answers.csv", text);
    }
    return files;
}

std::string ThresholdsCsv(const Collected& collected) {
    std::ostringstream csv;
    WriteThresholds(csv, ThresholdsOf(collected));
    return csv.str();
}

}  // namespace

void CollectAnswers(const Options& settings) {
    const std::string base = settings.output.substr(0, settings.output.rfind('.'));
    const std::string details = base + ".details.csv", observers = base + ".observers.csv";
    std::vector<NamedFile> inputs = {{"--study", settings.studyPage}};
    for (const std::string& file : settings.collect) inputs.push_back({"--collect", file});
    CheckOutputs(std::vector<NamedFile>{{"-o", settings.output},
                                        {"-o", details},
                                        {"-o", observers},
                                        {"--report", settings.report}},
                 inputs);

    CollectOptions options;
    Json study;
    if (!settings.studyPage.empty()) {
        study = ReadStudyPage(settings.studyPage);
        options.study = study.at("id").get<std::string>();
    }
    const Collected collected = CollectFiles(settings.collect, options);
    Tell(collected);
    if (collected.viewpoints.empty())
        throw Error(fmt::format("--collect: none of {} files has answers that count",
                                settings.collect.size()));

    // Written in this order, and printed.
    std::vector<std::pair<std::string, std::string>> files = {
        {settings.output, ThresholdsCsv(collected)},
        {details, DetailsCsv(collected)},
        {observers, ObserversCsv(collected)}};
    for (auto& [file, text] : SingleAnswers(collected, base)) {
        CheckOutputs(std::vector<NamedFile>{{"-o", file}}, inputs);
        files.emplace_back(file, text);
    }
    if (!settings.report.empty())
        files.emplace_back(settings.report, MakeCollectedPage(collected, study));
    for (const auto& [file, text] : files) WriteFileAtomically(file, text);
    if (!settings.render.quiet)
        for (const CollectedViewpoint& viewpoint : collected.viewpoints) SayCertainty(viewpoint);
    for (const auto& [file, text] : files) fmt::print("{}\n", file);
}

}  // namespace lull::study
