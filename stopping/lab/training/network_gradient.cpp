#include "stopping/lab/training/network_gradient.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

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

// Returns uniform orthonormal columns: the Q of a Gaussian matrix, the diagonal of R positive.
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

NetworkWeights<float> InitialWeights(int given, std::span<const int> lstm, uint64_t seed) {
    constexpr int64_t kMostWeights = 1 << 28;
    CheckSize(given, "inputs", 1000000);
    NetworkWeights<float> weights;
    if (lstm.empty()) throw std::invalid_argument("an LSTM layer is needed");
    int64_t inputs = given;
    for (uint64_t layer = 0; int units : lstm) {
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

namespace {

// Adds the product a * b to c. Large products are split by rows into as many parts as their size
// makes worthwhile, whatever the number of threads: a sum must not depend on it.
template <typename C, typename A, typename B>
void AddProduct(C&& c, const A& a, const B& b) {
    constexpr double kWorkOfPart = 1 << 23;  // multiplications: a fraction of a millisecond
    const double work = double(c.rows()) * double(c.cols()) * double(a.cols());
    const Eigen::Index most = std::max<Eigen::Index>(1, c.rows() / 128);
    const Eigen::Index parts = std::clamp<Eigen::Index>(Eigen::Index(work / kWorkOfPart), 1, most);
    ForEachIndex(int(parts), [&](int i) {
        const Eigen::Index begin = c.rows() * i / parts, end = c.rows() * (i + 1) / parts;
        c.middleRows(begin, end - begin).noalias() += a.middleRows(begin, end - begin) * b;
    });
}

template <typename Array>
auto Sigmoid(const Array& x) {
    using Scalar = typename Array::Scalar;
    return (Scalar(1) + (-x).exp()).inverse();
}

// Results of a layer for the backward pass; a column a sample and step.
template <typename Scalar>
struct LstmTrace {
    MatrixOf<Scalar> inputs;    // after dropout
    MatrixOf<Scalar> gates;     // i, f, c, o after their activations
    MatrixOf<Scalar> cells;     // C
    MatrixOf<Scalar> squashed;  // sigmoid(C)
    MatrixOf<Scalar> outputs;   // o * sigmoid(C)
};

template <typename Scalar>
LstmTrace<Scalar> RunForward(const LstmWeights<Scalar>& layer, MatrixOf<Scalar> inputs,
                             const MatrixOf<Scalar>* mask, int count, int steps) {
    const Eigen::Index u = layer.recurrent.cols();
    LstmTrace<Scalar> trace;
    trace.inputs = std::move(inputs);
    if (mask)
        for (int t = 0; t < steps; ++t)
            trace.inputs.middleCols(t * count, count).array() *= mask->array();
    trace.gates = layer.bias.replicate(1, trace.inputs.cols());
    AddProduct(trace.gates, layer.kernel, trace.inputs);
    trace.cells.resize(u, count * steps);
    trace.squashed.resize(u, count * steps);
    trace.outputs.resize(u, count * steps);
    for (int t = 0; t < steps; ++t) {
        auto now = [&](MatrixOf<Scalar>& m) { return m.middleCols(t * count, count); };
        auto before = [&](MatrixOf<Scalar>& m) { return m.middleCols((t - 1) * count, count); };
        auto z = now(trace.gates);
        if (t > 0) AddProduct(z, layer.recurrent, before(trace.outputs));
        auto i = z.middleRows(0, u).array(), f = z.middleRows(u, u).array(),
             c = z.middleRows(2 * u, u).array(), o = z.middleRows(3 * u, u).array();
        auto hardSigmoid = [](auto& x) {
            x = (Scalar(0.2) * x + Scalar(0.5)).cwiseMax(Scalar(0)).cwiseMin(Scalar(1));
        };
        hardSigmoid(i);
        hardSigmoid(f);
        c = Sigmoid(c);
        hardSigmoid(o);
        auto cell = now(trace.cells).array(), squashed = now(trace.squashed).array();
        cell = i * c;
        if (t > 0) cell += f * before(trace.cells).array();
        squashed = Sigmoid(cell);
        now(trace.outputs).array() = o * squashed;
    }
    return trace;
}

// Adds the gradient of a layer, given that of its outputs. Returns its inputs', but the network's.
template <typename Scalar>
MatrixOf<Scalar> RunBackward(const LstmWeights<Scalar>& layer, const LstmTrace<Scalar>& trace,
                             const MatrixOf<Scalar>& outputGradient, const MatrixOf<Scalar>* mask,
                             int count, int steps, bool isFirst, LstmWeights<Scalar>* gradient) {
    const Eigen::Index u = layer.recurrent.cols(), columns = trace.gates.cols();
    // Of the gates before their activations.
    MatrixOf<Scalar> gates(4 * u, columns);
    MatrixOf<Scalar> output(u, count), cell = MatrixOf<Scalar>::Zero(u, count);
    for (int t = steps - 1; t >= 0; --t) {
        auto now = [&](const MatrixOf<Scalar>& m) { return m.middleCols(t * count, count); };
        output = now(outputGradient);
        if (t + 1 < steps)
            AddProduct(output, layer.recurrent.transpose(),
                       gates.middleCols((t + 1) * count, count));
        const auto z = now(trace.gates);
        const auto i = z.middleRows(0, u).array(), f = z.middleRows(u, u).array(),
                   c = z.middleRows(2 * u, u).array(), o = z.middleRows(3 * u, u).array();
        const auto squashed = now(trace.squashed).array();
        auto dz = gates.middleCols(t * count, count);
        auto hardSigmoid = [](const auto& dx, const auto& x) {
            return (x > Scalar(0) && x < Scalar(1)).select(Scalar(0.2) * dx, Scalar(0));
        };
        cell.array() += output.array() * o * squashed * (Scalar(1) - squashed);
        dz.middleRows(0, u) = hardSigmoid(cell.array() * c, i);
        if (t > 0)
            dz.middleRows(u, u) = hardSigmoid(
                cell.array() * trace.cells.middleCols((t - 1) * count, count).array(), f);
        else
            dz.middleRows(u, u).setZero();
        dz.middleRows(2 * u, u) = cell.array() * i * c * (Scalar(1) - c);
        dz.middleRows(3 * u, u) = hardSigmoid(output.array() * squashed, o);
        cell.array() *= f;
    }
    AddProduct(gradient->kernel, gates, trace.inputs.transpose());
    if (steps > 1)
        AddProduct(gradient->recurrent, gates.rightCols(columns - count),
                   trace.outputs.leftCols(columns - count).transpose());
    gradient->bias += gates.rowwise().sum();

    MatrixOf<Scalar> inputs;
    if (isFirst) return inputs;
    inputs.setZero(trace.inputs.rows(), columns);
    AddProduct(inputs, layer.kernel.transpose(), gates);
    if (mask)
        for (int t = 0; t < steps; ++t)
            inputs.middleCols(t * count, count).array() *= mask->array();
    return inputs;
}

// Returns log(1 + exp(x)) without overflow.
double SoftPlus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

}  // namespace

template <typename Scalar>
BatchResult<Scalar> AddGradient(const NetworkWeights<Scalar>& weights,
                                const SampleBatch<Scalar>& batch,
                                NetworkWeights<Scalar>* gradient) {
    using Matrix = MatrixOf<Scalar>;
    const int count = batch.count, steps = batch.steps;
    auto mask = [&](size_t layer) { return batch.masks.empty() ? nullptr : &batch.masks[layer]; };

    std::vector<LstmTrace<Scalar>> traces;
    for (size_t l = 0; l < weights.lstm.size(); ++l)
        traces.push_back(RunForward(weights.lstm[l], l == 0 ? batch.inputs : traces[l - 1].outputs,
                                    mask(l), count, steps));
    // Inputs of the dense layers; at the end the answers.
    std::vector<Matrix> states = {Matrix(traces.back().outputs.rightCols(count))};
    VectorOf<Scalar> logits;
    for (const DenseWeights<Scalar>& l : weights.dense) {
        const Matrix z = (l.kernel * states.back()).colwise() + l.bias;
        logits = z.row(0);
        states.push_back(Sigmoid(z.array()).matrix());
    }

    BatchResult<Scalar> result;
    result.probabilities = states.back().row(0);
    for (int s = 0; s < count; ++s)
        result.loss += double(batch.weights[s]) *
                       (SoftPlus(double(logits[s])) - double(batch.targets[s] * logits[s]));
    if (!gradient) return result;

    // Of the input of the activation; of cross-entropy and sigmoid together it is this simple.
    Matrix dz =
        (batch.weights.array() * (result.probabilities - batch.targets).array()).transpose();
    Matrix dx;
    for (size_t l = weights.dense.size(); l-- > 0;) {
        gradient->dense[l].kernel.noalias() += dz * states[l].transpose();
        gradient->dense[l].bias += dz.rowwise().sum();
        dx.noalias() = weights.dense[l].kernel.transpose() * dz;
        if (l > 0) dz = dx.array() * states[l].array() * (Scalar(1) - states[l].array());
    }
    // Only the last step of the last layer is seen by the dense layers.
    Matrix outputs = Matrix::Zero(traces.back().outputs.rows(), count * steps);
    outputs.rightCols(count) = dx;
    for (size_t l = weights.lstm.size(); l-- > 0;)
        outputs = RunBackward(weights.lstm[l], traces[l], outputs, mask(l), count, steps, l == 0,
                              &gradient->lstm[l]);
    return result;
}

template BatchResult<float> AddGradient(const NetworkWeights<float>&, const SampleBatch<float>&,
                                        NetworkWeights<float>*);
template BatchResult<double> AddGradient(const NetworkWeights<double>&, const SampleBatch<double>&,
                                         NetworkWeights<double>*);

}  // namespace lull
