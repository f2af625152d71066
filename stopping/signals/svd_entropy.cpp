#include "stopping/signals/svd_entropy.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

// Computes the squared singular values, in any order, of a matrix whose largest element is 1.
//
// They are the eigenvalues of the Gram matrix, which costs a tenth of an SVD. Small ones lose
// their relative accuracy: each is off by about 1e-16 of the largest. That is harmless here, as
// a p_i of 1e-16 contributes 4e-15 to the entropy.
Eigen::VectorXd SquaredSingularValues(const Eigen::MatrixXd& matrix) {
    const auto n = std::min(matrix.rows(), matrix.cols());
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
    if (matrix.rows() <= matrix.cols())
        gram.selfadjointView<Eigen::Lower>().rankUpdate(matrix);
    else
        gram.selfadjointView<Eigen::Lower>().rankUpdate(matrix.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram, Eigen::EigenvaluesOnly);
    if (solver.info() == Eigen::Success) return solver.eigenvalues().cwiseMax(0);
    // The iteration has never been seen not to converge; Jacobi's method always does.
    return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues().array().square();
}

}  // namespace

SvdEntropy ComputeSvdEntropy(const MatrixView& matrix) {
    const int n = int(std::min(matrix.rows(), matrix.cols()));
    if (!matrix.allFinite())
        throw std::invalid_argument("SVD-entropy of a value that is not finite");
    if (n < 2) return {};
    const double largest = matrix.cwiseAbs().maxCoeff();
    if (largest == 0) return {};

    // Scale so that no square overflows or vanishes (as reciprocals of subnormals).
    const Eigen::MatrixXd scaled = matrix / largest;
    Eigen::VectorXd squares = SquaredSingularValues(scaled);
    std::sort(squares.begin(), squares.end(), std::greater<>());
    const double sum = squares.sum(), logN = std::log(double(n));
    SvdEntropy entropy;
    for (int i = 0; i < n; ++i) {
        const double p = squares[i] / sum;
        const double term = p > 0 ? -p * std::log(p) / logN : 0;
        (i < n / 4 ? entropy.h1 : entropy.h2) += term;
    }
    entropy.h1 = std::clamp(entropy.h1, 0.0, 1.0);
    entropy.h2 = std::clamp(entropy.h2, 0.0, 1.0);
    entropy.h = std::min(entropy.h1 + entropy.h2, 1.0);
    return entropy;
}

std::vector<int> SplitEvenly(int length, int parts) {
    std::vector<int> starts(size_t(parts) + 1);
    for (int i = 0; i <= parts; ++i) starts[size_t(i)] = int(int64_t(i) * length / parts);
    return starts;
}

std::vector<SvdEntropy> SubBlockEntropies(std::span<const double> lightness, int width, int height,
                                          int subBlocks) {
    const int count = int(std::lround(std::sqrt(std::max(0, subBlocks))));
    if (count < 1 || count * count != subBlocks)
        throw std::invalid_argument(std::to_string(subBlocks) +
                                    " sub-blocks: a square number is needed, such as 100");
    if (width < count || height < count)
        throw std::invalid_argument("a block of " + std::to_string(width) + "x" +
                                    std::to_string(height) + " pixels has no " +
                                    std::to_string(subBlocks) + " sub-blocks");
    if (lightness.size() != size_t(width) * size_t(height))
        throw std::invalid_argument("SubBlockEntropies: width * height values are needed");

    const std::vector<int> x = SplitEvenly(width, count), y = SplitEvenly(height, count);
    const Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> block(lightness.data(),
                                                                                 height, width);
    std::vector<SvdEntropy> entropies;
    entropies.reserve(size_t(subBlocks));
    for (int v = 0; v < count; ++v)
        for (int u = 0; u < count; ++u)
            entropies.push_back(
                ComputeSvdEntropy(block.block(y[v], x[u], y[v + 1] - y[v], x[u + 1] - x[u])));
    return entropies;
}

std::vector<SvdEntropy> PictureEntropies(const BlockView& view, int subBlocks) {
    CheckView(view, ViewNeed::Mean);
    return SubBlockEntropies(LightnessOf(view.mean), view.width, view.height, subBlocks);
}

namespace {

constexpr double kDepth = 4;        // states are kept down to this part of the spp
constexpr double kTolerance = 1.6;  // of half and a quarter of the spp

// Returns the square of the weighted sum of the roots of the entropies' differences between two
// states: few sub-blocks with much noise must not decide.
double Fall(const EntropyState& from, const EntropyState& to, std::span<const double> weights) {
    double sum = 0;
    for (size_t i = 0; i < to.values.size(); ++i)
        sum += weights[i] * std::sqrt(std::abs(double(from.values[i]) - double(to.values[i])));
    return sum * sum;
}

double Slope(double luminance) { return std::pow(std::max(luminance, kLinearLuminance), -2 / 3.0); }

}  // namespace

NoiseVisibility VisibilityAt(int cap, NoiseVisibility visibility) {
    visibility.reference = std::max(visibility.reference, cap);
    return visibility;
}

