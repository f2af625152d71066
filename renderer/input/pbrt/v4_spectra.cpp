// Turns pbrt-v4's spectra into linear sRGB.
#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "renderer/base/math.h"
#include "renderer/input/pbrt/v4.h"
#include "renderer/input/spectrum.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Relative power of CIE standard illuminant D65 from 360 nm, a value for each 10 nm.
constexpr std::array<float, 48> kD65 = {
    46.6383f, 52.0891f, 49.9755f, 54.6482f, 82.7549f, 91.486f,  93.4318f, 86.6823f,
    104.865f, 117.008f, 117.812f, 114.861f, 115.923f, 108.811f, 109.354f, 107.802f,
    104.79f,  107.689f, 104.405f, 104.046f, 100,      96.3342f, 95.788f,  88.6856f,
    90.0062f, 89.5991f, 87.6987f, 83.2886f, 83.6992f, 80.0268f, 80.2146f, 82.2778f,
    78.2842f, 69.7213f, 71.6091f, 74.349f,  61.604f,  69.8856f, 75.087f,  63.5927f,
    46.4182f, 66.8054f, 63.3828f, 64.304f,  59.4519f, 51.959f,  57.4406f, 60.3125f};

double D65At(int wavelength) {
    const int i = (wavelength - kCieFirst) / 10, rest = (wavelength - kCieFirst) % 10;
    const double next = kD65[std::min<size_t>(size_t(i) + 1, kD65.size() - 1)];
    return kD65[size_t(i)] + 0.1 * rest * (next - kD65[size_t(i)]);
}

// Colours of pbrt-v4's named lights, of luminance 1.
struct NamedColor {
    std::string_view name;
    std::array<float, 3> rgb;
};
constexpr NamedColor kLights[] = {
    {"stdillum-A", {1.84504f, 0.82607f, 0.23337f}},
    {"stdillum-D50", {1.08658f, 0.99951f, 0.74971f}},
    {"stdillum-D65", {1, 1, 1}},
    {"illum-acesD60", {1.04691f, 0.99457f, 0.91553f}},
    {"stdillum-F1", {0.95426f, 1.01929f, 0.94367f}},
    {"stdillum-F2", {1.34006f, 0.94299f, 0.56285f}},
    {"stdillum-F3", {1.57639f, 0.89107f, 0.38089f}},
    {"stdillum-F4", {1.80626f, 0.83420f, 0.26707f}},
    {"stdillum-F5", {0.91539f, 1.03623f, 0.89032f}},
    {"stdillum-F6", {1.31608f, 0.95783f, 0.48650f}},
    {"stdillum-F7", {1.00031f, 1.00017f, 0.99740f}},
    {"stdillum-F8", {1.17666f, 0.97572f, 0.72009f}},
    {"stdillum-F9", {1.37682f, 0.93140f, 0.56935f}},
    {"stdillum-F10", {1.17755f, 0.97562f, 0.71836f}},
    {"stdillum-F11", {1.41209f, 0.92473f, 0.53156f}},
    {"stdillum-F12", {1.76843f, 0.84507f, 0.27085f}},
};

// Its metals, by name "metal-NAME-eta" and "metal-NAME-k".
struct NamedMetal {
    std::string_view name;
    std::array<float, 3> eta, k;
};
constexpr NamedMetal kMetals[] = {
    {"Ag", {0.12847f, 0.12353f, 0.15089f}, {4.09434f, 3.32758f, 2.40870f}},
    {"Al", {1.40742f, 0.92665f, 0.58404f}, {7.68387f, 6.59608f, 5.33041f}},
    {"Au", {0.08005f, 0.40465f, 1.56135f}, {5.55461f, 2.33821f, 1.71789f}},
    {"Cu", {0.10449f, 0.97817f, 1.20467f}, {2.85204f, 2.62355f, 2.36074f}},
    {"CuZn", {0.41844f, 0.51992f, 1.12314f}, {4.06367f, 2.65864f, 1.80998f}},
    {"MgO", {1.73372f, 1.74094f, 1.75355f}, {0, 0, 0}},
    {"TiO2", {2.86038f, 2.95649f, 3.18554f}, {0.00161f, 0.03366f, 0.02245f}},
};

// Its glasses at 587.6 nm. It has the tables of SF5, SF10 and SF11 under the names of F5, F10 and
// F11; scenes have both.
struct NamedGlass {
    std::string_view name;
    float index;
};
constexpr NamedGlass kGlasses[] = {
    {"glass-BK7", 1.51680f},   {"glass-BAF10", 1.67000f}, {"glass-FK51A", 1.48656f},
    {"glass-LASF9", 1.85027f}, {"glass-F5", 1.67272f},    {"glass-SF5", 1.67272f},
    {"glass-F10", 1.72828f},   {"glass-SF10", 1.72828f},  {"glass-F11", 1.78474f},
    {"glass-SF11", 1.78474f},
};

Rgb ToRgb(const std::array<float, 3>& c) { return {c[0], c[1], c[2]}; }

