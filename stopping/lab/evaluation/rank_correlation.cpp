#include "stopping/lab/evaluation/rank_correlation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace lull {

namespace {

// Returns twice the rank of each number less their mean, so that all are whole numbers.
std::vector<double> CentredRanks(std::span<const double> values) {
    std::vector<double> ranks;
    for (const double v : values) {
        if (std::isnan(v)) throw std::invalid_argument("rank correlation: not a number");
        double rank = 0;
        for (const double other : values) rank += (other < v) - (other > v);
        ranks.push_back(rank);
    }
    return ranks;
}

double Product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b) {
    if (a.size() != b.size())
        throw std::invalid_argument("rank correlation: the lengths of both sides differ");
    const std::vector<double> x = CentredRanks(a), y = CentredRanks(b);
    const double scale = std::sqrt(Product(x, x) * Product(y, y));
    if (a.size() < 3 || scale == 0) return std::nullopt;
    return Product(x, y) / scale;
}

}  // namespace lull
