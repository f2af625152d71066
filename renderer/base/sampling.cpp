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

BlockDistribution::BlockDistribution(int columns, int rows, const Weigh& weigh, float tolerance)
    : columns(columns), rows(rows) {
    const int across = (columns + kSide - 1) / kSide, down = (rows + kSide - 1) / kSide;
    const int stride = across * kSide;
    std::vector<float> strip(size_t(stride) * kSide);
    const auto weighStrip = [&](int block) {
        std::fill(strip.begin(), strip.end(), 0.f);
        for (int v = 0; v < std::min(kSide, rows - block * kSide); ++v)
            weigh(block * kSide + v, {&strip[size_t(v) * stride], size_t(columns)});
    };

    // Weigh the blocks. Where one is sampled evenly, the variance of weight / density grows by its
    // probability times the relative variance of its weights.
    const size_t count = size_t(across) * size_t(down);
    std::vector<float> means(count);
    std::vector<double> variances(count);
    double total = 0;
    for (int y = 0; y < down; ++y) {
        weighStrip(y);
        for (int x = 0; x < across; ++x) {
            double sum = 0, squares = 0;
            for (int v = 0; v < kSide; ++v)
                for (int u = 0; u < kSide; ++u) {
                    const double weight = strip[size_t(v) * stride + x * kSide + u];
                    sum += weight;
                    squares += Sqr(weight);
                }
            constexpr double kCells = kSide * kSide;
            const size_t i = size_t(y) * across + x;
            means[i] = float(sum / kCells);
            variances[i] = sum > 0 ? std::max(squares * kCells / sum - sum, 0.0) : 0;
            total += sum;
        }
    }
    blocks = Distribution2D(means, across, down);
    if (total > 0) scale = float(double(columns) * rows / Sqr(kSide));

    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return variances[a] < variances[b]; });
    tables.assign(count, 0);
    double left = tolerance * total;
    for (const int i : order) {
        const bool isPartial =
            (i % across + 1) * kSide > columns || (i / across + 1) * kSide > rows;
        if (isPartial) continue;
        left -= variances[i];
        if (left < 0) break;
        tables[i] = -1;
    }

    for (int y = 0; y < down; ++y) {
        const auto row = std::span(tables).subspan(size_t(y) * across, across);
        if (std::all_of(row.begin(), row.end(), [](int32_t table) { return table < 0; })) continue;
        weighStrip(y);
        for (int x = 0; x < across; ++x) {
            if (row[x] < 0) continue;
            row[x] = int32_t(cells.size());
            cells.push_back(MakeCells(&strip[size_t(x) * kSide], stride));
        }
    }
}

BlockDistribution::Sums BlockDistribution::SumsOf(const Sums& weights) {
    const Distribution1D distribution(weights);
    Sums sums;
    std::copy_n(distribution.Tables().cdf + 1, kSide, sums.begin());
    return sums;
}

BlockDistribution::Cells BlockDistribution::MakeCells(const float* weights, int stride) {
    Cells made;
    Sums means;
    for (int row = 0; row < kSide; ++row) {
        Sums in;
        std::copy_n(weights + size_t(row) * size_t(stride), kSide, in.begin());
        made.columns[row] = SumsOf(in);
        means[row] = float(std::accumulate(in.begin(), in.end(), 0.0) / kSide);
    }
    made.rows = SumsOf(means);
    return made;
}

}  // namespace lull
