// How the number that a rule compares goes with the samples, for those who predict where
// blocks will stop.
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
    // Of a network that is told nothing but noise, that at which it is undecided. Predictions
    // follow that then, as a probability is no power of the spp. 0: not known.
    double undecided = 0;
    // The spp of the picture that noise is compared with: it falls as a power of 1/spp -
    // 1/reference. 0: it is compared with none.
    int reference = 0;
    // Whether it falls more slowly where there is much noise, as falls of entropies do, and comes
    // to the power -1/2 with less.
    bool saturates = false;
};

struct NoiseVisibility;

// Returns how visible falls of entropies go (entropy_drop.h).
RuleTrend TrendOfFalls(const NoiseVisibility& visibility);

// Returns how the answers of a model go, or the noise that it looks at.
RuleTrend TrendOf(const Model& model);

// Returns the noise, times the caution, at which a model that looks at nothing else is undecided,
// where noise has fallen with the root of the spp, or not to be told at fixed spacing; 0 for other
// models, and if no noise between 0.001 and 1000 is the limit.
double UndecidedNoise(const Model& model);

}  // namespace lull
