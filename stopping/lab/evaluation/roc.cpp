#include "stopping/lab/evaluation/roc.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace lull {

double AreaUnderRoc(std::span<const float> scores, std::span<const char> labels) {
    if (scores.size() != labels.size())
        throw std::invalid_argument("there must be one label for each score");
    if (std::any_of(scores.begin(), scores.end(), [](float s) { return std::isnan(s); }))
        throw std::invalid_argument("a score is NaN");
    std::vector<size_t> order(scores.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return scores[a] < scores[b]; });

    // Count the pairs with the right order, group by group of equal scores.
    double pairs = 0, zeros = 0, ones = 0;
    for (size_t i = 0; i < order.size();) {
        double zerosHere = 0, onesHere = 0;
        const float score = scores[order[i]];
        for (; i < order.size() && scores[order[i]] == score; ++i)
            ++(labels[order[i]] ? onesHere : zerosHere);
        pairs += onesHere * (zeros + zerosHere / 2);
        zeros += zerosHere;
        ones += onesHere;
    }
    return zeros > 0 && ones > 0 ? pairs / (zeros * ones) : 0.5;
}

}  // namespace lull
