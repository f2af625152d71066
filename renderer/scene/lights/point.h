// Lights that have a place: at points, and on shapes.
#pragma once

#include <memory>
#include <variant>

#include "renderer/base/sampling.h"
#include "renderer/base/variant.h"
#include "renderer/bsdf/fresnel.h"
#include "renderer/image/image.h"
#include "renderer/input/description.h"
#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/lights/light_sample.h"
#include "renderer/scene/textures/imagemap.h"

namespace lull {

// The image that shapes the beam of a light.
struct LightImage {
    Image image;
    Rgb mean;                                         // of all texels
    Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;  // pbrt-v3's

    // Returns the texels around st, interpolated. The first row is at st.y() = 0.
    Rgb Lookup(const Vec2f& st) const;
};

// Reads "mapname"; null where there is none. As in pbrt-v3, 8-bit texels are taken as linear,
// unless "decode" says that they are sRGB.
// Texels that are negative or not finite count as black, with a counted warning. Null substitutes
// an image that cannot be read. `isRound`: columns are longitudes, which repeat.
std::shared_ptr<const LightImage> ReadLightImage(const LightReader&, bool isRound);

// Shared data of the triangles of an emitting mesh. The shape and textures are a scene's.
struct EmissionMap {
    const TextureTable* textures;
    const Shape* shape;
    SpectrumTexture emission;  // multiplies the light's L
    bool secondUv = false;
    bool vertexColors = false;  // multiply it, too
    bool cutsOut = false;       // where the shape's alpha is 0, as rays see it

    Rgb At(uint32_t triangle, float b1, float b2) const {
        const Mesh& mesh = *std::get_if<Mesh>(&shape->geometry);
        const Vec2f uv = secondUv ? mesh.Uv1(triangle, b1, b2) : mesh.Uv(triangle, b1, b2);
        Rgb factor = textures->Evaluate(emission, TextureContext{Vec3f::Zero(), uv});
        if (vertexColors) {
            const auto c = mesh.Color(triangle, b1, b2);
            factor *= Rgb(c[0], c[1], c[2]);
        }
        return factor.max(0.f);
    }

    // Returns the same for light sampling, times the probability that a ray hits the surface.
    Rgb Covered(uint32_t triangle, float b1, float b2) const {
        const Rgb e = At(triangle, b1, b2);
        if (cutsOut && IsCutOut(triangle, b1, b2)) return Rgb::Zero();
        if (!shape->coverage) return e;
        return e * CoverageAt(*shape, *textures, Vec3f::Zero(), triangle, b1, b2);
    }

    // Returns it for the point that SampleUniformTriangle(u) is in the triangle as it is sampled.
    Rgb Sampled(uint32_t triangle, const Vec2f& u) const {
        const Vec2f b = SampleUniformTriangle(u);
        return Covered(triangle, b.y(), 1 - b.x() - b.y());
    }

    bool IsCutOut(uint32_t triangle, float b1, float b2) const {
        const Mesh& mesh = *std::get_if<Mesh>(&shape->geometry);
        const auto& p = mesh.corners[triangle].p;
        return textures->Evaluate(*shape->alpha,
                                  TextureContext{(1 - b1 - b2) * p[0] + b1 * p[1] + b2 * p[2],
                                                 mesh.Uv(triangle, b1, b2)}) == 0;
    }

    // Returns the mean over a triangle, from a few points: for the choice of lights only.
    Rgb Mean(uint32_t triangle) const {
        constexpr int kSteps = 4;
        Rgb sum = Rgb::Zero();
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                sum += Sampled(triangle, {(float(i) + 0.5f) / float(kSteps),
                                          (float(j) + 0.5f) / float(kSteps)});
        return sum / float(kSteps * kSteps);
    }
};

// How the light of spots falls off to the sides.
//
// The light is whole up to the angle whose cosine is cosFalloffStart, and falls smoothly to none at
// that of cosTotalWidth: by the fourth power of how far the cosine is from there, as in pbrt-v3, by
// its square, as KHR_lights_punctual proposes ("spot-squared"), or by a cubic step, as in pbrt-v4
// ("spot-smooth").
struct SpotCone {
    enum class Shape { FourthPower, Square, SmoothStep };

