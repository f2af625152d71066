#include "stopping/lab/observers/observer_tables.h"

#include <fmt/format.h>

#include <optional>

#include "stopping/base/csv.h"

namespace lull {

namespace {

std::string Field(const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : "";
}

}  // namespace

std::string DetailsCsv(const Collected& collected) {
    std::string csv =
        "viewpoint,block,observers,mean,low,high,lowest,highest,deviation,octaves,agreement,"
        "answers\n";
    for (const CollectedViewpoint& v : collected.viewpoints) {
        for (size_t i = 0; i < v.blocks.size(); ++i) {
            const BlockConsensus& b = v.blocks[i];
            csv += fmt::format("{},{},{},{:.6g},{},{},{:.6g},{:.6g},{},{},,{}\n", CsvField(v.name),
                               i, v.observers, b.mean, Field(b.low), Field(b.high), b.lowest,
                               b.highest, Field(b.deviation), Field(b.octaves), b.answers);
        }
        csv += fmt::format("{},all,{},,,,,,,,{},\n", CsvField(v.name), v.observers,
                           Field(v.agreement));
    }
    return csv;
}

std::string ObserversCsv(const Collected& collected) {
    std::string csv =
        "file,viewpoint,observer,counts,reason,procedure,checks,failed,repeats,repeat_octaves,"
        "shift_octaves,seconds,gamma,distance_cm,doubts\n";
    for (const CheckedObserver& o : collected.observers)
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{:.0f},{},{},{}\n",
                           CsvField(o.answers.file), CsvField(o.answers.viewpoint),
                           CsvField(o.answers.observer), o.leftOut.empty() ? "yes" : "no",
                           CsvField(o.leftOut), o.answers.procedure, o.checks, o.failed, o.repeats,
                           Field(o.repeatOctaves), Field(o.shiftOctaves), o.answers.seconds,
                           Field(o.answers.gamma), Field(o.answers.distanceCm), CsvField(o.doubts));
    for (const RefusedAnswers& r : collected.refused)
        csv += fmt::format("{},,,no,{},,,,,,,,,,\n", CsvField(r.file), CsvField(r.reason));
    return csv;
}

std::string SingleAnswersCsv(const Collected& collected, const std::string& viewpoint) {
    std::string rows;
    for (const CheckedObserver& o : collected.observers) {
        if (!o.leftOut.empty() || o.answers.viewpoint != viewpoint) continue;
        for (const BlockAnswer& answer : o.answers.answers)
            for (const NoiseAnswer& single : answer.single)
                rows += fmt::format("{},{},{}\n", answer.block, single.spp, single.seen ? 1 : 0);
    }
    return rows.empty() ? "" : "block,spp,noise_seen\n" + rows;
}

}  // namespace lull
