// `lull judge --collect`: makes thresholds of what observers said.
#include <fmt/format.h>

#include <sstream>

#include "renderer/commands/judge_options.h"
#include "renderer/output/file_io.h"
#include "renderer/pages/collected_page.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

std::string Quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string Field(const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : "";
}

std::string DetailsCsv(const Collected& collected) {
    std::string csv =
        "viewpoint,block,observers,mean,low,high,lowest,highest,deviation,octaves,agreement\n";
    for (const CollectedViewpoint& v : collected.viewpoints) {
        for (size_t i = 0; i < v.blocks.size(); ++i) {
            const BlockConsensus& b = v.blocks[i];
            csv += fmt::format("{},{},{},{:.6g},{},{},{:.6g},{:.6g},{},{},\n", Quoted(v.name), i,
                               v.observers, b.mean, Field(b.low), Field(b.high), b.lowest,
                               b.highest, Field(b.deviation), Field(b.octaves));
        }
        csv +=
            fmt::format("{},all,{},,,,,,,,{}\n", Quoted(v.name), v.observers, Field(v.agreement));
    }
    return csv;
}

std::string ObserversCsv(const Collected& collected) {
    std::string csv =
        "file,viewpoint,observer,counts,reason,procedure,checks,failed,repeats,repeat_octaves,"
        "shift_octaves,seconds,gamma,distance_cm\n";
    for (const JudgedObserver& o : collected.observers)
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{:.0f},{},{}\n",
                           Quoted(o.answers.file), Quoted(o.answers.viewpoint),
                           Quoted(o.answers.observer), o.leftOut.empty() ? "yes" : "no",
                           Quoted(o.leftOut), o.answers.procedure, o.checks, o.failed, o.repeats,
                           Field(o.repeatOctaves), Field(o.shiftOctaves), o.answers.seconds,
                           Field(o.answers.gamma), Field(o.answers.distanceCm));
    for (const RefusedAnswers& r : collected.refused)
        csv += fmt::format("{},,,no,{},,,,,,,,,\n", Quoted(r.file), Quoted(r.reason));
    return csv;
}

void Tell(const Collected& collected) {
    for (const RefusedAnswers& refused : collected.refused)
        fmt::print(stderr, "lull: {}: {}; left out\n", refused.file, refused.reason);
    for (const JudgedObserver& observer : collected.observers)
        if (!observer.leftOut.empty())
            fmt::print(stderr, "lull: {}: {} {}; left out\n", observer.answers.file,
                       observer.answers.observer, observer.leftOut);
}

}  // namespace

void CollectAnswers(const JudgeSettings& settings) {
    const std::string base = settings.output.substr(0, settings.output.rfind('.'));
    const std::string details = base + ".details.csv", observers = base + ".observers.csv";
    for (const std::string& file : {settings.output, details, observers}) CheckWritable(file);
    if (!settings.report.empty()) CheckWritable(settings.report);

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
            fmt::print(stderr, "lull: {}: {} observer{}, agreement {}\n", v.name, v.observers,
                       v.observers == 1 ? "" : "s",
                       v.agreement ? fmt::format("{:.2f}", *v.agreement) : "not known");
    for (const std::string& file : {settings.output, details, observers}) fmt::print("{}\n", file);
    if (!settings.report.empty()) fmt::print("{}\n", settings.report);
}

}  // namespace lull
