#include "stopping/lab/training/network_weights.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "stopping/base/counter_random.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

constexpr uint64_t kInitialTag = 1;  // tells these random numbers from those of other purposes

void CheckSize(int64_t size, const char* what, int64_t most = 16384) {
    if (size < 1 || size > most)
        throw std::invalid_argument(std::to_string(size) + " " + what + " are not in [1, " +
                                    std::to_string(most) + "]");
}

Eigen::MatrixXf GlorotUniform(Eigen::Index outputs, Eigen::Index inputs, CounterRandom* random) {
    const double limit = std::sqrt(6.0 / double(inputs + outputs));
    return Eigen::MatrixXf::NullaryExpr(outputs, inputs,
                                        [&] { return float(limit * (2 * random->Uniform() - 1)); });
}

// Returns orthonormal columns, uniform over all there are: the Q of a Gaussian matrix, where signs
// make the diagonal of R positive.
Eigen::MatrixXf Orthonormal(Eigen::Index rows, Eigen::Index columns, CounterRandom* random) {
    const Eigen::MatrixXd gauss =
        Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random->Normal(); });
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(gauss);
    Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(rows, columns);
    for (Eigen::Index i = 0; i < columns; ++i)
        if (qr.matrixQR()(i, i) < 0) q.col(i) *= -1;
    return q.cast<float>();
}

}  // namespace

NetworkWeights<float> InitialWeights(const NetworkShape& shape, uint64_t seed) {
    constexpr int64_t kMostWeights = 1 << 28;
    CheckSize(shape.inputs, "inputs", 1000000);
    CheckSize(shape.steps, "steps");
    NetworkWeights<float> weights;
    if (shape.lstm.empty()) throw std::invalid_argument("an LSTM layer is needed");
    int64_t inputs = shape.inputs;
    for (uint64_t layer = 0; int units : shape.lstm) {
        CheckSize(units, "units");
        CheckSize(4 * int64_t(units) * (inputs + units), "weights of a layer", kMostWeights);
        CounterRandom random(seed, {kInitialTag, layer++});
        LstmWeights<float> l;
        l.kernel = GlorotUniform(4 * units, inputs, &random);
        l.recurrent = Orthonormal(4 * units, units, &random);
        l.bias.setZero(4 * units);
        l.bias.segment(units, units).setOnes();
        weights.lstm.push_back(std::move(l));
        inputs = units;
    }
    CounterRandom random(seed, {kInitialTag, uint64_t(1000)});
    weights.dense.push_back({GlorotUniform(1, inputs, &random), Eigen::VectorXf::Zero(1)});
    return weights;
}

Network MakeNetwork(const NetworkWeights<float>& weights) {
    Network network;
    for (const LstmWeights<float>& l : weights.lstm)
        network.lstm.push_back({"lstm_" + std::to_string(network.lstm.size() + 1), l.kernel,
                                l.recurrent, l.bias, Activation::Sigmoid, Activation::HardSigmoid});
    for (const DenseWeights<float>& l : weights.dense)
        network.dense.push_back({"dense_" + std::to_string(network.dense.size() + 1), l.kernel,
                                 l.bias, Activation::Sigmoid});
    return network;
}

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
