#include "renderer/scene/lights/infinite.h"

#include "renderer/base/color.h"
#include "renderer/base/rounding.h"
#include "renderer/image/image_io.h"
#include "renderer/scene/lights/light_color.h"
#include "renderer/scene/lights/studio.h"

namespace lull {
namespace {

// Returns latitude-longitude coordinates of a unit vector of light space, each in [0, 1].
Vec2f CoordinatesOf(const Vec3f& w) {
    const float phi = std::atan2(w.y(), w.x());
    return {(phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi),
            std::acos(std::clamp(w.z(), -1.f, 1.f)) / kPi};
}

// Blackens texels that are not finite once multiplied by L, and parts of others that are negative,
// as compression and filters leave them. Returns how many texels that were, for more than rounding.
int Blacken(const Rgb& L, Image* image) {
    int count = 0;
    std::visit(
        [&](auto& texels) {
            using T = std::decay_t<decltype(texels[0])>;
            const int colors = image->channels < 3 ? 1 : 3;
            for (size_t at = 0; at < texels.size(); at += size_t(image->channels)) {
                bool isGood = true, isFinite = true;
                for (int c = 0; c < 3; ++c) {
                    T& texel = texels[at + size_t(c % colors)];
                    const float value = float(texel) * L[c];
                    isGood &= value >= -float(kRounding);
                    isFinite &= std::abs(value) <= EnvironmentMap::kMaxTexel;
                    if (value < 0) texel = T();
                }
                if (!isFinite) std::fill_n(&texels[at], colors, T());
                count += !(isGood && isFinite);
            }
        },
        image->texels);
    return count;
}

}  // namespace

InfiniteLight InfiniteLight::Make(const LightReader& in) {
    const LightEntity& entity = in.entity;
    const Parameters& params = entity.parameters;
    InfiniteLight light;
    light.worldRadius = in.worldRadius;
    light.worldFromLight = entity.worldFromLight.topLeftCorner<3, 3>().cast<float>();
    light.lightFromWorld = entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>();
    // Directions alone are transformed; powers of a large scale would be infinite.
    const Mat3f unit = light.lightFromWorld / light.lightFromWorld.cwiseAbs().maxCoeff();
    if (!ScalesEvenly(unit)) {
        light.lightFromWorld = unit;
        light.stretch = std::abs(unit.determinant());
    }
    const Rgb L = LightColor(entity, "L", in.warnings);
    const std::string file = params.GetString("mapname", "");
    light.constant = L;
    if (params.Find(ParameterType::Point3, "portal"))
        in.warnings.Add(entity.loc, "portals are not used", "the mean of the image is the same");
    if (params.GetBool("studio", false)) {
        light.map = std::make_shared<const EnvironmentMap>(MakeStudio(), L, in.isCompensated);
        return light;
    }
    if (file.empty()) return light;
    try {
        // As in pbrt-v3, 8-bit environment maps are taken as linear.
        Image image = ReadImage(ResolvePath(in.description, file));
        for (int bad = Blacken(L, &image); bad > 0; --bad)
            in.warnings.Add(entity.loc, "environment map texel that is not finite or negative",
                            file);
        light.map = std::make_shared<const EnvironmentMap>(std::move(image), L, in.isCompensated);
    } catch (const Error& error) {
        in.warnings.Substitute(entity.loc, error.what(), "a constant light stands in");
    }
    return light;
}

// A constant light is sampled as pbrt-v3 does, as a map of one texel: evenly in both coordinates.
std::optional<LightSample> InfiniteLight::Sample(const Vec3f&, const Vec2f& u) const {
    float mapPdf = 1;
    const Vec2f st = map ? map->Sample(u, &mapPdf) : u;
    const auto [sinTheta, cosTheta] = SineCosineOfTurn(0.5f * st.y());
    const auto [sinPhi, cosPhi] = SineCosineOfTurn(st.x());
    const Vec3f local(sinTheta * cosPhi, sinTheta * sinPhi, cosTheta);
    const Vec3f wi = (worldFromLight * local).normalized();
    const float pdf = mapPdf / (2 * kPi * kPi * sinTheta) * Stretch(wi);
    if (!(pdf > 0) || !std::isfinite(pdf)) return {};
    if (map) map->Prefetch(st);
    return LightSample{.L = map ? Rgb::Ones() : constant,
                       .wi = wi,
                       .pdf = pdf,
                       .isDelta = false,
                       .isHidden = false,
                       .isOnMap = map != nullptr,
                       .isAtInfinity = true,
                       .p = {st.x(), st.y(), 0}};
}

Emitted InfiniteLight::LeAndPdf(const Vec3f& w) const {
    const Vec3f local = (lightFromWorld * w).normalized();
    const float sinTheta = SafeSqrt(1 - Sqr(local.z()));
    const Vec2f st = map ? CoordinatesOf(local) : Vec2f::Zero();
    const float mapPdf = map ? map->Pdf(st) : 1;
    return {map ? map->Radiance(st) : constant,
            sinTheta > 0 ? mapPdf / (2 * kPi * kPi * sinTheta) * Stretch(w) : 0};
}

float InfiniteLight::Stretch(const Vec3f& w) const {
    if (stretch == 0) return 1;
    const float length = (lightFromWorld * w).norm();
    return stretch / (length * length * length);
}

// Used only by the choice of lights by power; the mean over the map is the topmost mip level of
// pbrt-v3.
Rgb InfiniteLight::Power() const {
    return kPi * Sqr(worldRadius) * (map ? map->MeanTexel() : constant);
}

}  // namespace lull
