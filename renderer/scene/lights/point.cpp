#include "renderer/scene/lights/point.h"

#include <fmt/format.h>

#include <numbers>

#include "renderer/base/math.h"
#include "renderer/base/sampling.h"
#include "renderer/image/image_io.h"
#include "renderer/scene/lights/light_sample.h"
#include "renderer/scene/textures/imagemap.h"

namespace lull {

Rgb LightImage::Lookup(const Vec2f& st) const { return BilinearRgb(image, st, wrapS, wrapT); }

std::shared_ptr<const LightImage> ReadLightImage(const LightReader& in, bool isRound) {
    const std::string file = in.entity.parameters.GetString("mapname", "");
    if (file.empty()) return nullptr;
    auto made = std::make_shared<LightImage>();
    if (in.isCompensated) made->wrapT = Wrap::Clamp;
    if (in.isCompensated && !isRound) made->wrapS = Wrap::Clamp;
    try {
        made->image = ReadImage(ResolvePath(in.description, file));
        if (in.entity.parameters.GetBool("decode", false)) DecodeBytes(&made->image);
    } catch (const Error& error) {
        in.warnings.Substitute(in.entity.loc, error.what(), "white stands in");
        return nullptr;
    }
    std::visit(
        [&](auto& texels) {
            using T = std::decay_t<decltype(texels[0])>;
            for (T& texel : texels) {
                if (float(texel) >= 0 && std::isfinite(float(texel))) continue;
                texel = T();
                in.warnings.Add(in.entity.loc, "light map texel that is not finite or negative",
                                file);
            }
        },
        made->image.texels);
    made->mean = MeanTexel(made->image);
    return made;
}

SpotCone SpotCone::Make(const Entity& entity, const Mat4d& worldFromLight) {
    const Parameters& params = entity.parameters;
    const float cone = params.GetFloat("coneangle", 30);
    const float delta = params.GetFloat("conedeltaangle", 5);
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Vec3f to = params.GetPoint3("to", Vec3f(0, 0, 1));
    const Vec3f axis = TransformVector(worldFromLight, (to - from).normalized());
    if (!(axis.norm() > 0))
        throw Error(entity.loc, "the spot light's \"from\" and \"to\" coincide");
    const Shape shape = entity.name == "spot-squared"  ? Shape::Square
                        : entity.name == "spot-smooth" ? Shape::SmoothStep
                                                       : Shape::FourthPower;
    return {axis.normalized(), std::cos(cone * kPi / 180), std::cos((cone - delta) * kPi / 180),
            shape};
}

void SpotCone::Bound(LightBounds* bounds) const {
    const float start = std::acos(std::clamp(cosFalloffStart, -1.f, 1.f));
    const float total = std::acos(std::clamp(cosTotalWidth, -1.f, 1.f));
    bounds->axis = axis;
    bounds->cosNormals = std::cos(std::clamp(start, 0.f, total));
    bounds->cosEmission = std::cos(std::clamp(total - start, 0.f, total) + 1e-3f);
}

Spread Spread::Make(double degrees) {
    constexpr double kLeast = 1e-3;  // below, directions of float are too coarse
    const double h = std::max(degrees * std::numbers::pi / 360, kLeast), tangent = std::tan(h);
    return {float(tangent), float(std::sin(h)), float(std::cos(std::min(h + 1e-3, 1.5707963))),
            float(1 / (tangent - h))};
}

float PowerFraction(const EmissionProfile& profile) {
    if (const auto* coat = std::get_if<BelowCoat>(&profile))
        return 1 - coat->weight * (0.04f + 0.96f / 21);
    const auto* cone = std::get_if<SpotCone>(&profile);
    return cone ? cone->SolidAngle() / (4 * kPi) : 1;
}

namespace {

// Returns the sample of a light at p; radiance(wi, distance2) returns nothing where it is dark.
template <typename F>
std::optional<LightSample> SampleFrom(const Vec3f& p, const Vec3f& from, const F& radiance) {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return {};
    const Vec3f wi = d / std::sqrt(distance2);
    const std::optional<Rgb> L = radiance(wi, distance2);
    if (!L || !IsFinite(*L)) return {};
    return LightSample{.L = *L, .wi = wi, .isDelta = true, .p = p};
}

float FactorOfPower(const Entity& entity, float whole) {
    const float power = entity.parameters.GetFloat("power", -1);
    return power > 0 && whole > 0 ? power / whole : 1;
}

float WholePower(const ProjectionLight& light) {
    const Image& image = light.image->image;
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Vec2f st((float(x) + 0.5f) / float(image.width),
                           (float(y) + 0.5f) / float(image.height));
            const Vec2f plane =
                (2 * st - Vec2f::Ones()).cwiseProduct(light.screen) / light.perTangent;
            const double cosine = 1 / std::sqrt(1 + double(plane.squaredNorm()));
            sum += double(NearestRgb(image, st).mean()) * cosine * cosine * cosine;
        }
    const Vec2f size = 2 * light.screen / light.perTangent;
    return float(sum) * size.x() * size.y() / (float(image.width) * float(image.height));
}

}  // namespace

