#include "renderer/learning/learning.h"

#include <fmt/format.h>

#include "renderer/learning/direction_learner.h"
#include "renderer/learning/light_learner.h"

namespace lull {

std::optional<std::string> WhyNotGuided(const Scene& scene, Estimator estimator) {
    if (estimator != Estimator::Combined) return "the estimator is pbrt-v3's";
    if (!CanBeGuided(scene.integrator)) return "the integrator takes no guide";
    if (MaxDepth(scene.integrator) < 2) return "paths have one bounce at most";
    if (scene.lights.Count() == 0) return "the scene has no light";
    return {};
}

bool LearnsDirectLight(const Scene& scene, Estimator estimator) {
    return estimator == Estimator::Combined && MaxDepth(scene.integrator) > 0 &&
           !IsBidirectional(scene.integrator) && (LearnsEnvironment(scene) || LearnsLights(scene));
}

LearningOptions LearningFor(const Scene& scene, const GuideOptions& guide, Estimator estimator,
                            bool hasClock) {
    return {.mode = WhyNotGuided(scene, estimator) ? GuideMode::Off : guide.mode,
            .megabytes = guide.megabytes,
            .isShort = hasClock,
            .directLight =
                guide.mode == GuideMode::Auto && !hasClock && LearnsDirectLight(scene, estimator)};
}

std::string TextOf(const GuideFigures& f, GuideMode mode) {
    std::string text = fmt::format("guide: {}: {}", f.isUsed ? "used" : "not used", f.why);
    if (f.directLight)
        text += fmt::format("; learned direct light: {}, variance {:.2f} +- {:.2f} of that without",
                            f.usesDirectLight ? "used" : "not used", f.directLight->variance,
                            f.directLight->error);
    if (f.rounds == 0) return text;
    text += fmt::format("; learned from {} spp, from {} spp on, {:.1f} MB", f.samples, f.from,
                        double(f.bytes) / (1 << 20));
    if (mode == GuideMode::Auto && f.rounds >= DirectionLearner::kFirstDecision)
        text += fmt::format("; variance {:.2f} +- {:.2f}, vertices {:.2f} of those without",
                            f.comparison.variance, f.comparison.error, f.comparison.vertices);
    return text;
}

}  // namespace lull
