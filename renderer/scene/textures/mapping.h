// Maps points of surfaces to the coordinates that textures are defined in.
#pragma once

#include <variant>

#include "renderer/scene/textures/texture_image.h"

namespace lull {

struct UvMapping {
    Vec2f scale{1, 1}, offset{0, 0};
};

// Scales, turns and shears as well (KHR_texture_transform).
struct AffineUvMapping {
    // Rows, as plain numbers, so that the variant needs no larger alignment.
    std::array<float, 3> s, t;

    Vec2f operator()(const Vec2f& uv) const {
        return {s[0] * uv.x() + s[1] * uv.y() + s[2], t[0] * uv.x() + t[1] * uv.y() + t[2]};
    }
};

// Gives (theta / pi, phi / 2 pi) of the direction from the texture's origin.
struct SphericalMapping {
    Eigen::Matrix4f textureFromWorld;
};

// Gives (phi / 2 pi + 1/2, z) of the *unit* direction from the texture's origin, as pbrt-v3 does.
struct CylindricalMapping {
    Eigen::Matrix4f textureFromWorld;
};

struct PlanarMapping {
    Vec3f vs, vt;
    Vec2f offset;
};

using Mapping2D =
    std::variant<UvMapping, SphericalMapping, CylindricalMapping, PlanarMapping, AffineUvMapping>;

// Reads "mapping" and its parameters; pbrt-v3's defaults. "uvaffine" has the six numbers of
// "uvtransform", two rows of three. Plain uv substitutes unknown ones.
Mapping2D MakeMapping2D(const TextureInput& input);

inline SurfaceNeeds Needs(const Mapping2D& mapping) {
    const bool isByUv = std::holds_alternative<UvMapping>(mapping) ||
                        std::holds_alternative<AffineUvMapping>(mapping);
    return isByUv ? kNeedsUv : kNeedsNothing;
}

Vec2f MapByPosition(const Mapping2D& mapping, const Vec3f& p);  // all mappings not by uv

inline Vec2f Map(const Mapping2D& mapping, const TextureContext& c) {
    if (const auto* uv = std::get_if<UvMapping>(&mapping))
        return uv->scale.cwiseProduct(c.uv) + uv->offset;
    if (const auto* affine = std::get_if<AffineUvMapping>(&mapping)) return (*affine)(c.uv);
    return MapByPosition(mapping, c.p);
}

// Maps world space to the space of solid textures. pbrt-v3 applies the current transformation
// matrix itself here, not its inverse ("Scale 10 10 10" makes a pattern ten times *finer*), and
// scenes are tuned to that.
struct Mapping3D {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
};

inline Mapping3D MakeMapping3D(const TextureInput& input) {
    return {input.entity.worldFromTexture.cast<float>()};
}

// Noise in these coordinates needs the distance between samples.
inline SurfaceNeeds Needs(const Mapping3D&) { return kNeedsFootprint; }

inline Vec3f TransformPoint(const Eigen::Matrix4f& m, const Vec3f& p) {
    const Eigen::Vector4f q = m * p.homogeneous();
    return q.head<3>() / q.w();
}

inline Vec3f Map(const Mapping3D& mapping, const TextureContext& c) {
    return TransformPoint(mapping.matrix, c.p);
}

// Returns the square of the larger distance between samples in texture space; 0 if not known.
inline float Spacing2(const Mapping3D& mapping, const TextureContext& c) {
    const auto linear = mapping.matrix.topLeftCorner<3, 3>();
    return std::max((linear * c.dpdx).squaredNorm(), (linear * c.dpdy).squaredNorm());
}

}  // namespace lull
