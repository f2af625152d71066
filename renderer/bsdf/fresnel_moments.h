// Integrates the reflectance of a smooth dielectric over the hemisphere.
#pragma once

namespace lull {

// Return the integral over cosines from 0 to 1 of F cos and F cos^2, F for light that comes from
// the inside of a dielectric of index `eta` (below 1: from the outside of one of 1 / eta):
// polynomial fits of d'Eon and Irving 2011, "A Quantized-Diffusion Model for Rendering Translucent
// Materials".
inline double FresnelMoment1(double eta) {
    if (eta < 1)
        return 0.45966 +
               eta * (-1.73965 +
                      eta * (3.37668 + eta * (-3.904945 + eta * (2.49277 - eta * 0.68441))));
    return -4.61686 +
           eta * (11.1136 + eta * (-10.4646 + eta * (5.11455 + eta * (-1.27198 + eta * 0.12746))));
}
inline double FresnelMoment2(double eta) {
    if (eta < 1)
        return 0.27614 +
               eta * (-0.87350 +
                      eta * (1.12077 + eta * (-0.65095 + eta * (0.07883 + eta * 0.04860))));
    const double r = 1 / eta;
    return -547.033 + r * (458.843 + r * (-218.725 + r * 45.3087)) +
           eta * (404.557 + eta * (-189.519 + eta * (54.9327 + eta * (-9.00603 + eta * 0.63942))));
}

}  // namespace lull
