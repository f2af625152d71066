// Measures how evenly the energy of an image is spread over its singular values: noise raises the
// small ones, so their entropy falls as a rendering converges.
//
// "The paper" is, here and elsewhere: Buisine, Bigand, Synave, Delepoulle, Renaud: Stopping
// Criterion during Rendering of Computer-Generated Images Based on SVD-Entropy. Entropy 2021,
// 23(1), 75.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

// The entropies of one matrix. With the singular values s_1 >= ... >= s_n and
// p_i = s_i^2 / sum s^2, H = -1/log(n) sum p_i log p_i (paper, Eq. 3); H1 takes the terms of the
// first floor(n / 4) values and H2 the others (Eqs. 4, 5), both with the p_i and the n of the
// whole, so that H = H1 + H2. All in [0, 1].
struct SvdEntropy {
    double h = 0, h1 = 0, h2 = 0;
};

using MatrixView =
    Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
               Eigen::OuterStride<>>;

// Computes the entropies of a matrix of any shape, n = min(rows, columns). Zero for a matrix that
// is all zero or has only one singular value. Exact to about 1e-13. Throws std::invalid_argument
// if a value is not finite.
SvdEntropy ComputeSvdEntropy(const MatrixView& matrix);

// Returns where `parts` pieces of [0, length) begin and, at the end, `length`; their sizes differ
// by at most one.
std::vector<int> SplitEvenly(int length, int parts);

// Computes the entropies of the count x count pieces of a block, row-major, where count^2 is
// `subBlocks`. `lightness` holds width * height values, row-major. Throws std::invalid_argument if
// subBlocks is not a square, the block has fewer pixels a side than that, or a value is not finite.
std::vector<SvdEntropy> SubBlockEntropies(std::span<const double> lightness, int width, int height,
                                          int subBlocks);

// Computes the same from the lightness of a block as an 8-bit display shows it. Reads the mean
// only. Also throws as CheckView() does.
std::vector<SvdEntropy> PictureEntropies(const BlockView& view, int subBlocks);

}  // namespace lull
