#include "renderer/base/sampling.h"

#include <numeric>

namespace lull {

float RadicalInverse(int base, uint64_t index) {
    const double inverseBase = 1.0 / base;
    double digitWeight = inverseBase, result = 0;
    for (; index > 0; index /= base, digitWeight *= inverseBase)
        result += double(index % base) * digitWeight;
    return std::min(float(result), kOneMinusEpsilon);
}

Distribution1D::Distribution1D(std::span<const float> values) : cdf(values.size() + 1) {
    // Sum in double, so that long tables keep their small entries.
    const int n = int(values.size());
    double total = std::accumulate(values.begin(), values.end(), 0.0);
    const bool isUniform = !(total > 0) || !std::isfinite(total);
    if (isUniform)
        total = n;
    else
        integral = float(total / n);
    double running = 0;
    int last = n - 1;  // the last element that has a probability
    for (int i = 0; i < n; ++i) {
        cdf[i] = float(running / total);
        running += isUniform ? 1 : values[i];
        if (isUniform || values[i] > 0) last = i;
    }
    // Entries behind it must not be chosen for the rounding error of 1.
    for (int i = last + 1; i <= n; ++i) cdf[i] = 1;

    const int entries = DistributionTables::EntriesFor(n);
    int i = 0;
    for (int k = 0; k < entries; ++k) {
        // One place early, as k / entries and u * entries round differently.
        while (i < n - 1 && double(cdf[i + 1]) * entries <= k - 0.001) ++i;
        guide.push_back(i);
    }
}

Distribution2D::Distribution2D(std::span<const float> values, int columns, int rows)
    : columns(columns), entries(DistributionTables::EntriesFor(columns)) {
    cdfs.reserve(size_t(rows) * size_t(columns + 1));
    guides.reserve(size_t(rows) * size_t(entries));
    std::vector<float> rowIntegrals;
    for (int row = 0; row < rows; ++row) {
        const Distribution1D across(values.subspan(size_t(row) * columns, columns));
        const DistributionTables tables = across.Tables();
        cdfs.insert(cdfs.end(), tables.cdf, tables.cdf + columns + 1);
        guides.insert(guides.end(), tables.guide, tables.guide + entries);
        rowIntegrals.push_back(across.Integral());
    }
    marginal = Distribution1D(rowIntegrals);
}

}  // namespace lull
