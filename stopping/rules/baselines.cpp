#include "stopping/rules/baselines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "stopping/rules/rule.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

constexpr int kCyclesSpacing = 20;  // spp between the tests of the rule `cycles`
constexpr int kLuxMinimumSpp = 32;
constexpr uint32_t kDammertzTag = 0x315a4d44;  // "DMZ1"
constexpr uint32_t kCyclesTag = 0x32435943;    // "CYC2"
constexpr uint32_t kLuxTileTag = 0x3158554c;   // "LUX1"

double Finite(float x) { return std::isfinite(x) ? x : 0; }

double Difference(const float* a, const float* b) {
    return std::abs(Finite(a[0]) - Finite(b[0])) + std::abs(Finite(a[1]) - Finite(b[1])) +
           std::abs(Finite(a[2]) - Finite(b[2]));
}

double Sum(const float* rgb) { return Finite(rgb[0]) + Finite(rgb[1]) + Finite(rgb[2]); }

float DisplayValue(float x) {
    return x > 0 ? std::pow(std::min(x, 1.f), 1 / 2.2f) : 0;  // 0 for NaN as well
}

// Remembers which pixels are active, and makes of the errors of all of them the largest of those.
class CyclesStatistic final : public Statistic {
  public:
    explicit CyclesStatistic(double threshold) : threshold(threshold) {}

    // Tests the active pixels. That none has failed means that all errors were below
    // 5 * threshold, so that the largest decides.
    std::optional<double> Add(int, Signals signals) override {
        const PixelErrors& pixels = std::get<PixelErrors>(signals);
        if (active.empty()) {
            width = pixels.width;
            active.assign(pixels.errors.size(), 1);
        }
        if (active.size() != pixels.errors.size() || width != pixels.width)
            throw std::invalid_argument("the block has another size than before");
        double largest = 0;
        for (size_t i = 0; i < active.size(); ++i) {
            if (!active[i]) continue;
            active[i] = !(pixels.errors[i] < threshold);
            largest = std::max(largest, pixels.errors[i]);
        }
        Dilate();
        return largest;
    }

    void Save(StateWriter* writer) const override {
        writer->Put(int32_t(width));
        writer->PutAll(std::span(active));
    }
    void Restore(StateReader* reader) override {
        width = reader->Get<int32_t>();
        active.resize(reader->Left());
        reader->GetAll(std::span(active));
    }

  private:
    // Activates the neighbours of active pixels: those in the row, then those in the column.
    void Dilate() {
        std::vector<uint8_t> rows(active.size());
        const size_t stride = size_t(width), height = active.size() / stride;
        for (size_t y = 0; y < height; ++y)
            for (size_t x = 0; x < stride; ++x) {
                const size_t i = y * stride + x;
                rows[i] = active[i] | (x > 0 && active[i - 1]) | (x + 1 < stride && active[i + 1]);
            }
        for (size_t y = 0; y < height; ++y)
            for (size_t i = y * stride; i < (y + 1) * stride; ++i)
                active[i] =
                    rows[i] | (y > 0 && rows[i - stride]) | (y + 1 < height && rows[i + stride]);
    }

    double threshold;
    int width = 0;                // of the block, once it is known
    std::vector<uint8_t> active;  // 0 or 1 for each pixel; empty before the first test
};

Checks CyclesChecks(double threshold) {
    const int64_t least = int64_t(CyclesMinimumSpp(threshold)) + 2;
    return {.first = int((least + kCyclesSpacing - 1) / kCyclesSpacing * kCyclesSpacing),
            .every = kCyclesSpacing};
}

}  // namespace

Rule FixedRule(int spp) {
    return CountingRule([spp](const BlockInfo&) { return spp; });
}

double DammertzError(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    double sum = 0;
    for (size_t i = 0; i < view.mean.size(); i += 3) {
        const double s = Sum(&view.mean[i]);
        if (s > 0) sum += Difference(&view.mean[i], &view.halfMean[i]) / std::sqrt(s);
    }
    return 3 * sum / double(view.mean.size());
}

Rule DammertzRule(double threshold, bool byArea) {
    return {.tag = kDammertzTag,
            .threshold = threshold,
            .measure = [byArea](const BlockView& view, const BlockInfo& block) {
                return DammertzError(view) * (byArea ? std::sqrt(block.areaFraction) : 1);
            }};
}

