#include "stopping/rules/trend.h"

#include <cmath>

#include "stopping/network/model_file.h"
#include "stopping/rules/learned.h"

namespace lull {

RuleTrend TrendOfFalls(const NoiseVisibility& visibility) {
    // Noise vanishes at N with the root of 1/n - 1/N where that is how near the picture is to it.
    return {.reference = visibility.nearness == 0.5 ? visibility.reference : 0, .saturates = true};
}

RuleTrend TrendOf(const Model& model) {
    const double undecided = UndecidedNoise(model);
    // Otherwise its odds are followed, whatever it sees.
    RuleTrend trend = undecided > 0 ? TrendOfFalls(model.settings.visibility) : RuleTrend();
    trend.kind = RuleTrend::Probability;
    trend.votes = model.settings.votes;
    trend.undecided = undecided;
    return trend;
}

double UndecidedNoise(const Model& model) {
    const ModelSettings& settings = model.settings;
    if (!LooksAtNoiseOnly(settings)) return 0;
    // A step before the last had more noise; at fixed spacing, as much but for few spp.
    const double stepBefore =
        settings.spacing == Spacing::Geometric ? std::sqrt(settings.ratio) : 1.0;
    const auto isNoisy = [&](double noise) {
        Eigen::MatrixXf window(1, settings.k);
        for (int step = settings.k - 1; step >= 0; --step, noise *= stepBefore)
            window(0, step) = float(InputOfNoise(noise));
        return NoisyProbability(model.network, window) >= 0.5;
    };
    double clean = 1e-3, noisy = 1e3;
    if (isNoisy(clean) || !isNoisy(noisy)) return 0;
    while (noisy / clean > 1.0001) {
        const double middle = std::sqrt(clean * noisy);
        (isNoisy(middle) ? noisy : clean) = middle;
    }
    return noisy;
}

}  // namespace lull
