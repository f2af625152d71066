#include "renderer/input/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/files/file_io.h"

namespace lull {
namespace {

// Weighs spectra with the colour matching functions; the scale is pbrt-v3's: the range over the
// number of samples times its value of the integral of y.
template <typename Spectrum>
Rgb Integrate(const Spectrum& spectrum) {
    constexpr double kIntegralOfY = 106.856895;
    constexpr double kScale = (kCieLast - kCieFirst) / (kIntegralOfY * kCieRows);
    double x = 0, y = 0, z = 0;
    for (int i = 0; i < kCieRows; ++i) {
        const double value = spectrum(double(kCieFirst + i)) * kScale;
        x += value * kCieX[i];
        y += value * kCieY[i];
        z += value * kCieZ[i];
    }
    return RgbFromXyz(x, y, z);
}

}  // namespace

double Planck(double wavelength, double kelvin) {
    constexpr double kLight = 299792458, kPlanck = 6.62606957e-34, kBoltzmann = 1.3806488e-23;
    return std::pow(wavelength, -5) /
           std::expm1(kPlanck * kLight / (wavelength * kBoltzmann * kelvin));
}

Rgb RgbFromXyz(double x, double y, double z) {
    // The matrix of ITU-R BT.709 primaries and D65 white, in pbrt-v3's digits.
    return Rgb(float(3.240479 * x - 1.537150 * y - 0.498535 * z),
               float(-0.969256 * x + 1.875991 * y + 0.041556 * z),
               float(0.055648 * x - 0.204043 * y + 1.057311 * z));
}

Rgb RgbFromSamples(std::span<const float> pairs, const FileLoc& loc, Warnings* warnings) {
    if (pairs.empty() || pairs.size() % 2 != 0)
        throw Error(loc, "a spectrum needs pairs of wavelength and value, but there are " +
                             std::to_string(pairs.size()) + " numbers");
    struct Sample {
        float wavelength, value;
    };
    std::vector<Sample> samples(pairs.size() / 2);
    for (size_t i = 0; i < samples.size(); ++i) samples[i] = {pairs[2 * i], pairs[2 * i + 1]};
    const auto before = [](const Sample& a, const Sample& b) {
        return a.wavelength < b.wavelength;
    };
    std::stable_sort(samples.begin(), samples.end(), before);

    const double first = samples.front().wavelength, last = samples.back().wavelength;
    if (warnings && first < last && (last < kCieFirst || first > kCieLast))
        warnings->Add(loc,
                      "a spectrum has no wavelength from 360 to 830 nm; its end counts for all",
                      fmt::format("it has {:g} to {:g}", first, last));

    // Wavelengths are asked for in rising order, so one pass over the samples serves them all.
    // Where two were rounded to the same one, values jump.
    size_t next = 0;
    const Rgb rgb = Integrate([&](double wavelength) -> double {
        while (next < samples.size() && samples[next].wavelength <= wavelength) ++next;
        if (next == 0) return samples.front().value;
        if (next == samples.size()) return samples.back().value;
        const Sample &a = samples[next - 1], &b = samples[next];
        const double t = (wavelength - a.wavelength) / (double(b.wavelength) - a.wavelength);
        return (1 - t) * a.value + t * b.value;
    });
    if (!IsFinite(rgb)) throw Error(loc, "the values of a spectrum are too large");
    return rgb;
}

Rgb RgbFromBlackbody(double kelvin, const FileLoc& loc) {
    if (!(kelvin > 0))
        throw Error(loc,
                    "a black body needs a temperature above 0 K, not " + std::to_string(kelvin));
    // Wien's displacement law gives the maximum to scale by.
    const double maximum = Planck(2.8977721e-3 / kelvin, kelvin);
    const Rgb rgb = Integrate([&](double nm) { return Planck(nm * 1e-9, kelvin) / maximum; });
    if (!IsFinite(rgb))
        throw Error(loc, "a black body of " + std::to_string(kelvin) + " K is beyond all range");
    return rgb;
}

Rgb LoadSpectrum(const std::string& path, const FileLoc& loc, Warnings* warnings) {
    return RgbFromSamples(ReadNumberFile(path, "spectrum", loc),
                          {std::make_shared<const std::string>(path), 0}, warnings);
}

// From the tabulated constants of copper (56 wavelengths from 299 to 886 nm) by RgbFromSamples.
Rgb CopperEta() { return Rgb(0.19998972f, 0.92208579f, 1.0998763f); }
Rgb CopperK() { return Rgb(3.9046382f, 2.4476332f, 2.1376510f); }

namespace {

bool IsSeparator(char c) { return std::isspace(static_cast<unsigned char>(c)) || c == ','; }

struct Separators {
    bool haveCommas = false, haveBlanks = false;  // alone

    // Takes the separators behind a number. Throws Error where commas seem to be decimal ones.
    void Add(std::string_view between, const FileLoc& loc) {
        if (between.find_first_of("\r\n") != between.npos) {
            *this = {};
            return;
        }
        haveCommas |= between == ",";
        haveBlanks |= between.find(',') == between.npos;
        if (haveCommas && haveBlanks)
            throw Error(loc,
                        "numbers of a line are apart by commas and by blanks; write decimal points "
                        "instead of commas");
    }
};

}  // namespace

std::vector<float> ReadNumberFile(const std::string& path, const std::string& kind,
                                  const FileLoc& loc) {
    const FileContents contents = ReadFile(path, loc);
    FileLoc place{std::make_shared<const std::string>(path), 1};
    std::vector<float> numbers;
    const std::string_view text = CleanText(contents.View(), {place.file, 0});
    const char* pos = text.data();
    const char* const end = pos + text.size();
    Separators separators;
    while (pos < end) {
        if (*pos == '#') {
            pos = std::find_if(pos, end, [](char c) { return c == '\n' || c == '\r'; });
        } else if (IsSeparator(*pos)) {
            const char c = *pos++;
            if (c == '\n' || (c == '\r' && (pos == end || *pos != '\n'))) ++place.line;
        } else {
            const char* const stop =
                std::find_if(pos, end, [](char c) { return IsSeparator(c) || c == '#'; });
            const char* const begin = *pos == '+' ? pos + 1 : pos;
            double exact = 0;  // of which a float may be too small for more than 0
            const auto [parsed, status] = std::from_chars(begin, stop, exact);
            const auto value = float(exact);
            if (status != std::errc() || parsed != stop || !std::isfinite(value))
                throw Error(place, "'" + Printable({pos, size_t(stop - pos)}) + "' in a " + kind +
                                       " file is not a number");
            numbers.push_back(value);
            pos = stop;
            const char* const next = std::find_if_not(pos, end, IsSeparator);
            if (next < end && *next != '#')
                separators.Add({pos, size_t(next - pos)}, place);
            else
                separators = {};
        }
    }
    return numbers;
}

float RaisedToZero(float x) { return float(NotNegative(double(x)).value_or(double(x))); }

float GetNonnegative(const Entity& entity, const std::string& name, float otherwise) {
    const float value = RaisedToZero(entity.parameters.GetFloat(name, otherwise));
    if (!(value >= 0) || !std::isfinite(value))
        throw Error(entity.loc, "\"{}\" is {}; it has to be at least 0", name, value);
    return value;
}

}  // namespace lull