double RateOfFall(const EntropyState& oldest, const EntropyState& before, const EntropyState& now,
                  std::span<const double> weights) {
    const double early = Fall(oldest, before, weights), late = Fall(before, now, weights);
    if (!(early > 0 && late > 0)) return 1;
    // Of ratios u, v of the spp, early / late = v^a (u^a - 1) / (v^a - 1) grows with a.
    const double u = double(before.spp) / oldest.spp, v = double(now.spp) / before.spp;
    auto ratio = [&](double a) {
        return std::pow(v, a) * (std::pow(u, a) - 1) / (std::pow(v, a) - 1);
    };
    double least = 1, most = 2;
    if (early <= late * ratio(least)) return least;
    if (early >= late * ratio(most)) return most;
    for (int i = 0; i < 30; ++i) {
        const double middle = (least + most) / 2;
        (late * ratio(middle) < early ? least : most) = middle;
    }
    return (least + most) / 2;
}

std::vector<double> EntropyDrop(const EntropyState& before, const EntropyState& now, double rate) {
    const double scale = 1 / (std::pow(double(now.spp) / before.spp, rate) - 1);
    std::vector<double> drop;
    for (size_t i = 0; i < now.values.size(); ++i)
        drop.push_back(
            std::sqrt(scale * std::abs(double(before.values[i]) - double(now.values[i]))));
    return drop;
}

SubBlockLightness MeasureLightness(const BlockView& view, int subBlocks) {
    CheckView(view, ViewNeed::Mean);
    const int side = int(std::lround(std::sqrt(std::max(0, subBlocks))));
    if (side < 1 || side * side != subBlocks || view.width < side || view.height < side)
        throw std::invalid_argument("a block cannot be cut into that many sub-blocks");
    const std::vector<float> lightness = DisplayedLightness(view.mean);
    SubBlockLightness result;
    const std::vector<int> xs = SplitEvenly(view.width, side), ys = SplitEvenly(view.height, side);
    for (size_t v = 0; v + 1 < ys.size(); ++v)
        for (size_t u = 0; u + 1 < xs.size(); ++u) {
            double sum = 0, squares = 0;
            for (int y = ys[v]; y < ys[v + 1]; ++y)
                for (int x = xs[u]; x < xs[u + 1]; ++x) {
                    const double l = lightness[size_t(y) * size_t(view.width) + size_t(x)];
                    sum += l;
                    squares += l * l;
                }
            const double count = (ys[v + 1] - ys[v]) * (xs[u + 1] - xs[u]), mean = sum / count;
            result.mean.push_back(float(mean));
            result.deviation.push_back(
                float(std::sqrt(std::max(0.0, squares / count - mean * mean))));
        }
    return result;
}

double FlareFactor(double lightness, double flare) {
    const double y = LuminanceOf(lightness);
    return Slope((y + flare) / (1 + flare)) / (1 + flare) / Slope(y);
}

double NearnessFactor(int spp, const NoiseVisibility& visibility) {
    const double left = 1 - double(spp) / visibility.reference;
    return left > 0 ? std::pow(left, visibility.nearness) : 0;
}

std::vector<double> VisibleDrop(std::span<const double> drop, const SubBlockLightness& lightness,
                                int spp, const NoiseVisibility& visibility) {
    const double near = NearnessFactor(spp, visibility);
    std::vector<double> visible;
    for (size_t i = 0; i < drop.size(); ++i) {
        const double l = lightness.mean[i];
        visible.push_back(drop[i] * l * FlareFactor(l, visibility.flare) /
                          (1 + lightness.deviation[i] / visibility.mask) * near);
    }
    return visible;
}

void AddEntropies(int spp, std::span<const double> entropies, History<float>* history) {
    history->Add({spp, {entropies.begin(), entropies.end()}});
    history->Thin(kDepth);
}

std::optional<std::vector<double>> LatestDrop(const History<float>& history,
                                              std::span<const double> weights) {
    if (history.States().empty()) return {};
    const EntropyState& now = history.States().back();
    if (weights.size() != now.values.size())
        throw std::invalid_argument("a weight for each sub-block is needed");
    const EntropyState* before = history.Nearest(now.spp / 2.0, kTolerance);
    if (!before) return {};
    const EntropyState* oldest = history.Nearest(before->spp / 2.0, kTolerance);
    const bool three = oldest && oldest->spp < before->spp;
    return EntropyDrop(*before, now, three ? RateOfFall(*oldest, *before, now, weights) : 1);
}

std::optional<std::vector<double>> LatestVisibleDrop(const History<float>& history,
                                                     const SubBlockLightness& lightness,
                                                     const NoiseVisibility& visibility) {
    std::vector<double> weights;
    for (const float l : lightness.mean) weights.push_back(l * FlareFactor(l, visibility.flare));
    const auto drop = LatestDrop(history, weights);
    if (!drop) return {};
    return VisibleDrop(*drop, lightness, history.States().back().spp, visibility);
}

}  // namespace lull
