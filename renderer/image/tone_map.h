// Fits radiance to the range of a display.
#pragma once

#include <algorithm>

namespace lull {

enum class ToneMap { None, Filmic };

// Applies the curve of J. Hable ("Filmic Tonemapping Operators", 2010; from Uncharted 2) to a
// linear component: toe and shoulder of film, with his constants, an exposure bias of 2 and a
// linear white of 11.2, which becomes 1. At least 0; NaN and negative values become 0.
inline float FilmicToneMap(float linear) {
    const auto curve = [](double x) {
        constexpr double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
        return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
    };
    // Beyond the bound the curve is flat.
    const double x = linear > 0 ? std::min(2 * double(linear), 1e6) : 0;
    return float(std::max(0., curve(x) / curve(11.2)));
}

}  // namespace lull
