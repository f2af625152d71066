#include "renderer/scene/lights/infinite.h"

#include "renderer/base/color.h"
#include "renderer/output/image_io.h"

namespace lull {
namespace {

// Returns latitude-longitude coordinates of a unit vector of light space, each in [0, 1].
Vec2f CoordinatesOf(const Vec3f& w) {
    const float phi = std::atan2(w.y(), w.x());
    return {(phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi),
            std::acos(std::clamp(w.z(), -1.f, 1.f)) / kPi};
}

std::vector<Rgb> TexelsOf(const Image& image) {
    std::vector<Rgb> texels(size_t(image.width) * image.height);
    const bool isGrey = image.channels < 3;
    std::visit(
        [&](const auto& values) {
            using T = std::decay_t<decltype(values[0])>;
            // As in pbrt-v3, 8-bit environment maps are taken as linear.
            const float scale = std::is_same_v<T, uint8_t> ? 1 / 255.f : 1.f;
            for (size_t i = 0; i < texels.size(); ++i)
                for (int c = 0; c < 3; ++c)
                    texels[i][c] = scale * float(values[i * image.channels + (isGrey ? 0 : c)]);
        },
        image.texels);
    return texels;
}

}  // namespace

InfiniteLight InfiniteLight::Make(const Description& description, const LightEntity& entity,
                                  float worldRadius, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    InfiniteLight light;
    light.worldRadius = worldRadius;
    light.worldFromLight = entity.worldFromLight.topLeftCorner<3, 3>().cast<float>();
    light.lightFromWorld = entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>();
    const Rgb L = params.GetSpectrum("L", Rgb::Ones()) * params.GetSpectrum("scale", Rgb::Ones());
    const std::string file = params.GetString("mapname", "");
    light.texels = {Rgb::Ones()};
    if (!file.empty()) {
        try {
            const Image image = ReadImage(ResolvePath(description, file));
            light.width = image.width;
            light.height = image.height;
            light.texels = TexelsOf(image);
        } catch (const Error& error) {
            throw Error(entity.loc, error.what());
        }
    }
    for (Rgb& texel : light.texels) {
        texel *= L;
        if (!IsFinite(texel) || texel.minCoeff() < 0) {
            texel = Rgb::Zero();
            warnings.Add(entity.loc, "environment map texel that is not finite or negative", file);
        }
    }

    // Tabulate the brightness at twice the resolution, so that the interpolation between texels
    // is followed too, weighted by the solid angle of a row.
    const int nu = 2 * light.width, nv = 2 * light.height;
    std::vector<float> brightness(size_t(nu) * nv);
    for (int v = 0; v < nv; ++v) {
        const float sinTheta = std::sin(kPi * (v + 0.5f) / nv);
        for (int u = 0; u < nu; ++u)
            brightness[size_t(v) * nu + u] =
                sinTheta * Luminance(light.Lookup(Vec2f((u + 0.5f) / nu, (v + 0.5f) / nv)));
    }
    light.distribution = Distribution2D(brightness, nu, nv);
    return light;
}

// Interpolates bilinearly; wraps around both axes, as pbrt-v3 does.
Rgb InfiniteLight::Lookup(const Vec2f& st) const {
    if (texels.size() == 1) return texels[0];
    const float x = st.x() * width - 0.5f, y = st.y() * height - 0.5f;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const float dx = x - x0, dy = y - y0;
    const auto texel = [&](int i, int j) -> const Rgb& {
        i = i < 0 ? i + width : i >= width ? i - width : i;
        j = j < 0 ? j + height : j >= height ? j - height : j;
        return texels[size_t(j) * width + i];
    };
    return (1 - dy) * ((1 - dx) * texel(x0, y0) + dx * texel(x0 + 1, y0)) +
           dy * ((1 - dx) * texel(x0, y0 + 1) + dx * texel(x0 + 1, y0 + 1));
}

Rgb InfiniteLight::Le(const Vec3f& w) const {
    if (texels.size() == 1) return texels[0];
    return Lookup(CoordinatesOf((lightFromWorld * w).normalized()));
}

std::optional<LightSample> InfiniteLight::Sample(const Vec3f& from, const Vec2f& u) const {
    float mapPdf;
    const Vec2f st = distribution.SampleContinuous(u, &mapPdf);
    const float theta = st.y() * kPi, phi = st.x() * 2 * kPi;
    const float sinTheta = std::sin(theta);
    const float pdf = mapPdf / (2 * kPi * kPi * sinTheta);
    if (!(pdf > 0) || !std::isfinite(pdf)) return {};
    const Vec3f local(sinTheta * std::cos(phi), sinTheta * std::sin(phi), std::cos(theta));
    const Vec3f wi = (worldFromLight * local).normalized();
    return LightSample{.L = Lookup(st),
                       .wi = wi,
                       .pdf = pdf,
                       .isDelta = false,
                       .isHidden = false,
                       .p = from + wi * (2 * worldRadius)};
}

float InfiniteLight::Pdf(const Vec3f& w) const {
    const Vec3f local = (lightFromWorld * w).normalized();
    const float sinTheta = SafeSqrt(1 - Sqr(local.z()));
    if (sinTheta == 0) return 0;
    return distribution.Pdf(CoordinatesOf(local)) / (2 * kPi * kPi * sinTheta);
}

Rgb InfiniteLight::Power() const {
    // Only the choice of lights by power asks for this; the mean over the map is what pbrt-v3's
    // topmost mip level holds.
    Rgb sum = Rgb::Zero();
    for (const Rgb& texel : texels) sum += texel;
    return kPi * Sqr(worldRadius) * sum / float(texels.size());
}

}  // namespace lull