    Vec3f axis;  // unit, world
    float cosTotalWidth, cosFalloffStart;
    Shape shape = Shape::FourthPower;

    // Reads "from", "to", "coneangle" and "conedeltaangle", degrees; the entity's name tells the
    // shape. Throws Error where the points are the same.
    static SpotCone Make(const Entity&, const Mat4d& worldFromLight);

    // Returns the fraction of the light that leaves towards w, unit.
    float Falloff(const Vec3f& w) const {
        const float cosTheta = w.dot(axis);
        if (cosTheta < cosTotalWidth) return 0;
        const float x = cosTheta >= cosFalloffStart
                            ? 1.f
                            : (cosTheta - cosTotalWidth) / (cosFalloffStart - cosTotalWidth);
        if (shape == Shape::SmoothStep) return Sqr(x) * (3 - 2 * x);
        return shape == Shape::Square ? Sqr(x) : Sqr(Sqr(x));
    }
    // Returns about how many steradians the whole light would fill, as pbrt-v3 has it.
    float SolidAngle() const { return 2 * kPi * (1 - 0.5f * (cosFalloffStart + cosTotalWidth)); }
    // Sets the directions of a light's bounds: along "normals" up to where it begins to fall off.
    void Bound(LightBounds*) const;
};

// The light of each point leaves within a cone about its normal: the radiance falls with the
// tangent of the angle, to none at the edge, as with the spread of Cycles' area lamps. The power is
// that of the same radiance to all sides, as the integral over the cone of (tan h - tan theta) cos
// theta is pi (tan h - h).
struct Spread {
    float tangent, sine;  // of h, half the angle across the cone
    float cosEmission;    // as in LightBounds
    float scale;          // 1 / (tan h - h)

    // `degrees`, across the cone: above 0, at most 180; below 0.12, as 0.12.
    static Spread Make(double degrees);

    // Returns whether the cone about n, unit, has w, unit, on either side.
    bool Has(const Vec3f& n, const Vec3f& w) const { return n.cross(w).norm() < sine; }
};

// Emission below a clear coat, which reflects the rest back (KHR_materials_clearcoat).
struct BelowCoat {
    float weight;
};

using EmissionProfile = std::variant<SpotCone, Spread, BelowCoat>;

// Return the factor of the radiance from a point with normal n to w, both unit, on n's side.
inline float Falloff(const SpotCone& cone, const Vec3f&, const Vec3f& w) { return cone.Falloff(w); }
inline float Falloff(const Spread& spread, const Vec3f& n, const Vec3f& w) {
    // The cross product keeps small angles, which the cosine rounds away.
    const float tangent = n.cross(w).norm() / std::abs(n.dot(w));
    return spread.scale * std::max(0.f, spread.tangent - tangent);
}
inline float Falloff(const BelowCoat& coat, const Vec3f& n, const Vec3f& w) {
    return 1 - coat.weight * (0.04f + 0.96f * SchlickWeight(std::min(1.f, std::abs(n.dot(w)))));
}
inline float Falloff(const EmissionProfile& profile, const Vec3f& n, const Vec3f& w) {
    return Visit(profile, [&](const auto& p) { return Falloff(p, n, w); });
}

// Returns the power as a fraction of that of the whole radiance to all sides of the normals.
float PowerFraction(const EmissionProfile& profile);

// Emits I, W/sr, equally in all directions from one point.
struct PointLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;

    static PointLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Rgb Power() const { return 4 * kPi * I; }
};

// Emits I, W/sr, along the axis of a cone from one point.
struct SpotLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;
    SpotCone cone;

    static SpotLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    // Within the cone the light is taken as bright as a point light of this intensity.
    LightBounds Bounds() const {
        LightBounds bounds{.box = {p, p}, .power = BoundedPower(4 * kPi * I)};
        cone.Bound(&bounds);
        return bounds;
    }
    Rgb Power() const { return cone.SolidAngle() * I; }
};

