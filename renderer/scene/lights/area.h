#pragma once

#include "renderer/scene/lights/light_sample.h"
#include "renderer/scene/shape_table.h"

namespace lull {

// Emits L from one primitive of a shape, on the side of its normal or on both.
struct AreaLight {
    Rgb L;
    bool twoSided = false;
    bool isHidden = false;  // its shape has alpha 0
    int shape = -1;
    uint32_t primitive = 0;

    // Returns the radiance that leaves a point with normal n towards w.
    Rgb Le(const Vec3f& n, const Vec3f& w) const {
        return twoSided || n.dot(w) > 0 ? L : Rgb(Rgb::Zero());
    }
    std::optional<LightSample> Sample(const ShapeTable& shapes, const Vec3f& from,
                                      const Vec2f& u) const {
        const auto s = shapes.Sample(shape, primitive, from, u);
        if (!s) return {};
        const Vec3f wi = (s->p - from).normalized();
        const Rgb emitted = Le(s->n, -wi);
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
    Rgb Power(const ShapeTable& shapes) const {
        return (twoSided ? 2 : 1) * kPi * shapes.Area(shape, primitive) * L;
    }
};

}  // namespace lull
