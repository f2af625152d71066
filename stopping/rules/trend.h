// Describes the course of the number that a rule compares over the sample count, from which the
// stops of blocks are predicted.
#pragma once

namespace lull {

struct Model;

struct RuleTrend {
    enum Kind {
        Error,        // above 0; falls as a power of the spp
        Probability,  // in [0, 1]; falls too
        Samples       // the spp themselves, which rise to the threshold
    };
    Kind kind = Error;
    int votes = 1;  // in a row that stop a block
    // Noise at which a network with no other input is undecided. Predictions follow the noise then,
    // as a probability is no power of the spp. 0: not known.
    double undecided = 0;
    // Spp of the picture that noise is compared with: it falls as a power of 1/spp - 1/reference.
    // 0: none.
    int reference = 0;
    // Whether it falls more slowly where there is much noise, as falls of entropies do, and
    // approaches the power -1/2 with less.
    bool saturates = false;
};

struct NoiseVisibility;

// Returns the trend of visible falls of entropies (entropy_drop.h).
RuleTrend TrendOfFalls(const NoiseVisibility& visibility);

// Returns the trend of a model's answers, or of its noise input.
RuleTrend TrendOf(const Model& model);

// Returns the noise, times the caution, above which a model takes a block for noisy. It is defined
// for models with no input but noise, whose window then has the noise of earlier steps too: at
// geometric spacing as if it had fallen with the root of the spp, at fixed spacing as if it were
// the same. 0 for other models, and where the limit is not between 0.001 and 1000.
double UndecidedNoise(const Model& model);

}  // namespace lull
