// `lull judge --collect`: makes thresholds of what observers said.
#include <fmt/format.h>

#include <sstream>

#include "renderer/base/say.h"
#include "renderer/commands/judge_options.h"
#include "renderer/files/file_io.h"
#include "renderer/files/outputs.h"
#include "renderer/pages/collected_page.h"
#include "stopping/observers/observer_tables.h"

namespace lull {

namespace {

void Tell(const Collected& collected) {
    for (const RefusedAnswers& refused : collected.refused)
        Say("lull: {}: {}; left out\n", refused.file, refused.reason);
    for (const JudgedObserver& observer : collected.observers)
        if (!observer.leftOut.empty())
            Say("lull: {}: {} {}; left out\n", observer.answers.file, observer.answers.observer,
                observer.leftOut);
}

}  // namespace

void CollectAnswers(const JudgeSettings& settings) {
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

    std::ostringstream thresholds;
    WriteThresholds(thresholds, ThresholdsOf(collected));
    WriteFileAtomically(settings.output, thresholds.str());
    WriteFileAtomically(details, DetailsCsv(collected));
    WriteFileAtomically(observers, ObserversCsv(collected));
    if (!settings.report.empty())
        WriteFileAtomically(settings.report, MakeCollectedPage(collected, study));
    if (!settings.render.quiet)
        for (const CollectedViewpoint& v : collected.viewpoints)
            Say("lull: {}: {} observer{}, agreement {}\n", v.name, v.observers,
                v.observers == 1 ? "" : "s",
                v.agreement ? fmt::format("{:.2f}", *v.agreement) : "not known");
    for (const std::string& file : {settings.output, details, observers}) fmt::print("{}\n", file);
    if (!settings.report.empty()) fmt::print("{}\n", settings.report);
}

}  // namespace lull
