#include "renderer/results/block_files.h"

#include <sstream>

#include "renderer/files/file_io.h"
#include "renderer/film/spp_map.h"
#include "renderer/image/image_io.h"
#include "stopping/rules/thresholds.h"

namespace lull {

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