template <typename Table>
auto* FindNamed(const Table& table, std::string_view name) {
    for (const auto& entry : table)
        if (entry.name == name) return &entry;
    return static_cast<decltype(&table[0])>(nullptr);
}

std::optional<Rgb> FindMetal(std::string_view name) {
    if (!name.starts_with("metal-")) return {};
    const size_t end = name.rfind('-');
    if (end < 6) return {};
    const NamedMetal* metal = FindNamed(kMetals, name.substr(6, end - 6));
    const std::string_view part = name.substr(end + 1);
    if (!metal || (part != "eta" && part != "k")) return {};
    return ToRgb(part == "eta" ? metal->eta : metal->k);
}

[[noreturn]] void FailNamed(const std::string& name, const char* wanted, const FileLoc& loc) {
    throw Error(loc, "the spectrum \"{}\" is none of {}", Printable(name), wanted);
}

// Returns XYZ of a spectrum under `light`, Y of a constant 1 being 1.
template <typename Spectrum, typename Light>
Eigen::Vector3d Xyz(const Spectrum& spectrum, const Light& light) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double white = 0;
    for (int i = 0; i < kCieRows; ++i) {
        const double power = light(kCieFirst + i);
        const double value = power * spectrum(double(kCieFirst + i));
        sum += value * Eigen::Vector3d(kCieX[i], kCieY[i], kCieZ[i]);
        white += power * double(kCieY[i]);
    }
    return sum / white;
}

template <typename Spectrum>
Rgb SurfaceColor(const Spectrum& spectrum) {
    // A constant stays grey, though the white of the table is not quite that of the matrix.
    const auto rgb = [](const Eigen::Vector3d& xyz) { return RgbFromXyz(xyz[0], xyz[1], xyz[2]); };
    return rgb(Xyz(spectrum, D65At)) / rgb(Xyz([](double) { return 1.; }, D65At));
}

}  // namespace

double SampledSpectrum::At(double wavelength) const {
    const auto after = std::ranges::upper_bound(samples, float(wavelength), {},
                                                [](const Vec2f& s) { return s.x(); });
    if (after == samples.begin()) return 0;
    const Vec2f& a = *(after - 1);
    if (after == samples.end()) return wavelength > double(a.x()) ? 0 : double(a.y());
    const double t = (wavelength - double(a.x())) / (double(after->x()) - double(a.x()));
    return (1 - t) * double(a.y()) + t * double(after->y());
}

SampledSpectrum SampledSpectrumOf(std::span<const float> pairs, const FileLoc& loc) {
    if (pairs.empty() || pairs.size() % 2 != 0)
        throw Error(loc, "a spectrum needs pairs of wavelength and value, but there are " +
                             std::to_string(pairs.size()) + " numbers");
    SampledSpectrum spectrum;
    for (size_t i = 0; i < pairs.size(); i += 2) {
        if (i > 0 && !(pairs[i] > pairs[i - 2]))
            throw Error(loc, "the wavelengths of a spectrum have to rise");
        spectrum.samples.emplace_back(pairs[i], pairs[i + 1]);
    }
    return spectrum;
}

bool IsNamedSpectrum(const std::string& name) {
    return FindNamed(kLights, name) || FindNamed(kGlasses, name) || FindMetal(name);
}

Rgb RgbOfLight(const V4Spectrum& spectrum, const FileLoc& loc) {
    if (const Rgb* rgb = std::get_if<Rgb>(&spectrum)) return *rgb;
    if (const auto* named = std::get_if<NamedSpectrum>(&spectrum)) {
        if (const NamedColor* light = FindNamed(kLights, named->name)) return ToRgb(light->rgb);
        FailNamed(named->name, "a light", loc);
    }
    Rgb rgb;
    if (const auto* sampled = std::get_if<SampledSpectrum>(&spectrum)) {
        const Eigen::Vector3d xyz =
            Xyz([&](double nm) { return sampled->At(nm); }, [](int) { return 1.; });
        if (!(xyz.y() > 0)) return Rgb::Zero();
        rgb = RgbFromXyz(xyz.x() / xyz.y(), 1, xyz.z() / xyz.y());
    } else {
        rgb = RgbFromBlackbody(double(std::get<BlackbodySpectrum>(spectrum).kelvin), loc);
        rgb /= Luminance(rgb);
    }
    return rgb.max(0.f);
}

Rgb RgbOfSurface(const V4Spectrum& spectrum, const FileLoc& loc) {
    if (const Rgb* rgb = std::get_if<Rgb>(&spectrum)) return *rgb;
    if (const auto* sampled = std::get_if<SampledSpectrum>(&spectrum))
        return SurfaceColor([&](double nm) { return sampled->At(nm); });
    if (const auto* named = std::get_if<NamedSpectrum>(&spectrum)) {
        if (const auto metal = FindMetal(named->name)) return *metal;
        FailNamed(named->name, "a surface", loc);
    }
    const double kelvin = double(std::get<BlackbodySpectrum>(spectrum).kelvin);
    if (!(kelvin > 0)) throw Error(loc, "a black body needs a temperature above 0 K");
    const double most = Planck(2.8977721e-3 / kelvin, kelvin);
    return SurfaceColor([&](double nm) { return Planck(nm * 1e-9, kelvin) / most; });
}

