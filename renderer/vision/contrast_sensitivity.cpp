#include "renderer/vision/contrast_sensitivity.h"

#include <cmath>

#include "renderer/base/math.h"

namespace lull {

namespace {

// Parameters by their names in the paper. A value that grows with luminance l is
// a (1 + b / l)^-c; one that also falls again has the factor 1 - (1 + d / l)^-e.
struct Growth {
    double a, b, c;
};

struct Mechanism {
    Growth peak;       // sensitivity
    Growth frequency;  // of the peak, cycles per degree
    double bandwidth;
    double truncation;  // how far sensitivity falls below the frequency of the peak
    double area, areaFrequency;
};

constexpr Mechanism kAchromatic = {{56.4947, 7.54726, 0.144532},
                                   {1.78119, 91.5718, 0.256682},
                                   0.000213047,
                                   0.100207,
                                   157.103,
                                   0.702338};
constexpr Mechanism kRedGreen = {
    {681.434, 38.0038, 0.480386}, {0.0178364, 0, 0}, 2.42104, 0, 2816.44, 0.0711058};
constexpr Mechanism kYellowViolet = {
    {166.683, 62.8974, 0.41193}, {0.00425753, 0, 0}, 2.68197, 0, 2.82789e7, 0.000635093};

double At(const Growth& growth, double luminance) {
    return growth.a * std::pow(1 + growth.b / luminance, -growth.c);
}

double Fall(double luminance) {
    constexpr double d = 5.58341e-7, e = 9.66862e9;
    return -std::expm1(-e * std::log1p(d / luminance));
}

}  // namespace

double ContrastSensitivity(OpponentChannel channel, const GaborPatch& patch) {
    const bool isAchromatic = channel == OpponentChannel::Achromatic;
    const Mechanism& m = isAchromatic                           ? kAchromatic
                         : channel == OpponentChannel::RedGreen ? kRedGreen
                                                                : kYellowViolet;
    double peak = At(m.peak, patch.luminance);
    if (isAchromatic) peak *= Fall(patch.luminance);
    const double peakFrequency = At(m.frequency, patch.luminance);
    double response =
        std::pow(10, -Sqr(std::log10(patch.frequency / peakFrequency)) / std::exp2(m.bandwidth));
    if (patch.frequency < peakFrequency) response = std::max(response, 1 - m.truncation);
    // How sensitivity grows with area (Rovamo, Luntinen, Nasanen: Modelling the dependence of
    // contrast sensitivity on grating area and spatial frequency, Vision Research 33, 1993).
    const double criticalArea = m.area / (1 + Sqr(patch.frequency / m.areaFrequency));
    return peak * response * std::sqrt(criticalArea / (1 + criticalArea / patch.area)) *
           patch.frequency;
}

}  // namespace lull
