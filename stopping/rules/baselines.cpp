#include "stopping/rules/baselines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/base/state.h"

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

// Stops when an error estimate that needs no memory falls below a threshold.
class ErrorCriterion final : public Criterion {
  public:
    ErrorCriterion(double (*error)(const BlockView&), double factor, double threshold,
                   int minimumSpp)
        : error(error), factor(factor), threshold(threshold), minimumSpp(minimumSpp) {}

    ViewNeed Need(int spp) const override {
        return spp >= minimumSpp ? ViewNeed::MeanAndHalf : ViewNeed::Nothing;
    }
    Decision Observe(const BlockView& view) override {
        const ViewNeed need = Need(view.spp);
        CheckView(view, need);
        if (need == ViewNeed::Nothing) return {.threshold = threshold};
        const double value = factor * error(view);
        return {.stop = value < threshold, .judged = true, .value = value, .threshold = threshold};
    }

  private:
    double (*error)(const BlockView&);
    double factor, threshold;
    int minimumSpp;
};

class CyclesCriterion final : public Criterion {
  public:
    explicit CyclesCriterion(double threshold)
        : threshold(threshold), minimumSpp(CyclesMinimumSpp(threshold)) {}

    // Cycles tests after the sample of 0-based index k > minimum, hence the 1.
    ViewNeed Need(int spp) const override {
        const bool tests = spp - 1 > minimumSpp && spp % cyclesSpacing == 0;
        return tests ? ViewNeed::MeanAndHalf : ViewNeed::Nothing;
    }

    Decision Observe(const BlockView& view) override {
        const ViewNeed need = Need(view.spp);
        CheckView(view, need);
        if (need == ViewNeed::Nothing) return {.value = largest, .threshold = threshold};

        const size_t pixels = size_t(view.width) * size_t(view.height);
        if (active.empty()) {
            width = view.width;
            active.assign(pixels, 1);
        }
        if (active.size() != pixels || width != view.width)
            throw std::invalid_argument("the block has another size than before");

        // Test the active pixels. That none has failed means that all errors were below
        // 5 * threshold, so that the largest decides.
        largest = 0;
        for (size_t i = 0; i < pixels; ++i) {
            if (!active[i]) continue;
            const double error = CyclesPixelError(&view.mean[3 * i], &view.halfMean[3 * i]) / 5;
            active[i] = !(error < threshold);
            largest = std::max(largest, error);
        }
        Dilate(view.width, view.height);
        return {
            .stop = largest < threshold, .judged = true, .value = largest, .threshold = threshold};
    }

    std::vector<std::byte> Save() const override {
        StateWriter writer;
        writer.Put(cyclesTag);
        writer.Put(largest);
        writer.Put(int32_t(width));
        writer.PutAll(std::span(active));
        return std::move(writer.bytes);
    }
    void Restore(std::span<const std::byte> state) override {
        StateReader reader(state);
        reader.Expect(cyclesTag);
        largest = reader.Get<double>();
        width = reader.Get<int32_t>();
        active.resize(reader.Left());
        reader.GetAll(std::span(active));
        if (std::isnan(largest)) throw std::runtime_error("the saved state of cycles is damaged");
    }

  private:
    // Activates the neighbours of active pixels: those in the row, then those in the column.
    void Dilate(int width, int height) {
        std::vector<uint8_t> rows(active.size());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const size_t i = size_t(y) * size_t(width) + size_t(x);
                rows[i] = active[i] | (x > 0 && active[i - 1]) | (x + 1 < width && active[i + 1]);
            }
        const size_t stride = size_t(width);
        for (int y = 0; y < height; ++y)
            for (size_t i = size_t(y) * stride; i < size_t(y + 1) * stride; ++i)
                active[i] =
                    rows[i] | (y > 0 && rows[i - stride]) | (y + 1 < height && rows[i + stride]);
    }

    double threshold;
    int minimumSpp;
    int width = 0;                // of the block, once it is known
    double largest = 0;           // of the last test
    std::vector<uint8_t> active;  // 0 or 1 for each pixel; empty before the first test
};

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

std::unique_ptr<Criterion> MakeDammertz(double threshold, double factor) {
    return std::make_unique<ErrorCriterion>(DammertzError, factor, threshold, 0);
}

double CyclesPixelError(const float* mean, const float* halfMean) {
    const double s = std::max(0.0, Sum(mean));
    return Difference(mean, halfMean) / (0.0001 + (s < 1 ? std::sqrt(s) : s));
}

int CyclesMinimumSpp(double threshold) {
    const double spp = std::ceil(16 / std::pow(threshold, 0.3));
    return int(std::clamp(spp, 4.0, 1e9));
}

std::unique_ptr<Criterion> MakeCycles(double threshold) {
    return std::make_unique<CyclesCriterion>(threshold);
}

double LuxTileError(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    float largest = 0;
    for (size_t i = 0; i < view.mean.size(); ++i)
        largest = std::max(largest,
                           std::abs(DisplayValue(view.mean[i]) - DisplayValue(view.halfMean[i])));
    return largest;
}

std::unique_ptr<Criterion> MakeLuxTile(double threshold) {
    return std::make_unique<ErrorCriterion>(LuxTileError, 1, threshold, luxMinimumSpp);
}

}  // namespace lull
