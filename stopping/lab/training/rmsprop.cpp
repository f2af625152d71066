#include "stopping/lab/training/rmsprop.h"

#include <algorithm>
#include <vector>

#include "stopping/base/parallel.h"

namespace lull {

void RmsProp::Step(std::span<const NetworkWeights<float>> gradients,
                   NetworkWeights<float>* weights) {
    constexpr size_t kSliceSize = 1 << 16;
    using Array = Eigen::Map<Eigen::ArrayXf>;
    using ConstArray = Eigen::Map<const Eigen::ArrayXf>;

    struct Slice {
        size_t array, begin;
        Eigen::Index size;
    };
    const std::vector<std::span<float>> w = weights->Spans(), a = meanSquares.Spans();
    std::vector<std::vector<std::span<const float>>> g;
    for (const NetworkWeights<float>& gradient : gradients) g.push_back(gradient.Spans());
    std::vector<Slice> slices;
    for (size_t i = 0; i < w.size(); ++i)
        for (size_t begin = 0; begin < w[i].size(); begin += kSliceSize)
            slices.push_back({i, begin, Eigen::Index(std::min(kSliceSize, w[i].size() - begin))});

    ForEachIndex(int(slices.size()), [&](int index) {
        const auto [i, begin, size] = slices[size_t(index)];
        Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(size);
        for (const auto& spans : g) sum += ConstArray(spans[i].data() + begin, size);
        Array mean(a[i].data() + begin, size), weight(w[i].data() + begin, size);
        mean = rho * mean + (1 - rho) * sum.square();
        weight -= rate * sum / (mean.sqrt() + epsilon);
    });
}

}  // namespace lull
