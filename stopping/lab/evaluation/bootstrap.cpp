#include "stopping/lab/evaluation/bootstrap.h"

#include <algorithm>
#include <random>
#include <stdexcept>

namespace lull {

namespace {

constexpr int kDraws = 2000;
constexpr unsigned kSeed = 1;

// Returns a number below `count`; the same everywhere, unlike std::uniform_int_distribution.
size_t Draw(std::mt19937& generator, size_t count) {
    return size_t(uint64_t(generator()) * count >> 32);
}

}  // namespace

Interval BootstrapInterval(std::span<const std::vector<double>> values) {
    if (values.empty() || std::ranges::any_of(values, &std::vector<double>::empty))
        throw std::invalid_argument("bootstrap: viewpoints with blocks are needed");
    std::mt19937 generator(kSeed);
    std::vector<double> means;
    for (int draw = 0; draw < kDraws; ++draw) {
        double mean = 0;
        for (size_t v = 0; v < values.size(); ++v) {
            const std::vector<double>& blocks = values[Draw(generator, values.size())];
            double sum = 0;
            for (size_t i = 0; i < blocks.size(); ++i)
                sum += blocks[Draw(generator, blocks.size())];
            mean += sum / double(blocks.size()) / double(values.size());
        }
        means.push_back(mean);
    }
    std::ranges::sort(means);
    return {means[kDraws / 40], means[kDraws - 1 - kDraws / 40]};
}

}  // namespace lull
