#include "renderer/scene/materials/subsurface.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "renderer/base/math.h"
#include "renderer/bsdf/subsurface.h"
#include "renderer/files/file_io.h"
#include "renderer/input/spectrum.h"
#include "renderer/scene/materials/basic.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr float kMostEta = 4, kMostG = 0.99f;

// Returns x, clamped to a range by no more than rounding could have taken it outside.
float WithinRounding(float x, float least, float most) {
    const double exact(x);
    return float(InRange(exact, double(least), double(most)).value_or(exact));
}

bool IsTabulated(float eta, float g) {
    return eta >= 1 && eta <= kMostEta && std::abs(g) <= kMostG;
}

float MeanCosine(const MaterialReader& in, const MediumPreset& preset) {
    const float g = in.entity.parameters.GetFloat("g", 0);
    return preset.isMeasured ? 0 : g;
}

}  // namespace

TranslucentSolid::TranslucentSolid(const MaterialReader& in, float g)
    : kr(in.ShareOfColors("Kr", 1)),
      kt(in.ShareOfColors("Kt", 1)),
      roughness(in, in.Float("uroughness", 0), in.Float("vroughness", 0)),
      eta(WithinRounding(in.entity.parameters.GetFloat("eta", 1.33f), 1, kMostEta)),
      g(WithinRounding(g, -kMostG, kMostG)),
      scale(RaisedToZero(in.entity.parameters.GetFloat("scale", 1))) {
    if (IsTabulated(eta, this->g)) table = std::make_shared<const DiffusionTable>(this->g, eta);
}

std::string TranslucentSolid::Problem(const MaterialReader& in) const {
    if (!IsTabulated(eta, g))
        return fmt::format(
            "\"eta\" of material \"{}\" has to lie between 1 and {}, \"g\" between "
            "-{} and {}; they are {} and {}",
            in.entity.name, kMostEta, kMostG, kMostG, eta, g);
    if (!(scale >= 0 && scale < kInfinity))
        return fmt::format("\"scale\" of material \"{}\" is {}; it cannot be negative",
                           in.entity.name, scale);
    return {};
}

void TranslucentSolid::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    AddDielectric(in.Color(kr), in.Color(kt), eta, roughness, in, bsdf);
}

Subsurface::Subsurface(const MaterialReader& in)
    : Subsurface(in, ReadMediumPreset(in.entity.parameters.GetString("name", ""), in.entity.loc,
                                      in.warnings)) {}

Subsurface::Subsurface(const MaterialReader& in, const MediumPreset& preset)
    : TranslucentSolid(in, MeanCosine(in, preset)),
      sigmaA(in.textures.GetSpectrum(in.entity, "sigma_a", preset.sigmaA)),
      sigmaS(in.textures.GetSpectrum(in.entity, "sigma_s", preset.sigmaS)) {}

std::optional<SubsurfaceProfile> Subsurface::Profile(const MaterialInputs& in) const {
    return SubsurfaceProfile{
        DiffusionProfile(*table, scale * in.Color(sigmaA), scale * in.Color(sigmaS)), eta};
}

KdSubsurface::KdSubsurface(const MaterialReader& in)
    : TranslucentSolid(in, in.entity.parameters.GetFloat("g", 0)),
      kd(in.ShareOfColors("Kd", 0.5f)),
      meanFreePath(in.Spectrum("mfp", 1)) {}

std::optional<SubsurfaceProfile> KdSubsurface::Profile(const MaterialInputs& in) const {
    // Less than that float could not square the inverse of.
    constexpr float kLeastPath = 1e-15f;
    const Rgb sigmaT = 1 / (scale * in.Color(meanFreePath)).max(kLeastPath);
    const Rgb effective = in.Color(kd);
    Rgb albedo;
    for (int c = 0; c < 3; ++c) albedo[c] = AlbedoOfScattering(*table, effective[c]);
    return SubsurfaceProfile{DiffusionProfile(*table, (1 - albedo) * sigmaT, albedo * sigmaT), eta};
}

MediumPreset ReadMediumPreset(const std::string& name, const FileLoc& loc, Warnings& warnings) {
    MediumPreset preset{{0.0011f, 0.0024f, 0.014f}, {2.55f, 3.21f, 3.77f}};
    preset.isMeasured = FindMediumPreset(name, &preset.sigmaA, &preset.sigmaS);
    if (!preset.isMeasured && !name.empty())
        warnings.Add(loc, "unknown medium preset, pbrt-v3's default is used", Printable(name));
    return preset;
}

