// Says from what an image was made, for headers, reports and checkpoints.
#pragma once

#include <string>
#include <vector>

#include "renderer/render/guide_learning.h"
#include "renderer/render/schedule.h"
#include "renderer/transport/integrator.h"
#include "stopping/rules/trend.h"

namespace lull {

struct Provenance {
    std::string version;
    std::string scene;  // the file, as given
    uint64_t seed = 0;
    SamplerKind sampler = SamplerKind::Sobol;
    Estimator estimator = Estimator::Combined;
    std::string criterion, checksum;  // the stopping rule and that of its file, if any
    std::vector<double> logRatios;    // of the rule, see network/human_range.h; empty: not known
    RuleTrend trend = {};             // of the rule
    ScheduleOptions schedule;
    int maxDepth = 0;
    int threads = 0;  // 0: all
    bool substitute = false;
    TextureFiltering filtering = TextureFiltering::Bilinear;
    Vec2i resolution = {0, 0};
    PixelRect crop;
    std::string clock = {};  // that ends the render, in words; empty: none
    GuideMode guide = GuideMode::Off;
    int guideMegabytes = 0;
    GuideFigures guideFigures = {};  // of what was learned; not part of the identity
};

// Names a scene in thresholds files: the file without folder and extension, or the folder where
// the file is called scene.pbrt. Not empty, without what the format has no room for.
std::string SceneName(const std::string& file);

std::string NameOf(SamplerKind);
std::string NameOf(Estimator);
std::string NameOf(TextureFiltering);

}  // namespace lull
