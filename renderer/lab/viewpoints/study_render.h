// Makes the pictures of a study by rendering them.
#pragma once

#include "renderer/lab/viewpoints/recorded_viewpoint.h"
#include "renderer/lab/viewpoints/study.h"

namespace lull {

// Returns a study without its pictures. Blocks are placed within `region`, which becomes the whole
// image.
Study BeginStudy(const std::string& viewpoint, const PixelRect& region, std::vector<int> levels,
                 const std::vector<Block>& blocks, const RenderIdentity&);

// Renders all blocks to the cap, the study's last level, and fills in their pictures; records the
// same samples for learning in `viewpoint`, unless that is null. Starts from nothing or from where
// an interrupted render of the same study left film and state. The options have no rule. If it was
// cancelled, the study is not complete. Throws as Render() does.
RenderResult RenderStudy(const RenderContext&, RenderOptions, Study*,
                         ViewpointRecording* viewpoint);

}  // namespace lull
