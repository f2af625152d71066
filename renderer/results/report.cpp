#include "renderer/results/report.h"

#include <cmath>
#include <sstream>

#include "renderer/files/file_io.h"
#include "renderer/film/spp_map.h"
#include "renderer/image/image_io.h"
#include "renderer/render/shortfall.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

const char* EndOf(const Block& block, bool timeUp) {
    if (!block.stopped) return timeUp ? "time" : "interrupted";
    return block.stoppedByVote ? "clean" : "cap";
}

Json BlockJson(const BlockResult& result, int cap, bool timeUp) {
    const Block& block = result.block;
    Json json = RectJson(block.pixels);
    json["spp"] = block.spp;
    json["threshold"] = block.stoppedByVote || (timeUp && !block.stopped) ? block.spp : cap;
    json["end"] = EndOf(block, timeUp);
    if (std::isfinite(block.noise)) json["maskedNoise"] = block.noise;
    if (!block.votes) json["follows"] = block.leader < 0 ? Json(nullptr) : Json(block.leader);
    json["seconds"] = result.seconds;
    json["criterionSeconds"] = result.criterionSeconds;
    if (!result.decisions.empty()) json["decisions"] = DecisionsJson(result.decisions);
    return json;
}

void AddShortfall(const Provenance& provenance, const RenderResult& result, Json* report) {
    std::vector<NoisyBlock> noisy = FindShortfall(provenance, result);
    const auto unknown =
        std::erase_if(noisy, [](const NoisyBlock& block) { return !std::isfinite(block.noise); });
    (*report)["totals"]["timeUp"] = true;
    if (unknown == 0) (*report)["totals"]["neededSeconds"] = NeededSeconds(noisy, result);
    for (const NoisyBlock& block : noisy) {
        Json& json = (*report)["blocks"][size_t(block.block)];
        json["neededSpp"] = block.neededSpp;
        json["neededSeconds"] = block.neededSeconds;
    }
}

void AddCapped(const Provenance& provenance, const RenderResult& result, Json* report) {
    const std::vector<CappedBlock> capped = FindCapped(result);
    for (const CappedBlock& c : capped)
        if (c.neededSpp > 0) (*report)["blocks"][size_t(c.block)]["neededSpp"] = c.neededSpp;
    if (capped.empty()) return;
    if (const int cap = CapFor(capped, provenance.schedule.cap); cap > 0)
        (*report)["totals"]["neededCap"] = cap;
}

Json TotalsJson(const Provenance& provenance, const RenderResult& result, int64_t rejected) {
    const Savings savings = ComputeSavings(result, provenance.schedule.cap);
    return {{"blocks", result.blocks.size()},
            {"cleanBlocks", result.progress.stoppedBlocks - result.progress.blocksAtCap},
            {"blocksAtCap", result.progress.blocksAtCap},
            {"medianSpp", result.progress.medianSpp},
            {"seconds", result.progress.seconds},
            {"samples", savings.samples},
            {"samplesAtCap", savings.samplesAtCount},
            {"samplesSaved", savings.SampleShare()},
            {"threadSeconds", savings.seconds},
            {"threadSecondsAtCap", savings.secondsAtCount},
            {"secondsSaved", savings.SecondShare()},
            {"criterionSeconds", savings.criterionSeconds},
            {"rejectedSamples", rejected},
            {"interrupted", result.cancelled}};
}

}  // namespace

Savings ComputeSavings(const RenderResult& result, int spp) {
    Savings savings;
    savings.samples = result.progress.samples;
    for (const BlockResult& b : result.blocks) {
        savings.samplesAtCount += b.block.pixels.Area() * spp;
        savings.criterionSeconds += b.criterionSeconds;
        savings.seconds += b.seconds + b.criterionSeconds;
        if (b.block.spp > 0) savings.secondsAtCount += b.seconds / b.block.spp * spp;
    }
    return savings;
}

Json RectJson(const PixelRect& r) {
    return {{"x", r.min.x()}, {"y", r.min.y()}, {"width", r.Width()}, {"height", r.Height()}};
}

Json ProvenanceJson(const Provenance& p) {
    const auto valueJson = []<typename T>(const T& value) -> Json {
        if constexpr (std::is_same_v<T, Vec2i>)
            return {value.x(), value.y()};
        else if constexpr (std::is_same_v<T, PixelRect>)
            return RectJson(value);
        else
            return value;
    };
    Json json;
    for (const NamedProvenance& part : PartsOf(p))
        if (part.json) json[part.json] = std::visit(valueJson, part.value);
    return json;
}

Json DecisionsJson(const std::vector<BlockDecision>& decisions) {
    Json spp = Json::array(), value = Json::array(), votes = Json::array();
    for (const BlockDecision& record : decisions) {
        spp.push_back(record.spp);
        value.push_back(record.decision.value);
        votes.push_back(record.decision.votes);
    }
    return {{"threshold", decisions.empty() ? 0 : decisions.back().decision.threshold},
            {"spp", spp},
            {"value", value},
            {"votes", votes}};
}

Json ReportJson(const Provenance& provenance, const RenderResult& result, int64_t rejectedSamples,
                const std::map<std::string, int>& warnings, const DenoisedImage* denoised) {
    Json report;
    report["provenance"] = ProvenanceJson(provenance);
    report["totals"] = TotalsJson(provenance, result, rejectedSamples);
    report["blocks"] = Json::array();
    for (const BlockResult& block : result.blocks)
        report["blocks"].push_back(BlockJson(block, provenance.schedule.cap, result.timeUp));
    if (denoised)
        for (size_t i = 0; i < result.blocks.size(); ++i)
            if (const auto& error = denoised->blocks[i])
                report["blocks"][i]["visibleDifference"] = {{"estimate", error->estimate},
                                                            {"upper", error->upper},
                                                            {"worstPixels", error->worstPixels},
                                                            {"worst", error->worst}};
    if (result.timeUp) AddShortfall(provenance, result, &report);
    AddCapped(provenance, result, &report);
    report["warnings"] = warnings;
    return report;
}

std::string Dump(const Json& json) {
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void WriteSppMap(const std::string& file, const Provenance& provenance,
                 const RenderResult& result) {
    const ScheduleOptions& schedule = provenance.schedule;
    std::vector<SppBlock> blocks;
    const bool isNoisyAtCap = result.trend.kind != RuleTrend::Samples;
    for (const BlockResult& b : result.blocks)
        blocks.push_back({b.block.pixels, b.block.spp, isNoisyAtCap && b.block.IsAtCap()});
    const int lowest = std::min(schedule.passLength, schedule.cap);
    const SppMap map = DrawSppMap(provenance.crop, blocks, lowest, schedule.cap);
    WritePng(file, map.srgb, map.width, map.height);
}

void WriteThresholdsOf(const std::string& file, const std::string& scene, std::vector<int> spp) {
    std::ostringstream text;
    WriteThresholds(text, {{SceneName(scene), std::move(spp)}});
    WriteFileAtomically(file, text.str());
}

std::vector<int> ThresholdsOf(const Provenance& provenance, const RenderResult& result) {
    std::vector<int> spp;
    for (const BlockResult& b : result.blocks)
        spp.push_back(b.block.stoppedByVote || !b.block.stopped ? b.block.spp
                                                                : provenance.schedule.cap);
    return spp;
}

}  // namespace lull
