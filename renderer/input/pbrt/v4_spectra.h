// Turns pbrt-v4's spectra into linear sRGB: by what they are spectra of, as rendering by
// wavelengths would show them in the light of D65.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"

namespace lull {

// Values at rising wavelengths in nm, linear between them and 0 outside.
struct SampledSpectrum {
    std::vector<Vec2f> samples;

    double At(double wavelength) const;
};
struct NamedSpectrum {
    std::string name;
};
struct BlackbodySpectrum {
    float kelvin;
};

using V4Spectrum = std::variant<Rgb, SampledSpectrum, NamedSpectrum, BlackbodySpectrum>;

// Reads pairs of wavelength and value. Throws Error at `loc` unless the wavelengths rise.
SampledSpectrum SampledSpectrumOf(std::span<const float> pairs, const FileLoc& loc);

// Returns whether pbrt-v4 has a spectrum of that name built in.
bool IsNamedSpectrum(const std::string& name);

// Each throws Error at `loc` where the spectrum is of another thing by its name.

// Returns the colour of emitted light, of luminance 1 but for RGB, as pbrt-v4 has it. Parts below 0
// are black.
Rgb RgbOfLight(const V4Spectrum&, const FileLoc& loc);
// Returns that of a reflectance, or of a coefficient of absorption or scattering.
Rgb RgbOfSurface(const V4Spectrum&, const FileLoc& loc);
// Returns the index of refraction at 587.6 nm, of RGB the mean.
float IndexOf(const V4Spectrum&, const FileLoc& loc);
// Returns eta and k with which the reflectance at normal incidence is that of the spectra.
std::pair<Rgb, Rgb> RgbOfConductor(const V4Spectrum& eta, const V4Spectrum& k, const FileLoc& loc);

// Returns the matrix from a colour space of pbrt-v4 to linear sRGB, by way of XYZ and without
// adaptation. Throws Error at `loc` for other names.
Mat3f RgbFromColorSpace(const std::string& name, const FileLoc& loc);

// Returns the matrix of linear sRGB that turns the white of daylight of so many kelvin into that of
// D65 (Bradford's adaptation); below 4,000 K the white is a black body's.
Mat3f WhiteBalance(float kelvin);

}  // namespace lull
