#pragma once

#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/lights/light_sample.h"
#include "renderer/scene/lights/point.h"

namespace lull {

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
        if (map) {
            const Vec2f b = SampleUniformTriangle(u);  // as the triangle does
            emitted *= map->Covered(triangle, b.y(), 1 - b.x() - b.y());
        }
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
