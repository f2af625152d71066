#include "stopping/rules/baselines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/rules/argument.h"

namespace lull {

namespace {

constexpr int cyclesSpacing = 20;  // spp between the tests of the rule `cycles`
constexpr int luxMinimumSpp = 32;
constexpr uint32_t cyclesTag = 0x31435943;  // "CYC1"

double Finite(float x) { return std::isfinite(x) ? x : 0; }

double Difference(const float* a, const float* b) {
    return std::abs(Finite(a[0]) - Finite(b[0])) + std::abs(Finite(a[1]) - Finite(b[1])) +
           std::abs(Finite(a[2]) - Finite(b[2]));
}

double Sum(const float* rgb) { return Finite(rgb[0]) + Finite(rgb[1]) + Finite(rgb[2]); }

float DisplayValue(float x) {
    return x > 0 ? std::pow(std::min(x, 1.f), 1 / 2.2f) : 0;  // 0 for NaN as well
}

class FixedCriterion final : public Criterion {
  public:
    explicit FixedCriterion(int spp) : target(spp) {}

    ViewNeed Need(int) const override { return ViewNeed::Nothing; }
    Decision Observe(const BlockView& view) override {
        CheckView(view, ViewNeed::Nothing);
        return {.stop = view.spp >= target,
                .judged = true,
                .value = double(view.spp),
                .threshold = double(target)};
    }

  private:
    int target;
};

// Remembers which pixels are active, and makes of the errors of all of them the largest of those.
class CyclesGauge final : public Gauge {
  public:
    explicit CyclesGauge(double threshold)
        : threshold(threshold), minimumSpp(CyclesMinimumSpp(threshold)) {}

    // Cycles tests after the sample of 0-based index k > minimum, hence the 1.
    bool Looks(int spp) const override { return spp - 1 > minimumSpp && spp % cyclesSpacing == 0; }

    // Tests the active pixels. That none has failed means that all errors were below
    // 5 * threshold, so that the largest decides.
    bool Add(int, Signals signals) override {
        const PixelErrors& pixels = std::get<PixelErrors>(signals);
        if (active.empty()) {
            width = pixels.width;
            active.assign(pixels.errors.size(), 1);
        }
        if (active.size() != pixels.errors.size() || width != pixels.width)
            throw std::invalid_argument("the block has another size than before");
        value = 0;
        for (size_t i = 0; i < active.size(); ++i) {
            if (!active[i]) continue;
            active[i] = !(pixels.errors[i] < threshold);
            value = std::max(value, pixels.errors[i]);
        }
        Dilate();
        return true;
    }

    void Save(StateWriter* writer) const override {
        writer->Put(value);
        writer->Put(int32_t(width));
        writer->PutAll(std::span(active));
    }
    void Restore(StateReader* reader) override {
        value = reader->Get<double>();
        width = reader->Get<int32_t>();
        active.resize(reader->Left());
        reader->GetAll(std::span(active));
        if (std::isnan(value)) throw std::runtime_error("the saved state of cycles is damaged");
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
    int minimumSpp;
    int width = 0;                // of the block, once it is known
    std::vector<uint8_t> active;  // 0 or 1 for each pixel; empty before the first test
};

// Reads one number of the block.
std::function<Signals(int, const RecordedValues&)> RecordedNumber(const char* channel) {
    return [channel](int, const RecordedValues& values) -> Signals {
        return double(values(channel)[0]);
    };
}

}  // namespace

std::unique_ptr<Criterion> MakeFixed(int spp) { return std::make_unique<FixedCriterion>(spp); }

double DammertzError(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    double sum = 0;
    for (size_t i = 0; i < view.mean.size(); i += 3) {
        const double s = Sum(&view.mean[i]);
        if (s > 0) sum += Difference(&view.mean[i], &view.halfMean[i]) / std::sqrt(s);
    }
    return 3 * sum / double(view.mean.size());
}

VotingRule DammertzRule(double threshold, bool byArea) {
    return {.threshold = threshold,
            .measure = [](const BlockView& view, const BlockInfo&) { return DammertzError(view); },
            .recall = byArea ? nullptr : RecordedNumber("dammertz"),
            .makeGauge =
                [byArea](const BlockInfo& block) {
                    return MakeMeasuredGauge(byArea ? std::sqrt(block.areaFraction) : 1);
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

VotingRule CyclesRule(double threshold) {
    return {.threshold = threshold,
            .tag = cyclesTag,
            .measure = [](const BlockView& view, const BlockInfo&) { return CyclesErrors(view); },
            .makeGauge =
                [threshold](const BlockInfo&) { return std::make_unique<CyclesGauge>(threshold); }};
}

double LuxTileError(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    float largest = 0;
    for (size_t i = 0; i < view.mean.size(); ++i)
        largest = std::max(largest,
                           std::abs(DisplayValue(view.mean[i]) - DisplayValue(view.halfMean[i])));
    return largest;
}

VotingRule LuxTileRule(double threshold) {
    return {.threshold = threshold,
            .measure = [](const BlockView& view, const BlockInfo&) { return LuxTileError(view); },
            .recall = RecordedNumber("luxtile"),
            .makeGauge =
                [](const BlockInfo&) { return MakeMeasuredGauge(1, {.firstSpp = luxMinimumSpp}); }};
}

CriterionFactory CountingFactory(std::function<int(const BlockInfo&)> stopAt) {
    return {.make = [stopAt](const BlockInfo& block) { return MakeFixed(stopAt(block)); },
            .stopAt = stopAt};
}

CriterionFactory ReadFixed(const std::string& argument, const RuleContext&) {
    const int spp = ParsePositive<int>(argument, "a number of samples per pixel, at least 1");
    return CountingFactory([spp](const BlockInfo&) { return spp; });
}

CriterionFactory ReadDammertz(const std::string& argument, const RuleContext&) {
    const std::string suffix = ":area";
    const bool byArea = argument.ends_with(suffix);
    return FactoryOf(DammertzRule(
        ParseThreshold(byArea ? argument.substr(0, argument.size() - suffix.size()) : argument),
        byArea));
}

CriterionFactory ReadCycles(const std::string& argument, const RuleContext&) {
    return FactoryOf(CyclesRule(ParseThreshold(argument)));
}

CriterionFactory ReadLuxTile(const std::string& argument, const RuleContext&) {
    return FactoryOf(LuxTileRule(ParseThreshold(argument)));
}

}  // namespace lull