namespace {

class Cursor {
  public:
    Cursor(std::string_view rest, const std::string& path) : rest(rest), path(path) {}

    template <typename T>
    std::vector<T> Take(size_t count) {
        static_assert(sizeof(T) == 4 && std::endian::native == std::endian::little);
        if (count > rest.size() / 4) Fail("is cut short");
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), rest.data(), 4 * count);
        rest.remove_prefix(4 * count);
        return values;
    }
    int TakeInt() { return Take<int32_t>(1)[0]; }
    void TakeMagic(std::string_view magic) {
        if (!rest.starts_with(magic)) Fail("is not a .bsdf file of version 1");
        rest.remove_prefix(magic.size());
    }
    [[noreturn]] void Fail(const std::string& what) const { throw Error("'{}' {}", path, what); }

  private:
    std::string_view rest;
    const std::string& path;
};

void CheckFinite(const std::vector<float>& values, const Cursor& in) {
    for (const float v : values)
        if (!std::isfinite(v)) in.Fail("holds a number that is not finite");
}

}  // namespace

FourierTable LoadFourierTable(const std::string& path) {
    const FileContents file = ReadFile(path);
    Cursor in(file.View(), path);
    in.TakeMagic(std::string_view("SCATFUN\x01", 8));
    const int flags = in.TakeInt(), nodes = in.TakeInt(), coefficients = in.TakeInt();
    const int order = in.TakeInt(), channels = in.TakeInt(), bases = in.TakeInt();
    in.Take<int32_t>(3);  // metadata and textured parameters, which follow the rest
    FourierTable table;
    table.eta = in.Take<float>(1)[0];
    in.Take<int32_t>(4);
    if (flags != 1 || bases != 1 || (channels != 1 && channels != 3))
        in.Fail(
            "uses extrapolation, textures or other than 1 or 3 channels, which are not supported");
    constexpr int kMaxNodes = 1 << 14;
    if (nodes < 2 || nodes > kMaxNodes || coefficients < 0)
        in.Fail(fmt::format("has {} nodes and {} coefficients", nodes, coefficients));
    if (order < 0 || order > FourierTable::kMaxOrder)
        in.Fail(fmt::format("has series of order {}; up to {} are modelled", order,
                            FourierTable::kMaxOrder));
    if (!(table.eta > 0) || !std::isfinite(table.eta)) in.Fail("has no index of refraction");
    table.channels = channels;
    const size_t entries = size_t(nodes) * nodes;
    table.mu = in.Take<float>(nodes);
    table.cdf = in.Take<float>(entries);
    const std::vector<int32_t> places = in.Take<int32_t>(2 * entries);
    table.coefficients = in.Take<float>(coefficients);
    for (const auto* values : {&table.mu, &table.cdf, &table.coefficients})
        CheckFinite(*values, in);
    // Files hold the node of the horizon twice: seen from above, and from below.
    for (int i = 1; i < nodes; ++i) {
        const bool isEnd = i == 1 || i == nodes - 1;
        if (table.mu[i] < table.mu[i - 1] || (isEnd && table.mu[i] == table.mu[i - 1]))
            in.Fail("has nodes that do not ascend");
    }
    table.series.resize(entries);
    for (size_t e = 0; e < entries; ++e) {
        const int first = places[2 * e], length = places[2 * e + 1];
        if (length < 0 || length > order || first < 0 ||
            int64_t(first) + int64_t(length) * channels > coefficients)
            in.Fail(fmt::format("has a series of {} coefficients at {} of {}", length, first,
                                coefficients));
        table.series[e] = {first, length};
    }
    return table;
}

Fourier::Fourier(const MaterialReader& in) {
    const std::string file = in.entity.parameters.GetString("bsdffile", "");
    if (file.empty()) {
        problem = "a fourier material needs a \"bsdffile\"";
        return;
    }
    try {
        table = std::make_shared<const FourierTable>(
            LoadFourierTable(ResolvePath(in.description, file)));
    } catch (const Error& error) {
        problem = error.what();
    }
}

void Fourier::AddLobes(const MaterialInputs&, Bsdf* bsdf) const {
    bsdf->Add(FourierLobe{Rgb(1, 1, 1), table.get()});
}

}  // namespace lull
