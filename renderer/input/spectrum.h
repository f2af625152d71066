// Converts every form of spectrum in a scene file to linear RGB, as pbrt-v3's RGBSpectrum does.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/input/description.h"

namespace lull {

// The colour matching functions of the CIE 1931 2-degree standard observer.
inline constexpr int kCieFirst = 360, kCieLast = 830;  // nm, in steps of 1
inline constexpr int kCieRows = kCieLast - kCieFirst + 1;
extern const std::array<float, kCieRows> kCieX, kCieY, kCieZ;

Rgb RgbFromXyz(double x, double y, double z);

// Returns the RGB of a spectrum given as pairs (wavelength in nm, value), in any order, linear
// between them and constant beyond: the integrals with the colour matching functions, scaled so
// that a constant 1 has Y near 1. Warns of spectra of no visible wavelength. Throws Error at `loc`
// for no pairs, half a pair, and a result beyond float's range.
Rgb RgbFromSamples(std::span<const float> pairs, const FileLoc& loc = {},
                   Warnings* warnings = nullptr);

// Returns the RGB of a black body at `kelvin` > 0 whose spectrum is scaled to a maximum of 1.
// Throws Error at `loc` for other temperatures.
Rgb RgbFromBlackbody(double kelvin, const FileLoc& loc = {});

// Returns the spectral radiance of a black body (Planck's law) up to a factor; wavelength in m.
double Planck(double wavelength, double kelvin);

// Reads a file of wavelengths (nm) and values, separated by white space or commas, with comments
// from '#' to the end of the line. `loc` names the file. Throws Error if it cannot be read.
Rgb LoadSpectrum(const std::string& path, const FileLoc& loc = {}, Warnings* warnings = nullptr);

// Return pbrt-v3's defaults for metals: copper's index of refraction and absorption as RGB.
Rgb CopperEta();
Rgb CopperK();

// Reads text files that are nothing but numbers, such as spectra and lenses.

// Reads numbers that spaces or commas separate, up to '#' in each line. Throws Error, with file and
// line, for anything else and for numbers that are not finite; `kind` names the file in messages
// ("spectrum"). `loc` is the place that names the file.
std::vector<float> ReadNumberFile(const std::string& path, const std::string& kind,
                                  const FileLoc& loc);

// Reads numbers that have to be at least 0, of which rounding may have left some just below.

// Returns NotNegative(x); negative numbers and NaN as they are.
float RaisedToZero(float x);

// Returns a parameter so. Throws Error with its place unless that is finite and at least 0.
float GetNonnegative(const Entity& entity, const std::string& name, float otherwise);

}  // namespace lull