double CyclesPixelError(const float* mean, const float* halfMean) {
    const double s = std::max(0.0, Sum(mean));
    return Difference(mean, halfMean) / (0.0001 + (s < 1 ? std::sqrt(s) : s));
}

int CyclesMinimumSpp(double threshold) {
    const double spp = std::ceil(16 / std::pow(threshold, 0.3));
    return int(std::clamp(spp, 4.0, 1e9));
}

PixelErrors CyclesErrors(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    PixelErrors pixels{.width = view.width};
    for (size_t i = 0; i < view.mean.size(); i += 3)
        pixels.errors.push_back(CyclesPixelError(&view.mean[i], &view.halfMean[i]) / 5);
    return pixels;
}

Rule CyclesRule(double threshold) {
    return {.tag = kCyclesTag,
            .checks = CyclesChecks(threshold),
            .threshold = threshold,
            .measure = [](const BlockView& view, const BlockInfo&) { return CyclesErrors(view); },
            .makeStatistic = [threshold] { return std::make_unique<CyclesStatistic>(threshold); }};
}

double LuxTileError(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    float largest = 0;
    for (size_t i = 0; i < view.mean.size(); ++i)
        largest = std::max(largest,
                           std::abs(DisplayValue(view.mean[i]) - DisplayValue(view.halfMean[i])));
    return largest;
}

Rule LuxTileRule(double threshold) {
    return {.tag = kLuxTileTag,
            .checks = {.first = kLuxMinimumSpp},
            .threshold = threshold,
            .measure = [](const BlockView& view, const BlockInfo&) { return LuxTileError(view); }};
}

Rule ReadFixed(const std::string& argument, const RuleContext&) {
    return FixedRule(ParsePositive<int>(argument, "a number of samples per pixel, at least 1"));
}

Rule ReadDammertz(const std::string& argument, const RuleContext&) {
    const std::string suffix = ":area";
    const bool byArea = argument.ends_with(suffix);
    return DammertzRule(
        ParseThreshold(byArea ? argument.substr(0, argument.size() - suffix.size()) : argument),
        byArea);
}

Rule ReadCycles(const std::string& argument, const RuleContext&) {
    return CyclesRule(ParseThreshold(argument));
}

Rule ReadLuxTile(const std::string& argument, const RuleContext&) {
    return LuxTileRule(ParseThreshold(argument));
}

namespace {

constexpr uint32_t kLightnessNoiseTag = 0x324e534c;  // "LSN2"
constexpr int kSubBlocks = 100;

}  // namespace

double PooledRms(std::span<const float> subBlocks) {
    double sum = 0;
    for (float rms : subBlocks) sum += double(rms) * rms;
    return std::sqrt(sum / double(subBlocks.size()));
}

double VisibleNoise(const BlockView& view) {
    const LightnessNoise noise = ComputeLightnessNoise(view);
    return PooledRms(SubBlockStatistics(noise, view.width, view.height, kSubBlocks).maskedNoise);
}

Rule LightnessNoiseRule(double threshold) {
    return {.tag = kLightnessNoiseTag,
            .threshold = threshold,
            .votes = 3,
            .measure = [](const BlockView& view, const BlockInfo&) { return VisibleNoise(view); }};
}

Rule ReadLightnessNoise(const std::string& argument, const RuleContext& context) {
    Rule rule = LightnessNoiseRule(ParseThreshold(argument) / context.caution);
    rule.peak.most = kPeakOverThreshold * rule.threshold;
    return rule;
}

namespace {

constexpr uint32_t kTag = 0x34534e44;  // "DNS4"
constexpr int kVotes = 1;
constexpr int kFirstSpp = 20;
constexpr double kGrowth = 1.25;
// Fitted to the checks of eight scenes (tests/measurements/models.md#remaining-time).
constexpr double kPower = -0.75;
constexpr std::array kForecasts = {0.48, 1.72};

}  // namespace

Rule ReadDenoised(const std::string& argument, const RuleContext& context) {
    return {.trend = {.power = kPower, .exponents = kForecasts},
            .tag = kTag,
            .checks = {.first = kFirstSpp, .growth = kGrowth},
            .threshold = ParseThreshold(argument) / context.caution,
            .votes = kVotes,
            .need = ViewNeed::Measured,
            .measure = SuppliedMeasure(context, kDenoisedRuleName)};
}

}  // namespace lull
