// Options of learning, and what is reported of it.
#pragma once

#include <optional>
#include <string>

#include "renderer/base/enum_names.h"
#include "renderer/learning/trial.h"
#include "renderer/transport/integrator.h"

namespace lull {

// Whether paths are guided: never; where that was seen to pay; always.
enum class GuideMode { Off, Auto, On };

template <>
struct EnumNames<GuideMode> {
    static constexpr std::pair<GuideMode, const char*> all[] = {
        {GuideMode::Off, "off"}, {GuideMode::Auto, "auto"}, {GuideMode::On, "on"}};
};

// Options of path guiding.
struct GuideOptions {
    GuideMode mode = GuideMode::Off;
    int megabytes = 64;  // that trees and sums may take, > 0
};

struct LearningOptions {
    GuideMode mode = GuideMode::On;
    int megabytes = 64;  // that trees and sums may take, > 0
    // Learning shall not take long: blocks of a render that has a clock do not wait for each other.
    bool isShort = false;
    bool directLight = false;  // learns sampling of lights, too; needs LearnsDirectLight()
};

// Results and decisions of learning, for reports.
struct GuideFigures {
    bool isUsed = false;
    std::string why;             // it is used, or not
    int rounds = 0;              // that were recorded
    int from = 0;                // samples per pixel, from which on paths were recorded
    int samples = 0;             // per pixel, that were recorded
    int64_t bytes = 0;           // of the guide
    int leaves = 0;              // of its tree over space
    double seconds = 0;          // elapsed, between rounds
    GuideComparison comparison;  // of auto
    // Learned sampling of lights, of auto, where it has decided: relative to that without.
    std::optional<GuideComparison> directLight;
    bool usesDirectLight = false;
};

// Returns whether paths of the scene can be guided; if not, why.
std::optional<std::string> WhyNotGuided(const Scene&, Estimator);

// Returns whether direct light of the scene can be learned: paths start at the camera alone, lights
// are not sampled as by pbrt-v3, and the scene has an environment map or several lights that are
// chosen by tables of places.
bool LearnsDirectLight(const Scene&, Estimator);

// Returns what a render learns of all that its options ask for.
LearningOptions LearningFor(const Scene&, const GuideOptions&, Estimator, bool hasClock);

// Returns a summary of learning, in one line.
std::string TextOf(const GuideFigures&, GuideMode);

}  // namespace lull
