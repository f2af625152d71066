#include "renderer/guiding/light_choice_guide.h"

#include <cmath>

namespace lull {

namespace {

// The fraction of samples as without a guide. Its inverse bounds the weight of light found late.
constexpr float kKeptLights = 0.15f;
// The weight of the mean of all tables, in samples.
constexpr double kLightPrior = 1;

class LightChoiceLearner {
  public:
    LightChoiceLearner(const LightChoiceGuide& guide, const LightChoiceRecord& record,
                       const LightTable& lights)
        : record(record), lights(lights), made(guide), ratios(guide.lightCount) {}

    LightChoiceGuide Run() {
        FindRatios();
        for (size_t table = 0; table < Tables(); ++table)
            if (IsKnown(table)) Fill(table);
        return std::move(made);
    }

  private:
    size_t Tables() const { return made.grid.Count() * kSides; }
    const SquareSum& SumOf(size_t table, size_t light) const {
        return record.sums[table * made.lightCount + light];
    }
    bool IsKnown(size_t table) const {
        for (size_t i = 0; i < made.lightCount; ++i)
            if (SumOf(table, i).count > 0) return true;
        return false;
    }
    // Returns the choice without a guide.
    LightChoice ChoiceAt(size_t table) const {
        const Bounds3f box = made.grid.BoundsOf(table / kSides);
        const Vec3f middle = 0.5f * (box.lower + box.upper);
        return lights.Choice(middle, lights.PlaceOf(middle));
    }

    void FindRatios() {
        std::vector<double> counts(made.lightCount);
        for (size_t table = 0; table < Tables(); ++table) {
            if (!IsKnown(table)) continue;
            const LightChoice choice = ChoiceAt(table);
            for (size_t i = 0; i < made.lightCount; ++i) {
                const double expected = double(choice.Pmf(int(i)));
                if (!(expected > 0)) continue;
                ratios[i] += double(SumOf(table, i).Squares()) / Sqr(expected);
                counts[i] += double(SumOf(table, i).count);
            }
        }
        for (size_t i = 0; i < made.lightCount; ++i)
            if (counts[i] > 0) ratios[i] /= counts[i];
    }

    void Fill(size_t table) {
        const LightChoice choice = ChoiceAt(table);
        std::vector<double> weights(made.lightCount);
        double sum = 0;
        for (size_t i = 0; i < made.lightCount; ++i) {
            const double elsewhere = ratios[i] * Sqr(double(choice.Pmf(int(i))));
            const SquareSum& own = SumOf(table, i);
            weights[i] = std::sqrt((double(own.Squares()) + kLightPrior * elsewhere) /
                                   (double(own.count) + kLightPrior));
            sum += weights[i];
        }
        if (!(sum > 0)) return;
        float* to = &made.sums[table * made.lightCount];
        double running = 0;
        for (size_t i = 0; i < made.lightCount; ++i) {
            running += double(1 - kKeptLights) * weights[i] / sum +
                       double(kKeptLights * choice.Pmf(int(i)));
            to[i] = std::min(float(running), 1.f);
        }
        to[made.lightCount - 1] = 1;
    }

    const LightChoiceRecord& record;
    const LightTable& lights;
    LightChoiceGuide made;
    std::vector<double> ratios;  // by light: mean square of its contribution over its share
};

}  // namespace

LightChoiceGuide::LightChoiceGuide(const Bounds3f& bounds, int lights)
    : lightCount(size_t(lights)) {
    size_t tables = 0;
    for (int most = kMostVoxels; most >= 1; most /= 2) {
        grid = VoxelGrid(bounds, most);
        tables = grid.Count() * kSides;
        if (tables * lightCount * sizeof(SquareSum) <= kMostBytes) break;
    }
    sums.resize(tables * lightCount);
}

bool IsValid(const LightChoiceGuide& guide) {
    if (guide.sums.size() != guide.grid.Count() * kSides * guide.lightCount) return false;
    for (size_t first = 0; first < guide.sums.size(); first += guide.lightCount) {
        const auto table = std::span(guide.sums).subspan(first, guide.lightCount);
        float before = 0;
        for (const float sum : table) {
            if (!(sum >= before)) return false;
            before = sum;
        }
        if (before != 0 && before != 1) return false;
    }
    return true;
}

LightChoiceGuide Learn(const LightChoiceGuide& guide, const LightChoiceRecord& record,
                       const LightTable& lights) {
    return LightChoiceLearner(guide, record, lights).Run();
}

}  // namespace lull
