#include "stopping/lab/training/network_gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "stopping/base/parallel.h"

namespace lull {
namespace {

template <typename Scalar>
NetworkWeights<Scalar> Cast(const NetworkWeights<float>& weights) {
    NetworkWeights<Scalar> cast;
    for (const LstmWeights<float>& l : weights.lstm)
        cast.lstm.push_back({l.kernel.template cast<Scalar>(), l.recurrent.template cast<Scalar>(),
                             l.bias.template cast<Scalar>()});
    for (const DenseWeights<float>& l : weights.dense)
        cast.dense.push_back({l.kernel.template cast<Scalar>(), l.bias.template cast<Scalar>()});
    return cast;
}

struct Shape {
    int inputs, steps;
    std::vector<int> lstm;
};

template <typename Scalar>
SampleBatch<Scalar> MakeBatch(const Shape& shape, int count, bool drops, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<Scalar> uniform(0, 1);
    auto random = [&] { return uniform(generator); };
    SampleBatch<Scalar> batch{.count = count,
                              .steps = shape.steps,
                              .inputs = {},
                              .masks = {},
                              .targets = {},
                              .weights = {}};
    batch.inputs = MatrixOf<Scalar>::NullaryExpr(shape.inputs, count * shape.steps, random);
    batch.targets =
        VectorOf<Scalar>::NullaryExpr(count, [&] { return Scalar(random() < Scalar(0.5)); });
    batch.weights = VectorOf<Scalar>::NullaryExpr(count, random);
    int inputs = shape.inputs;
    for (int units : shape.lstm) {
        if (drops)
            batch.masks.push_back(MatrixOf<Scalar>::NullaryExpr(inputs, count, [&] {
                return random() < Scalar(0.4) ? Scalar(0) : Scalar(1 / 0.6);
            }));
        inputs = units;
    }
    return batch;
}

void CheckGradient(const Shape& shape, bool drops) {
    NetworkWeights<double> weights = Cast<double>(InitialWeights(shape.inputs, shape.lstm, 7));
    // Larger weights saturate some of the gates, whose derivative is then zero.
    for (LstmWeights<double>& l : weights.lstm) l.kernel *= 4, l.recurrent *= 4;
    const SampleBatch<double> batch = MakeBatch<double>(shape, 5, drops, 3);
    NetworkWeights<double> gradient = ZerosLike(weights);
    const double loss = AddGradient(weights, batch, &gradient).loss;
    EXPECT_EQ(AddGradient<double>(weights, batch, nullptr).loss, loss);
    const auto spans = weights.Spans();
    const auto slopes = gradient.Spans();
    int nonZero = 0;
    for (size_t array = 0; array < spans.size(); ++array)
        for (size_t i = 0; i < spans[array].size(); ++i) {
            const double h = 1e-6, w = spans[array][i];
            double difference = 0;
            for (double sign : {-1.0, 1.0}) {
                spans[array][i] = w + sign * h;
                difference += sign * AddGradient<double>(weights, batch, nullptr).loss;
            }
            spans[array][i] = w;
            EXPECT_NEAR(slopes[array][i], difference / (2 * h), 1e-8) << array << ", " << i;
            nonZero += slopes[array][i] != 0;
        }
    EXPECT_GT(nonZero, 10);
}

TEST(NetworkGradient, AgreesWithFiniteDifferences) {
    CheckGradient({.inputs = 4, .steps = 5, .lstm = {6, 3, 2}}, false);
    CheckGradient({.inputs = 4, .steps = 5, .lstm = {6, 3, 2}}, true);
    CheckGradient({.inputs = 3, .steps = 1, .lstm = {4}}, true);
}

TEST(NetworkGradient, RunsTheNetworkAsRulesDo) {
    const NetworkWeights<float> weights = InitialWeights(9, std::vector{7, 5}, 5);
    const SampleBatch<float> batch =
        MakeBatch<float>({.inputs = 9, .steps = 4, .lstm = {7, 5}}, 6, false, 2);
    const BatchResult<float> result = AddGradient<float>(weights, batch, nullptr);
    const Network network = MakeNetwork(weights);
    CheckNetwork(network);
    double loss = 0;
    for (int s = 0; s < 6; ++s) {
        Eigen::MatrixXf sequence(9, 4);
        for (int t = 0; t < 4; ++t) sequence.col(t) = batch.inputs.col(t * 6 + s);
        const double p = RunNetwork(network, sequence)[0];
        EXPECT_NEAR(result.probabilities[s], p, 1e-6);
        loss -= batch.weights[s] * std::log(batch.targets[s] > 0 ? p : 1 - p);
    }
    EXPECT_NEAR(result.loss, loss, 1e-5);
}

// Large enough that products are split among threads.
TEST(NetworkGradient, IsTheSameOnAnyNumberOfThreads) {
    const Shape shape{.inputs = 200, .steps = 2, .lstm = {256, 64}};
    const NetworkWeights<float> weights = InitialWeights(shape.inputs, shape.lstm, 5);
    const SampleBatch<float> batch = MakeBatch<float>(shape, 64, true, 2);
    std::vector<NetworkWeights<float>> gradients(3, ZerosLike(weights));
    for (int i = 0; i < 3; ++i)
        RunWithThreads(i == 2 ? 8 : i + 1,
                       [&] { AddGradient(weights, batch, &gradients[size_t(i)]); });
    for (size_t array = 0; array < gradients[0].Spans().size(); ++array)
        for (int i : {1, 2})
            EXPECT_TRUE(std::ranges::equal(gradients[0].Spans()[array],
                                           gradients[size_t(i)].Spans()[array]));
}

TEST(InitialWeights, AreKeras) {
    const std::vector<int> lstm = {40, 8};
    const NetworkWeights<float> weights = InitialWeights(20, lstm, 1);
    const LstmWeights<float>& l = weights.lstm[0];
    EXPECT_EQ(l.kernel.rows(), 160);
    EXPECT_EQ(l.kernel.cols(), 20);
    const double limit = std::sqrt(6.0 / 180);
    EXPECT_LE(l.kernel.cwiseAbs().maxCoeff(), limit);
    EXPECT_NEAR(l.kernel.squaredNorm() / float(l.kernel.size()), limit * limit / 3, 1e-3);
    EXPECT_TRUE((l.recurrent.transpose() * l.recurrent).isIdentity(1e-5f));
    EXPECT_TRUE(l.bias.segment(40, 40).isOnes(0));
    EXPECT_EQ(l.bias.sum(), 40);
    EXPECT_EQ(weights.dense[0].kernel.cols(), 8);

    EXPECT_EQ(InitialWeights(20, lstm, 1).lstm[1].kernel, weights.lstm[1].kernel);
    EXPECT_NE(InitialWeights(20, lstm, 2).lstm[1].kernel, weights.lstm[1].kernel);
    for (const std::vector<int>& units : {std::vector<int>{0}, {}})
        EXPECT_THROW(InitialWeights(20, units, 1), std::invalid_argument);
    EXPECT_THROW(InitialWeights(20, std::vector{16000, 16000}, 1), std::invalid_argument);
}

TEST(RmsProp, FollowsItsEquations) {
    NetworkWeights<float> weights, gradient;
    weights.dense.push_back({Eigen::MatrixXf::Constant(1, 2, 1), Eigen::VectorXf::Zero(1)});
    gradient = ZerosLike(weights);
    gradient.dense[0].kernel << 0.5f, -2;
    RmsProp optimizer{.meanSquares = ZerosLike(weights)};
    // The gradient is the sum of both parts.
    const std::vector<NetworkWeights<float>> parts = {gradient, gradient};
    double a = 0, w = 1;
    for (int step = 0; step < 3; ++step) {
        optimizer.Step(parts, &weights);
        a = 0.9 * a + 0.1 * 16;
        w += 1e-3 * 4 / (std::sqrt(a) + 1e-7);
        EXPECT_NEAR(weights.dense[0].kernel(0, 1), w, 1e-6);
        EXPECT_EQ(weights.dense[0].bias[0], 0);
    }
    EXPECT_LT(weights.dense[0].kernel(0, 0), 1);
}

}  // namespace
}  // namespace lull