// Emits from one point by an image in latitude-longitude form, or of equal areas, as in pbrt-v4,
// about the y axis of the light's space: I times its texels, W/sr (pbrt 3rd ed., 12.3.3).
struct GoniometricLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;
    Mat3f lightFromWorld;
    std::shared_ptr<const LightImage> image;  // null: I in all directions
    bool isEqualArea = false;

    // Throws Error if the image cannot be read.
    static GoniometricLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Rgb Power() const { return image ? Rgb(4 * kPi * I * image->mean) : Rgb(4 * kPi * I); }
};

// Projects an image from one point along z of the light's space: I times its texels, W/sr (pbrt
// 3rd ed., 12.3.2). The field of view is across the image's shorter side; its first row is at the
// lowest y.
struct ProjectionLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;
    Mat3f lightFromWorld;
    Vec2f screen;      // half the size of the image on the plane at distance 1, times perTangent
    float perTangent;  // 1 / tan(fov / 2)
    std::shared_ptr<const LightImage> image;  // null: white

    // Throws Error for a field of view outside (0, 180) or an image that cannot be read.
    static ProjectionLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Rgb Power() const;
};

// Emits L from one primitive of a shape, on the side of its normal or on both.
struct AreaLight {
    static constexpr LightType kType = LightType::Area;

    Rgb L;
    bool twoSided = false;
    bool isHidden = false;                     // its shape has alpha 0
    const EmissionProfile* profile = nullptr;  // null: the same radiance to all sides
    Emitter surface;
    // If the emission of a mesh varies: the factor of L, which triangle this is, and roughly the
    // mean factor over it.
    const EmissionMap* map = nullptr;
    uint32_t triangle = 0;
    Rgb meanFactor = Rgb::Ones();

    // Returns the radiance that leaves a point with normal n towards w, without the map.
    Rgb Le(const Vec3f& n, const Vec3f& w) const {
        if (!twoSided && !(n.dot(w) > 0)) return Rgb::Zero();
        return profile ? Rgb(L * Falloff(*profile, n, w)) : L;
    }
    // Returns it with the map; the point is the hit's.
    Rgb Le(const Vec3f& n, const Vec3f& w, const Hit& hit) const {
        return map ? Le(n, w) * map->At(triangle, hit.b1, hit.b2) : Le(n, w);
    }

    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const {
        const auto s =
            VisitEmitter(surface, [&](const auto& e) { return lull::Sample(e, from, u); });
        if (!s) return {};
        const Vec3f wi = (s->p - from).normalized();
        Rgb emitted = Le(s->n, -wi);
        if (map) emitted *= map->Sampled(triangle, u);
        if (IsBlack(emitted)) return {};
        return LightSample{.L = emitted,
                           .wi = wi,
                           .pdf = s->pdf,
                           .isHidden = isHidden,
                           .p = s->p,
                           .pError = s->pError,
                           .n = s->n};
    }

    float Pdf(const Vec3f& from, const Vec3f& p, const Vec3f& n) const {
        return VisitEmitter(surface, [&](const auto& e) { return lull::Pdf(e, from, p, n); });
    }

    LightBounds Bounds() const {
        LightBounds bounds{
            .box = VisitEmitter(surface, [](const auto& e) { return e.WorldBounds(); })};
        if (const auto* cone = std::get_if<SpotCone>(profile)) {
            cone->Bound(&bounds);
            bounds.power = BoundedPower(Whole());
            return bounds;
        }
        const NormalBounds normals =
            VisitEmitter(surface, [](const auto& e) { return e.Normals(); });
        bounds.axis = normals.axis;
        bounds.cosNormals = normals.cosAngle;
        if (const auto* spread = std::get_if<Spread>(profile))
            bounds.cosEmission = spread->cosEmission;
        bounds.power = BoundedPower(Power());
        bounds.isTwoSided = twoSided || normals.isTwoSided;
        return bounds;
    }
    Rgb Power() const { return profile ? Rgb(PowerFraction(*profile) * Whole()) : Whole(); }
    float Area() const {
        return VisitEmitter(surface, [](const auto& e) { return e.Area(); });
    }

  private:
    // Returns the power without a profile.
    Rgb Whole() const { return (twoSided ? 2 : 1) * kPi * Area() * L * meanFactor; }
};

}  // namespace lull
