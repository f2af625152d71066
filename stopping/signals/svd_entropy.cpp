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

    // Scale so that no square overflows or vanishes. (The reciprocal of a subnormal would
    // overflow.)
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

}  // namespace lull
