#include "renderer/scene/materials/subsurface.h"

#include <fmt/format.h>

#include "renderer/base/math.h"
#include "renderer/bsdf/subsurface.h"
#include "renderer/input/spectrum.h"
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

}  // namespace lull
