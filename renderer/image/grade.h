// Grades pictures: converts linear colours to those that a display shows.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>

#include "renderer/base/variant.h"
#include "renderer/formats/formats.h"

namespace lull {

// How radiance is fitted to the range of a display.
enum class ToneMap { None, Filmic };

template <>
struct EnumNames<ToneMap> {
    static constexpr std::pair<ToneMap, const char*> all[] = {{ToneMap::None, "none"},
                                                              {ToneMap::Filmic, "filmic"}};
};

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

// How linear colours become those that a display shows.
struct Grade {
    ToneMap toneMap = ToneMap::None;
    // Encodes the colours instead of sRGB and the tone map; null: none.
    std::shared_ptr<const ViewTransform> view = {};
    float exposure = 0;  // stops by which the colours are brightened before

    // Returns whether nothing is changed.
    bool IsPlain() const { return toneMap == ToneMap::None && !view && exposure == 0; }
};

// Returns "filmic (Hable 2010)", "OpenColorIO DISPLAY/VIEW", "+2 stops", or two of them; empty for
// a plain one.
std::string TextOf(const Grade&);

// Brightens linear R, G, B of each pixel and maps them by the view or the tone map. Returns whether
// they are encoded now, as a view does.
bool MapColors(const Grade&, std::span<float> rgb);

// Replaces linear R, G, B of each pixel by those that an sRGB display shows in the graded picture:
// finite, at least 0, above 1 only without tone map and view, and not rounded.
void ApplyGrade(const Grade&, std::span<float> rgb);

// Returns a view of the configuration file `config`, empty: $OCIO, for its default display; the
// default view if `view` is empty. Throws Error, with the names of the views if there is no such.
std::shared_ptr<const ViewTransform> LoadView(const std::string& config, const std::string& view);

}  // namespace lull
