// Predicts when blocks will stop, from how the number that their rule compares has gone so far.
#pragma once

#include <array>
#include <cstdint>
#include <ctime>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/schedule/schedule.h"
#include "stopping/rules/rule.h"

namespace lull {

// Follows the number that a rule compares for one block, as its level above the threshold: the
// logarithm of the ratio of both or, of probabilities, of their odds; of the noise that a network
// looks at, where that is all. Takes 2.3 KiB, however long the render.
class StopTrend {
  public:
    explicit StopTrend(const RuleTrend& rule = {}) : rule(rule) {}

    // Adds a decision of the criterion at `spp` > 0, which increases. `noise` is
    // Criterion::NetworkNoise(): rules that have it ignore a decision without it.
    void Add(int spp, const Decision& decision, std::optional<double> noise = {});

    // Describes the last two doublings by a straight line of the level over Abscissa(). Levels
    // above `certain`, as sure as a network can be, are left out.
    struct Line {
        double level = 0;  // at the last spp
        double slope = 0;  // 0: not to be seen yet
        int points = 0;    // that the slope is seen in, eight a doubling
    };
    Line Fit(double certain) const;
    double HighestLevel() const { return highest; }  // so far

    const RuleTrend& Rule() const { return rule; }
    // Returns whether a level is of odds, which fall as fast as a network likes.
    bool IsOfOdds() const { return rule.kind == RuleTrend::Probability && rule.undecided == 0; }

    // Converts spp to the abscissa over which levels are straight lines, and back: log(spp), less
    // 2 x log(1 - spp / N) for a rule that compares with a picture at N spp, x being the nearness.
    double Abscissa(double spp) const;
    double SppAt(double abscissa) const;

    int LastSpp() const { return lastSpp; }  // 0: the block has not been checked
    double Threshold() const { return threshold; }
    // Returns the spp that the votes in a row still take, at the least.
    int VotesLeft() const;

  private:
    static constexpr int kBinsPerOctave = 8, kBins = 24 * kBinsPerOctave;
    static int PlaceOf(int spp);

    struct Bin {
        float abscissa = 0, level = 0, count = 0;  // sums
    };

    RuleTrend rule;
    std::array<Bin, kBins> bins = {};
    int lastSpp = 0, spacing = 0, votes = 0;
    double threshold = 0, highest = 0;
};

// Returns the spp at which each block stops: its own where it has stopped, a predicted one between
// its spp and the cap where it has not, its leader's where it does not vote. Blocks without a
// prediction take at least the median of the others; nothing is returned if there is none at all.
// `trends` has one for each block.
//
// The error of a Monte Carlo estimate falls as a power of the samples, with the exponent -1/2 if
// they are independent: in logarithms a line. It is fitted by the median of the slopes between any
// two points (Theil 1950, Sen 1968), with the slope of other blocks where one has shown little.
std::optional<std::vector<double>> PredictStops(std::span<const StopTrend> trends,
                                                std::span<const Block> blocks, int cap);

// Returns the samples still to take between which 80 of 100 renders end, where `taken` > 0 have
// been and `left` are predicted. Predictions follow a power law, whose error grows with its reach:
// all samples are taken * (1 + left / taken)^e. `exponents` are the 9 and 91 % quantiles of e
// (RuleTrend). Scenes left out of them are held in 81 of 100 forecasts, in 85 with `denoised`
// (tests/measurements/models.md#remaining-time).
std::array<double, 2> RangeOfRest(double taken, double left,
                                  const std::array<double, 2>& exponents);

// Parses durations and times of day, and estimates the time of the last steps.

// Returns the seconds, > 0, that "10", "500ms", "90s", "10m", "2h" or a sum such as "1h30m" stand
// for. Numbers can have fractions. Throws std::invalid_argument for anything else.
double ParseDuration(const std::string& text);

// Returns the first time after `now` at which clocks here show "HH:MM" or "HH:MM:SS", of 24 hours.
// Throws std::invalid_argument for anything else.
std::time_t NextTimeOfDay(const std::string& text, std::time_t now);

// Return the seconds to leave for an image's files, twice their CPU time, and for its denoiser.
double SecondsToWrite(int64_t pixels);
double SecondsToDenoise(int64_t pixels, int threads);

}  // namespace lull