PointLight PointLight::Make(const LightReader& in) {
    const Parameters& params = in.entity.parameters;
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Rgb I = LightColor(in.entity, "I", in.warnings);
    return {TransformPoint(in.entity.worldFromLight, from), I};
}

std::optional<LightSample> PointLight::Sample(const Vec3f& from, const Vec2f&) const {
    return SampleFrom(p, from, [&](const Vec3f&, float distance2) -> Rgb { return I / distance2; });
}

SpotLight SpotLight::Make(const LightReader& in) {
    const Vec3f from = in.entity.parameters.GetPoint3("from", Vec3f::Zero());
    const Rgb I = LightColor(in.entity, "I", in.warnings);
    const Mat4d& worldFromLight = in.entity.worldFromLight;
    return {TransformPoint(worldFromLight, from), I, SpotCone::Make(in.entity, worldFromLight)};
}

std::optional<LightSample> SpotLight::Sample(const Vec3f& from, const Vec2f&) const {
    return SampleFrom(p, from, [&](const Vec3f& wi, float distance2) -> std::optional<Rgb> {
        const float falloff = cone.Falloff(-wi);
        if (falloff == 0) return {};
        return I * (falloff / distance2);
    });
}

GoniometricLight GoniometricLight::Make(const LightReader& in) {
    Rgb I = LightColor(in.entity, "I", in.warnings);
    const auto image = ReadLightImage(in, true);
    if (image) I *= FactorOfPower(in.entity, 4 * kPi * image->mean.mean());
    return {TransformPoint(in.entity.worldFromLight, Vec3f::Zero()), I,
            in.entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>(), image,
            in.entity.parameters.GetBool("equalarea", false)};
}

std::optional<LightSample> GoniometricLight::Sample(const Vec3f& from, const Vec2f&) const {
    return SampleFrom(p, from, [&](const Vec3f& wi, float distance2) -> Rgb {
        const Rgb L = I / distance2;
        if (!image) return L;
        const Vec3f w = (lightFromWorld * -wi).normalized();
        if (isEqualArea)
            return L * NearestRgb(image->image, EqualAreaSquareOf({w.x(), w.z(), w.y()})).mean();
        const float phi = std::atan2(w.z(), w.x());
        return L * image->Lookup({(phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi),
                                  std::acos(std::clamp(w.y(), -1.f, 1.f)) * kInvPi});
    });
}

ProjectionLight ProjectionLight::Make(const LightReader& in) {
    const Parameters& params = in.entity.parameters;
    ProjectionLight light;
    light.p = TransformPoint(in.entity.worldFromLight, Vec3f::Zero());
    light.I = LightColor(in.entity, "I", in.warnings);
    light.lightFromWorld = in.entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>();
    const float fov = params.GetFloat("fov", 45);
    const auto known = FieldOfView(double(fov));
    if (!known)
        throw Error(in.entity.loc,
                    "the projection light's \"fov\" is {} degrees; it has to lie between 0 and 180",
                    fov);
    light.perTangent = 1 / std::tan(float(*known) * kPi / 360);
    light.image = ReadLightImage(in, false);
    const float aspect =
        light.image ? float(light.image->image.width) / float(light.image->image.height) : 1;
    light.screen = aspect > 1 ? Vec2f(aspect, 1) : Vec2f(1, 1 / aspect);
    if (light.image) light.I *= FactorOfPower(in.entity, WholePower(light));
    return light;
}

std::optional<LightSample> ProjectionLight::Sample(const Vec3f& from, const Vec2f&) const {
    return SampleFrom(p, from, [&](const Vec3f& wi, float distance2) -> std::optional<Rgb> {
        const Vec3f w = lightFromWorld * -wi;
        constexpr float kHither = 1e-3f;  // pbrt-v3's near plane
        if (!(w.z() >= kHither)) return {};
        const Vec2f q = w.head<2>() * (perTangent / w.z());
        if (!(q.cwiseAbs().array() <= screen.array()).all()) return {};
        const Rgb L = I / distance2;
        return image ? Rgb(L * image->Lookup((q + screen).cwiseQuotient(2 * screen))) : L;
    });
}

Rgb ProjectionLight::Power() const {
    // The cone to the corner of the image, as if that were filled (pbrt-v3).
    const float cosCorner = 1 / std::sqrt(1 + (screen / perTangent).squaredNorm());
    const Rgb mean = image ? image->mean : Rgb(Rgb::Ones());
    return 2 * kPi * (1 - cosCorner) * I * mean;
}

}  // namespace lull
