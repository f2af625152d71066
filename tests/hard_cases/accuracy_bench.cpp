// Measures the accuracy and the speed of each faster or shorter formula: every row has its time
// and, as `error`, the largest difference from a reference in long double. "kept" marks the ones
// that lull uses.
#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <random>

#include "renderer/film/film.h"
#include "renderer/scene/textures/imagemap.h"
#include "stopping/rules/learned.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/svd_entropy.h"
#include "tests/stopping/network/random_network.h"

namespace lull {
namespace {

// Sub-blocks as images have them: a gradient with noise that fades from one to the next.
template <typename Scalar>
using SubBlock = Eigen::Matrix<Scalar, 20, 20, Eigen::RowMajor>;

std::vector<SubBlock<double>> SubBlocks() {
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss;
    std::vector<SubBlock<double>> blocks(60);
    for (size_t i = 0; i < blocks.size(); ++i)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x)
                blocks[i](y, x) = 40 + x + 0.5 * y + std::pow(10, 1 - 0.1 * i) * gauss(generator);
    return blocks;
}

template <typename Scalar, typename Squares>
Scalar EntropyOf(const Squares& squares) {
    const Scalar sum = squares.sum();
    Scalar h = 0;
    for (const Scalar s : squares)
        if (s > 0) h -= s / sum * std::log(s / sum);
    return h / std::log(Scalar(20));
}

template <typename Scalar>
Scalar EntropyBySvd(const SubBlock<double>& block) {
    const Eigen::JacobiSVD<Eigen::MatrixX<Scalar>> svd(block.cast<Scalar>());
    return EntropyOf<Scalar>(svd.singularValues().array().square().eval());
}

template <typename Scalar>
Scalar EntropyByGram(const SubBlock<double>& block) {
    const SubBlock<Scalar> b = block.cast<Scalar>();
    const Eigen::Matrix<Scalar, 20, 20> gram = b * b.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Scalar, 20, 20>> solver(
        gram, Eigen::EigenvaluesOnly);
    return EntropyOf<Scalar>(solver.eigenvalues().array().max(Scalar(0)).eval());
}

template <typename Method>
void Entropy(benchmark::State& state, const Method& method) {
    static const std::vector<SubBlock<double>> blocks = SubBlocks();
    double error = 0;
    for (const auto& block : blocks)
        error = std::max(error, double(std::abs(method(block) - EntropyBySvd<long double>(block))));
    size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(method(blocks[i++ % blocks.size()]));
    state.counters["error"] = error;
}
BENCHMARK_CAPTURE(Entropy, svd_double, EntropyBySvd<double>);
BENCHMARK_CAPTURE(Entropy, gram_double_kept,
                  [](const SubBlock<double>& b) { return ComputeSvdEntropy(b).h; });
BENCHMARK_CAPTURE(Entropy, svd_float, EntropyBySvd<float>);
BENCHMARK_CAPTURE(Entropy, gram_float, EntropyByGram<float>);

// 8-bit sRGB of linear values; the error is in codes.
uint8_t EncodeByPow(float x) {
    if (!(x > 0)) return 0;
    const double v = std::min(1.f, x);
    return uint8_t(
        std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
}
void Display(benchmark::State& state, bool table) {
    std::vector<float> linear(30'000);
    std::mt19937 generator(1);
    for (float& v : linear) v = std::generate_canonical<float, 24>(generator);
    std::vector<uint8_t> codes(linear.size()), exact(linear.size());
    std::ranges::transform(linear, exact.begin(), EncodeByPow);
    const auto encode = [&] {
        if (table)
            EncodeSrgb8(linear, codes);
        else
            std::ranges::transform(linear, codes.begin(), EncodeByPow);
    };
    for (auto _ : state) {
        encode();
        benchmark::DoNotOptimize(codes.data());
    }
    int error = 0;
    for (size_t i = 0; i < codes.size(); ++i)
        error = std::max(error, std::abs(codes[i] - exact[i]));
    state.counters["error"] = error;
    state.SetItemsProcessed(state.iterations() * int64_t(linear.size()));
}
BENCHMARK_CAPTURE(Display, pow_double, false);
BENCHMARK_CAPTURE(Display, table_kept, true);

// The paper's network on a window; the error is that of P(noisy).
template <typename Scalar>
struct NetworkOf {
    struct Layer {
        Eigen::MatrixX<Scalar> kernel, recurrent;
        Eigen::VectorX<Scalar> bias;
    };
    std::vector<Layer> layers;
    Eigen::RowVectorX<Scalar> dense;
    Scalar denseBias;

    explicit NetworkOf(const Network& network)
        : dense(network.dense[0].kernel.cast<Scalar>()), denseBias(network.dense[0].bias[0]) {
        for (const LstmLayer& l : network.lstm)
            layers.push_back(
                {l.kernel.cast<Scalar>(), l.recurrent.cast<Scalar>(), l.bias.cast<Scalar>()});
    }

    Scalar operator()(const Eigen::MatrixXf& window) const {
        Eigen::MatrixX<Scalar> x = window.cast<Scalar>();
        for (const Layer& layer : layers) x = Run(layer, x);
        return 1 / (1 + std::exp(-(dense.dot(x.rightCols(1).col(0)) + denseBias)));
    }

  private:
    static Eigen::MatrixX<Scalar> Run(const Layer& layer, const Eigen::MatrixX<Scalar>& sequence) {
        const Eigen::Index u = layer.recurrent.cols();
        const auto hard = [](const auto& x) {
            return (Scalar(0.2) * x + Scalar(0.5)).max(Scalar(0)).min(Scalar(1)).eval();
        };
        const auto sigmoid = [](const auto& x) { return (1 + (-x).exp()).inverse().eval(); };
        Eigen::MatrixX<Scalar> gates = layer.kernel * sequence;
        gates.colwise() += layer.bias;
        Eigen::ArrayX<Scalar> cell = Eigen::ArrayX<Scalar>::Zero(u), h = cell;
        Eigen::MatrixX<Scalar> hidden(u, sequence.cols());
        for (Eigen::Index t = 0; t < sequence.cols(); ++t) {
            Eigen::VectorX<Scalar> z = gates.col(t);
            z.noalias() += layer.recurrent * h.matrix();
            cell = hard(z.segment(u, u).array()) * cell +
                   hard(z.head(u).array()) * sigmoid(z.segment(2 * u, u).array());
            h = hard(z.tail(u).array()) * sigmoid(cell);
            hidden.col(t) = h.matrix();
        }
        return hidden;
    }
};
void PaperNetwork(benchmark::State& state, bool inDouble) {
    double error = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Network network = RandomNetwork(100, {512, 128, 32}, 0.2f, seed);
        const Eigen::MatrixXf window = Eigen::MatrixXf::Random(100, 8).cwiseAbs();
        const double p =
            inDouble ? NetworkOf<double>(network)(window) : NoisyProbability(network, window);
        error = std::max(error, double(std::abs(p - NetworkOf<long double>(network)(window))));
    }
    const Network network = RandomNetwork(100, {512, 128, 32}, 0.2f, 1);
    const NetworkOf<double> wide(network);
    const Eigen::MatrixXf window = Eigen::MatrixXf::Random(100, 8).cwiseAbs();
    for (auto _ : state)
        benchmark::DoNotOptimize(inDouble ? wide(window) : NoisyProbability(network, window));
    state.counters["error"] = error;
}
BENCHMARK_CAPTURE(PaperNetwork, double, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(PaperNetwork, float_kept, false)->Unit(benchmark::kMicrosecond);

// Sums of 10,000 samples from 1e-6 to 1e6; the error is relative.
template <typename Scalar>
void Sum(benchmark::State& state) {
    std::mt19937 generator(1);
    std::vector<float> values(10'000);
    for (float& v : values)
        v = std::pow(10.f, 12 * std::generate_canonical<float, 24>(generator) - 6);
    long double exact = 0;
    for (const float v : values) exact += v;
    Scalar sum = 0;
    for (auto _ : state) {
        sum = 0;
        for (const float v : values) {
            sum += v;
            benchmark::DoNotOptimize(sum);  // in this order, as samples come
        }
    }
    state.counters["error"] = double(std::abs(sum - exact) / exact);
    state.SetItemsProcessed(state.iterations() * int64_t(values.size()));
}
BENCHMARK(Sum<float>);
BENCHMARK(Sum<double>)->Name("Sum<double>_kept");

// Bilinear look-ups at random places of a file of 2048 x 2048 texels, kept as it is or as something
// else; the error is relative to the same look-up of its values as float.
template <typename File, typename Stored>
void Lookup(benchmark::State& state) {
    constexpr int kSize = 2048;
    std::mt19937 generator(1);
    const auto uniform = [&] { return std::generate_canonical<float, 24>(generator); };
    std::vector<float> values(size_t(3) * kSize * kSize);
    std::vector<Stored> texels(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const float v = 0.01f + 0.99f * uniform();
        if constexpr (std::is_same_v<File, uint8_t>) {
            const auto code = uint8_t(std::lround(255 * v));
            values[i] = float(code) * (1 / 255.f);
            texels[i] = std::is_same_v<Stored, uint8_t> ? Stored(code) : Stored(values[i]);
        } else {
            values[i] = float(File(v));
            texels[i] = Stored(values[i]);
        }
    }
    const Image image{kSize, kSize, 3, texels}, exact{kSize, kSize, 3, values};
    std::vector<Vec2f> points(1 << 16);
    for (Vec2f& p : points) p = {uniform(), uniform()};
    double error = 0;
    for (const Vec2f& p : points) {
        const Rgb e = BilinearRgb(exact, p, Wrap::Repeat);
        error = std::max(error,
                         double(((BilinearRgb(image, p, Wrap::Repeat) - e) / e).abs().maxCoeff()));
    }
    size_t i = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(BilinearRgb(image, points[i++ % points.size()], Wrap::Repeat));
    state.counters["error"] = error;
    state.counters["bytes"] = double(image.Bytes());
}
BENCHMARK(Lookup<uint8_t, float>)->Name("Lookup/8-bit_file_as_float");
BENCHMARK(Lookup<uint8_t, uint8_t>)->Name("Lookup/8-bit_file_as_it_is_kept");
BENCHMARK(Lookup<Half, float>)->Name("Lookup/half_file_as_float");
BENCHMARK(Lookup<Half, Half>)->Name("Lookup/half_file_as_it_is_kept");
BENCHMARK(Lookup<float, Half>)->Name("Lookup/float_file_as_half");
BENCHMARK(Lookup<float, float>)->Name("Lookup/float_file_as_it_is_kept");

}  // namespace
}  // namespace lull
