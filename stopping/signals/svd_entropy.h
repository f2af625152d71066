// Measures how evenly the energy of an image is spread over its singular values: noise raises the
// small ones, so their entropy falls as a rendering converges.
//
// "The paper" is, here and elsewhere: Buisine, Bigand, Synave, Delepoulle, Renaud: Stopping
// Criterion during Rendering of Computer-Generated Images Based on SVD-Entropy. Entropy 2021,
// 23(1), 75.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/base/state.h"

namespace lull {

// Remembers those states of a block that later ones are compared with.

template <typename Real>
struct BlockState {
    int spp = 0;
    std::vector<Real> values = {};
};

// States by increasing spp, all with as many values. The caller of Add() discards old ones.
template <typename Real>
class History {
  public:
    // Adds a state. Throws std::invalid_argument unless its spp are above those of all others and
    // its values are finite and as many as theirs.
    void Add(BlockState<Real> state) {
        if (state.spp < 1 || !Follows(state))
            throw std::invalid_argument("states of a block must come with increasing spp");
        if (!IsFinite(state) ||
            (!states.empty() && states.back().values.size() != state.values.size()))
            throw std::invalid_argument(
                "the values of a block's state are not finite or not as many as before");
        states.push_back(std::move(state));
    }

    // Forgets all states below an spp.
    void ForgetBelow(int64_t spp) {
        std::erase_if(states, [&](const BlockState<Real>& s) { return s.spp < spp; });
    }

    // To be called after each Add(). Keeps states a step apart, eight an octave, down to the spp of
    // the last one / depth: near enough to any spp in between, and few however many samples there
    // are. Which are kept depends only on the spp at which they were added.
    void Thin(double depth) {
        const size_t count = states.size();
        if (count > 2 && !IsStep(states[count - 3].spp, states[count - 2].spp))
            states.erase(states.end() - 2);
        size_t old = 0;
        while (old + 2 < states.size() && states[old + 1].spp <= states.back().spp / depth) ++old;
        states.erase(states.begin(), states.begin() + ptrdiff_t(old));
    }

    const std::vector<BlockState<Real>>& States() const { return states; }  // the oldest first

    // Returns the state at an spp; null if there is none.
    const BlockState<Real>* At(int spp) const {
        const auto it = std::ranges::lower_bound(states, spp, {}, &BlockState<Real>::spp);
        return it != states.end() && it->spp == spp ? &*it : nullptr;
    }

    // Returns the state before the last that is nearest to `spp` by its ratio, within a factor of
    // `tolerance`; null if there is none.
    const BlockState<Real>* Nearest(double spp, double tolerance) const {
        const BlockState<Real>* best = nullptr;
        double least = std::log(tolerance);
        for (size_t i = 0; i + 1 < states.size(); ++i) {
            const double distance = std::abs(std::log(states[i].spp / spp));
            if (distance > least) continue;
            least = distance;
            best = &states[i];
        }
        return best;
    }

    // Write and read all states. Restore() throws std::runtime_error if they are damaged or do not
    // have `count` values each.
    void Save(StateWriter* writer) const {
        writer->Put(uint32_t(states.size()));
        for (const BlockState<Real>& state : states) {
            writer->Put(int32_t(state.spp));
            writer->PutAll(std::span(state.values));
        }
    }
    void Restore(StateReader* reader, size_t count) {
        states.clear();
        for (uint32_t left = reader->Get<uint32_t>(); left > 0; --left) {
            BlockState<Real> state{.spp = reader->Get<int32_t>(),
                                   .values = std::vector<Real>(count)};
            reader->GetAll(std::span(state.values));
            if (state.spp < 1 || !Follows(state) || !IsFinite(state))
                throw std::runtime_error("the saved states of a block are damaged");
            states.push_back(std::move(state));
        }
    }

    // Returns whether both lie far enough apart to be kept.
    static bool IsStep(int from, int to) { return 11 * double(to) >= 12 * double(from); }

  private:
    bool Follows(const BlockState<Real>& state) const {
        return states.empty() || state.spp > states.back().spp;
    }
    static bool IsFinite(const BlockState<Real>& state) {
        return std::ranges::all_of(state.values, [](Real v) { return std::isfinite(v); });
    }