float IndexOf(const V4Spectrum& spectrum, const FileLoc& loc) {
    constexpr double kYellow = 587.6;
    if (const auto* named = std::get_if<NamedSpectrum>(&spectrum)) {
        if (const NamedGlass* glass = FindNamed(kGlasses, named->name)) return glass->index;
        if (const auto metal = FindMetal(named->name)) return metal->mean();
        FailNamed(named->name, "a glass", loc);
    }
    if (const auto* sampled = std::get_if<SampledSpectrum>(&spectrum))
        return float(sampled->At(kYellow));
    return RgbOfSurface(spectrum, loc).mean();
}

std::pair<Rgb, Rgb> RgbOfConductor(const V4Spectrum& eta, const V4Spectrum& k, const FileLoc& loc) {
    const auto* sampledEta = std::get_if<SampledSpectrum>(&eta);
    const auto* sampledK = std::get_if<SampledSpectrum>(&k);
    if (!sampledEta || !sampledK) return {RgbOfSurface(eta, loc), RgbOfSurface(k, loc)};
    const Rgb n = SurfaceColor([&](double nm) { return sampledEta->At(nm); }).max(1e-3f);
    const Rgb reflectance = SurfaceColor([&](double nm) {
                                const double a = sampledEta->At(nm), b = sampledK->At(nm);
                                return (Sqr(a - 1) + Sqr(b)) / (Sqr(a + 1) + Sqr(b));
                            }).min(0.9999f);
    const Rgb k2 = (reflectance * (n + 1).square() - (n - 1).square()) / (1 - reflectance);
    return {n, k2.max(0.f).sqrt()};
}

Mat3f RgbFromColorSpace(const std::string& name, const FileLoc& loc) {
    struct Primaries {
        std::string_view name;
        double x[4], y[4];  // of red, green, blue and white
    };
    constexpr Primaries kSpaces[] = {
        {"srgb", {.64, .3, .15, .3127}, {.33, .6, .06, .329}},
        {"rec2020", {.708, .17, .131, .3127}, {.292, .797, .046, .329}},
        {"dci-p3", {.68, .265, .15, .3127}, {.32, .69, .06, .329}},
        {"aces2065-1", {.7347, 0, .0001, .32168}, {.2653, 1, -.077, .33767}},
    };
    const Primaries* space = FindNamed(kSpaces, name);
    if (!space)
        throw Error(loc, "ColorSpace \"" + Printable(name) +
                             "\" is unknown; srgb, rec2020, dci-p3 and aces2065-1 are");
    const auto toXyz = [](const Primaries& p) {
        const auto column = [&](int i) {
            return Eigen::Vector3d(p.x[i] / p.y[i], 1, (1 - p.x[i] - p.y[i]) / p.y[i]);
        };
        Eigen::Matrix3d m;
        // Green of ACES lies at x = 0; blue below the axis: no y is 0.
        m << column(0), column(1), column(2);
        const Eigen::Vector3d scale = m.inverse() * column(3);
        return Eigen::Matrix3d(m * scale.asDiagonal());
    };
    if (name == "srgb") return Mat3f::Identity();
    return (toXyz(kSpaces[0]).inverse() * toXyz(*space)).cast<float>();
}

Mat3f WhiteBalance(float kelvin) {
    Eigen::Matrix3d rgbFromXyz;
    for (int i = 0; i < 3; ++i)
        rgbFromXyz.col(i) = RgbFromXyz(i == 0, i == 1, i == 2).matrix().cast<double>();
    const Eigen::Matrix3d xyzFromRgb = rgbFromXyz.inverse();
    // The second radiation constant was 1.4380 when the daylight's formula was made.
    const double t = double(kelvin) * 1.4388 / 1.4380;
    Eigen::Vector3d white;
    if (t < 4000) {
        white = xyzFromRgb * RgbFromBlackbody(t).matrix().cast<double>();
        white /= white.y();
    } else {
        // Chromaticity of daylight (CIE 15).
        const double x = t <= 7000 ? ((-4.607e9 / t + 2.9678e6) / t + .09911e3) / t + .244063
                                   : ((-2.0064e9 / t + 1.9018e6) / t + .24748e3) / t + .23704;
        const double y = (-3 * x + 2.87) * x - .275;
        white = Eigen::Vector3d(x / y, 1, (1 - x - y) / y);
    }
    Eigen::Matrix3d bradford;
    bradford << .8951, .2664, -.1614, -.7502, 1.7135, .0367, .0389, -.0685, 1.0296;
    const Eigen::Vector3d from = bradford * white;
    const Eigen::Vector3d to = bradford * xyzFromRgb * Eigen::Vector3d::Ones();
    const Eigen::Matrix3d adapt =
        bradford.inverse() * Eigen::Vector3d(to.cwiseQuotient(from)).asDiagonal() * bradford;
    return (rgbFromXyz * adapt * xyzFromRgb).cast<float>();
}

}  // namespace lull
