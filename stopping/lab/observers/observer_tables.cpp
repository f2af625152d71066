#include "stopping/lab/observers/observer_tables.h"

#include <fmt/format.h>

#include <optional>

#include "stopping/base/csv.h"

namespace lull {

namespace {

std::string Field(const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : "";
}
std::string Field(const std::optional<int>& value) { return value ? std::to_string(*value) : ""; }

// Returns the data of the display and the observer, for columns from gamma to window.
std::string ViewingFields(const ObserverAnswers& a) {
    const std::string window = a.windowWidth && a.windowHeight
                                   ? fmt::format("{}x{}", *a.windowWidth, *a.windowHeight)
                                   : "";
    return fmt::format("{},{},{},{},{},{},{}", Field(a.gamma), a.tones, Field(a.distanceCm),
                       Field(a.pixelsPerDegree), Field(a.zoom), Field(a.shown), window);
}

}  // namespace

std::string DetailsCsv(const Collected& collected) {
    std::string csv = "viewpoint,block,observers,mean,lowest,highest,deviation,octaves,answers\n";
    for (const CollectedViewpoint& v : collected.viewpoints)
        for (size_t i = 0; i < v.blocks.size(); ++i) {
            const BlockConsensus& b = v.blocks[i];
            csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{},{},{}\n", CsvField(v.name), i,
                               v.observers, b.mean, b.lowest, b.highest, Field(b.deviation),
                               Field(b.octaves), b.answers);
        }
    return csv;
}

std::string ObserversCsv(const Collected& collected) {
    std::string csv =
        "file,viewpoint,observer,counts,reason,checks,failed,repeats,repeat_octaves,shift_octaves,"
        "seconds,gamma,tones,distance_cm,pixels_per_degree,zoom,display_pixels,window,doubts\n";
    for (const CheckedObserver& o : collected.observers)
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{:.0f},{},{}\n", CsvField(o.answers.file),
                           CsvField(o.answers.viewpoint), CsvField(o.answers.observer),
                           o.leftOut.empty() ? "yes" : "no", CsvField(o.leftOut), o.checks,
                           o.failed, o.repeats, Field(o.repeatOctaves), Field(o.shiftOctaves),
                           o.answers.seconds, ViewingFields(o.answers), CsvField(o.doubts));
    for (const RefusedAnswers& r : collected.refused)
        csv += fmt::format("{},,,no,{}{}\n", CsvField(r.file), CsvField(r.reason),
                           std::string(14, ','));
    return csv;
}

std::string SingleAnswersCsv(const Collected& collected, const std::string& viewpoint) {
    std::string rows;
    int track = 0;
    for (const CheckedObserver& o : collected.observers) {
        if (!o.leftOut.empty() || o.answers.viewpoint != viewpoint) continue;
        for (const BlockAnswer& answer : o.answers.answers) {
            track += !answer.single.empty();
            for (const NoiseAnswer& single : answer.single)
                rows += fmt::format("{},{},{},{},{}\n", answer.block, single.spp,
                                    single.seen ? 1 : 0, CsvField(o.answers.observer), track);
        }
    }
    return rows.empty() ? "" : "block,spp,noise_seen,observer,track\n" + rows;
}

}  // namespace lull