    std::vector<BlockState<Real>> states;
};

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

// Returns where `parts` pieces of [0, length) begin, and `length`; sizes differ by one at most.
std::vector<int> SplitEvenly(int length, int parts);

// Computes the entropies of the count x count pieces of a block, row-major, where count^2 is
// `subBlocks`. `lightness` holds width * height values, row-major. Throws std::invalid_argument if
// subBlocks is not a square, the block has fewer pixels a side than that, or a value is not finite.
std::vector<SvdEntropy> SubBlockEntropies(std::span<const double> lightness, int width, int height,
                                          int subBlocks);

// Computes the same from a block's mean in lightness of an 8-bit display. Throws as CheckView().
std::vector<SvdEntropy> PictureEntropies(const BlockView& view, int subBlocks);

// Measures noise by its contribution to the SVD-entropy of a picture: an entropy alone says little,
// but its fall since half as many samples is due to noise.
//
// Noise of variance v in lightness, small against the mean lightness L, adds about c v / L^2 to the
// entropy of a sub-block, with a c that hardly changes. As v falls as 1 / spp, the fall from n / 2
// to n equals the rest at n, and sqrt(fall) L is the noise's standard deviation, apart from the
// factor sqrt(c), 1.5 to 2: c is 1/log(n) times the logarithm of one over the noise's fraction of
// each singular value. This needs only two displayed pictures.

// How an observer sees noise.
struct NoiseVisibility {
    // Detail of deviation d in L hides noise: it counts 1 / (1 + d / mask).
    double mask = 40;
    // Light that the screen reflects, as a share of white: 0.05 is the typical viewing flare of the
    // sRGB standard (IEC 61966-2-1). It hides noise in dark parts.
    double flare = 0.05;
    // People compared each picture with the one at N = `reference` spp, the same samples and more:
    // the variance of the difference is (1 - n / N) v(n), so that noise counts
    // (1 - n / N)^nearness.
    int reference = 10000;
    double nearness = 0.5;

    bool operator==(const NoiseVisibility&) const = default;
};

// Returns the visibility where renders end at `cap` spp (0: not known). The observers' reference
// counts as free of noise; where the cap is larger, the picture at the cap does, and a smaller cap
// does not change the reference.
NoiseVisibility VisibilityAt(int cap, NoiseVisibility visibility);

// The entropies of the sub-blocks of a picture, row-major, at some spp.
using EntropyState = BlockState<float>;

// Returns the exponent a, in [1, 2], with which noise falls as spp^-a, from three states with
// increasing spp, using weighted roots of the sub-blocks' falls; 1 if nothing changes. Independent
// samples have 1 (entropies give some 0.1 less); if noise falls faster, less is left than the fall.
double RateOfFall(const EntropyState& oldest, const EntropyState& before, const EntropyState& now,
                  std::span<const double> weights);

// Returns for each sub-block sqrt(|H(before) - H(now)| / ((n / n')^rate - 1)), where n, n' are the
// spp of `now` and `before`: the root of the noise's part of the entropy now. Both have the same
// length, and `before` has fewer spp. (Noise that happens to be correlated with detail moves an
// entropy up or down, and rare events raise it when they occur: both count as noise.)
std::vector<double> EntropyDrop(const EntropyState& before, const EntropyState& now, double rate);

// Mean and deviation of the displayed lightness of sub-blocks, row-major, in [0, 100].
struct SubBlockLightness {
    std::vector<float> mean, deviation;
};

// Measures the count x count pieces of a block, where count^2 is `subBlocks`. Reads the mean only.
// Throws as CheckView() does, and std::invalid_argument if the block cannot be cut into them.
SubBlockLightness MeasureLightness(const BlockView& view, int subBlocks);

// Returns the factor by which a screen that reflects `flare` reduces a difference in lightness
// around L: the derivative of the lightness of (Y + flare) / (1 + flare) over that of Y. In (0, 1];
// for the 0.05 of sRGB 0.3 in black, 0.6 at L = 25, 0.9 at 65.
double FlareFactor(double lightness, double flare);

// Returns (1 - spp / reference)^nearness: the part of noise that counts; 0 from the reference on.
double NearnessFactor(int spp, const NoiseVisibility& visibility);

// Returns the visible noise of each sub-block, drop * L * FlareFactor(L) / (1 + d / mask) *
// (1 - spp / reference)^nearness, in lightness; 0 from the reference on. All have the same length.
std::vector<double> VisibleDrop(std::span<const double> drop, const SubBlockLightness& lightness,
                                int spp, const NoiseVisibility& visibility);

// Adds the entropies of the sub-blocks at `spp`, and keeps the states that later ones need: about
// eight an octave down to a quarter of the spp, at most 19 (8 KB per block for 100 sub-blocks),
// however many samples there are. Throws as History::Add() does.
void AddEntropies(int spp, std::span<const double> entropies, History<float>* history);

// Returns EntropyDrop() of the last state since that nearest to half of its spp, corrected by
// RateOfFall() with these weights if there is also one at about a quarter; nothing before there is
// such a state. Throws std::invalid_argument if there are not as many weights as sub-blocks.
std::optional<std::vector<double>> LatestDrop(const History<float>& history,
                                              std::span<const double> weights);

// Returns VisibleDrop() of the last state, which has this lightness, as LatestDrop() does; for the
// rate of the fall, sub-blocks are weighted as their noise is in lightness.
std::optional<std::vector<double>> LatestVisibleDrop(const History<float>& history,
                                                     const SubBlockLightness& lightness,
                                                     const NoiseVisibility& visibility);

}  // namespace lull
