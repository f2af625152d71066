#include "renderer/lab/viewpoints/study_render.h"

namespace lull {

Study BeginStudy(const std::string& viewpoint, const PixelRect& region, std::vector<int> levels,
                 const std::vector<Block>& blocks, const RenderIdentity& identity) {
    Study study{.viewpoint = viewpoint,
                .width = region.Width(),
                .height = region.Height(),
                .levels = std::move(levels),
                .blocks = {},
                .provenance = identity};
    for (const Block& block : blocks)
        study.blocks.push_back(
            {{block.pixels.min - region.min, block.pixels.max - region.min}, {}});
    return study;
}

RenderResult RenderStudy(const RenderContext& context, RenderOptions options, Study* study,
                         ViewpointRecording* viewpoint) {
    const ScheduleOptions& schedule = options.schedule;
    std::vector<BlockRecording> recordings(study->blocks.size());
    options.makeCriterion = [&](const BlockInfo& info) {
        const size_t i = size_t(info.index);
        std::unique_ptr<Criterion> recorder;
        if (viewpoint)
            recorder = std::make_unique<BlockRecorder>(schedule.passLength, schedule.cap,
                                                       schedule.cap, &recordings[i]);
        return std::make_unique<PictureLadder>(study->levels, std::move(recorder),
                                               &study->blocks[i].pictures);
    };
    RenderResult result = Render(context, options);
    if (result.cancelled || !viewpoint) return result;
    for (size_t i = 0; i < recordings.size(); ++i)
        AddBlock(i, std::move(recordings[i]), result.blocks[i], viewpoint);
    return result;
}

}  // namespace lull
