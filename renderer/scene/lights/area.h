#pragma once

#include "renderer/scene/geometry/shape_table.h"
#include "renderer/scene/lights/emission_map.h"
#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Emits L from one primitive of a shape, on the side of its normal or on both.
struct AreaLight {
    Rgb L;
    bool twoSided = false;
    bool isHidden = false;  // its shape has alpha 0
    // The emitting surface; all but triangles belong to the shape table.
    std::variant<TriangleSampler, const Sphere*, const Disk*, const Revolved*> surface;
    // If the emission of a mesh varies: the factor of L, which triangle this is, and roughly the
    // mean factor over it.
    const EmissionMap* map = nullptr;
    uint32_t triangle = 0;
    Rgb meanFactor = Rgb::Ones();

    // Returns the radiance that leaves a point with normal n towards w, without the map.
    Rgb Le(const Vec3f& n, const Vec3f& w) const {
        return twoSided || n.dot(w) > 0 ? L : Rgb(Rgb::Zero());
    }
    // Returns it with the map; the point is that of a hit.
    Rgb Le(const Vec3f& n, const Vec3f& w, const Hit& hit) const {
        return map ? Le(n, w) * map->At(triangle, hit.b1, hit.b2) : Le(n, w);
    }

    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const {
        const auto s = SampleSurface(from, u);
        if (!s) return {};
        const Vec3f wi = (s->p - from).normalized();
        Rgb emitted = Le(s->n, -wi);
        if (map) {
            const Vec2f b = SampleUniformTriangle(u);  // as TriangleSampler does
            emitted *= map->Covered(triangle, b.y(), 1 - b.x() - b.y());
        }
        if (IsBlack(emitted)) return {};
        return LightSample{.L = emitted,
                           .wi = wi,
                           .pdf = s->pdf,
                           .isDelta = false,
                           .isHidden = isHidden,
                           .p = s->p,
                           .pError = s->pError,
                           .n = s->n};
    }

    // Returns the density, 1/sr, of having sampled the point p of the surface with normal n.
    float Pdf(const Vec3f& from, const Vec3f& p, const Vec3f& n) const {
        if (const auto* triangle = std::get_if<TriangleSampler>(&surface))
            return SolidAnglePdf(triangle->areaPdf, from, p, n);
        if (const auto* sphere = std::get_if<const Sphere*>(&surface))
            return lull::Pdf(**sphere, from, p, n);
        if (const auto* disk = std::get_if<const Disk*>(&surface))
            return lull::Pdf(**disk, from, p, n);
        return lull::Pdf(*std::get<const Revolved*>(surface), from, p, n);
    }

    float Area() const {
        if (const auto* triangle = std::get_if<TriangleSampler>(&surface))
            return 1 / triangle->areaPdf;
        if (const auto* sphere = std::get_if<const Sphere*>(&surface)) return (*sphere)->Area();
        if (const auto* disk = std::get_if<const Disk*>(&surface)) return (*disk)->Area();
        return std::get<const Revolved*>(surface)->Area();
    }
    LightBounds Bounds() const;
    Rgb Power() const { return (twoSided ? 2 : 1) * kPi * Area() * L * meanFactor; }

  private:
    std::optional<ShapeSample> SampleSurface(const Vec3f& from, const Vec2f& u) const {
        if (const auto* triangle = std::get_if<TriangleSampler>(&surface))
            return triangle->Sample(from, u);
        if (const auto* sphere = std::get_if<const Sphere*>(&surface))
            return lull::Sample(**sphere, from, u);
        if (const auto* disk = std::get_if<const Disk*>(&surface))
            return lull::Sample(**disk, from, u);
        return lull::Sample(*std::get<const Revolved*>(surface), from, u);
    }
};

}  // namespace lull
