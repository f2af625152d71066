#include "stopping/signals/entropy_drop.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

constexpr double kDepth = 4;        // states are kept down to this part of the spp
constexpr double kTolerance = 1.6;  // of half and a quarter of the spp

// Returns the square of the weighted sum of the roots of the entropies' differences between two
// states: few sub-blocks with much noise must not decide.
double Fall(const EntropyState& from, const EntropyState& to, std::span<const double> weights) {
    double sum = 0;
    for (size_t i = 0; i < to.values.size(); ++i)
        sum += weights[i] * std::sqrt(std::abs(double(from.values[i]) - double(to.values[i])));
    return sum * sum;
}

// Returns the derivative of lightness at a luminance, but for a constant.
double Slope(double luminance) { return std::pow(std::max(luminance, kLinearLuminance), -2 / 3.0); }

}  // namespace

NoiseVisibility VisibilityAt(int cap, NoiseVisibility visibility) {
    visibility.reference = std::max(visibility.reference, cap);
    return visibility;
}

double RateOfFall(const EntropyState& oldest, const EntropyState& before, const EntropyState& now,
                  std::span<const double> weights) {
    const double early = Fall(oldest, before, weights), late = Fall(before, now, weights);
    if (!(early > 0 && late > 0)) return 1;
    // With u, v the ratios of the spp, early / late = v^a (u^a - 1) / (v^a - 1), which grows with
    // a.
    const double u = double(before.spp) / oldest.spp, v = double(now.spp) / before.spp;
    auto ratio = [&](double a) {
        return std::pow(v, a) * (std::pow(u, a) - 1) / (std::pow(v, a) - 1);
    };
    double least = 1, most = 2;
    if (early <= late * ratio(least)) return least;
    if (early >= late * ratio(most)) return most;
    for (int i = 0; i < 30; ++i) {
        const double middle = (least + most) / 2;
        (late * ratio(middle) < early ? least : most) = middle;
    }
    return (least + most) / 2;
}

std::vector<double> EntropyDrop(const EntropyState& before, const EntropyState& now, double rate) {
    const double scale = 1 / (std::pow(double(now.spp) / before.spp, rate) - 1);
    std::vector<double> drop;
    for (size_t i = 0; i < now.values.size(); ++i)
        drop.push_back(
            std::sqrt(scale * std::abs(double(before.values[i]) - double(now.values[i]))));
    return drop;
}

SubBlockLightness MeasureLightness(const BlockView& view, int subBlocks) {
    CheckView(view, ViewNeed::Mean);
    const int side = int(std::lround(std::sqrt(std::max(0, subBlocks))));
    if (side < 1 || side * side != subBlocks || view.width < side || view.height < side)
        throw std::invalid_argument("a block cannot be cut into that many sub-blocks");
    const std::vector<float> lightness = DisplayedLightness(view.mean);
    SubBlockLightness result;
    const std::vector<int> xs = SplitEvenly(view.width, side), ys = SplitEvenly(view.height, side);
    for (size_t v = 0; v + 1 < ys.size(); ++v)
        for (size_t u = 0; u + 1 < xs.size(); ++u) {
            double sum = 0, squares = 0;
            for (int y = ys[v]; y < ys[v + 1]; ++y)
                for (int x = xs[u]; x < xs[u + 1]; ++x) {
                    const double l = lightness[size_t(y) * size_t(view.width) + size_t(x)];
                    sum += l;
                    squares += l * l;
                }
            const double count = (ys[v + 1] - ys[v]) * (xs[u + 1] - xs[u]), mean = sum / count;
            result.mean.push_back(float(mean));
            result.deviation.push_back(
                float(std::sqrt(std::max(0.0, squares / count - mean * mean))));
        }
    return result;
}

double FlareFactor(double lightness, double flare) {
    const double y = LuminanceOf(lightness);
    return Slope((y + flare) / (1 + flare)) / (1 + flare) / Slope(y);
}

double NearnessFactor(int spp, const NoiseVisibility& visibility) {
    const double left = 1 - double(spp) / visibility.reference;
    return left > 0 ? std::pow(left, visibility.nearness) : 0;
}

std::vector<double> VisibleDrop(std::span<const double> drop, const SubBlockLightness& lightness,
                                int spp, const NoiseVisibility& visibility) {
    const double near = NearnessFactor(spp, visibility);
    std::vector<double> visible;
    for (size_t i = 0; i < drop.size(); ++i) {
        const double l = lightness.mean[i];
        visible.push_back(drop[i] * l * FlareFactor(l, visibility.flare) /
                          (1 + lightness.deviation[i] / visibility.mask) * near);
    }
    return visible;
}

void AddEntropies(int spp, std::span<const double> entropies, History<float>* history) {
    history->Add({spp, {entropies.begin(), entropies.end()}});
    history->Thin(kDepth);
}

std::optional<std::vector<double>> LatestDrop(const History<float>& history,
                                              std::span<const double> weights) {
    if (history.States().empty()) return {};
    const EntropyState& now = history.States().back();
    if (weights.size() != now.values.size())
        throw std::invalid_argument("a weight for each sub-block is needed");
    const EntropyState* before = history.Nearest(now.spp / 2.0, kTolerance);
    if (!before) return {};
    const EntropyState* oldest = history.Nearest(before->spp / 2.0, kTolerance);
    const bool three = oldest && oldest->spp < before->spp;
    return EntropyDrop(*before, now, three ? RateOfFall(*oldest, *before, now, weights) : 1);
}

std::optional<std::vector<double>> LatestVisibleDrop(const History<float>& history,
                                                     const SubBlockLightness& lightness,
                                                     const NoiseVisibility& visibility) {
    std::vector<double> weights;
    for (const float l : lightness.mean) weights.push_back(l * FlareFactor(l, visibility.flare));
    const auto drop = LatestDrop(history, weights);
    if (!drop) return {};
    return VisibleDrop(*drop, lightness, history.States().back().spp, visibility);
}

}  // namespace lull
