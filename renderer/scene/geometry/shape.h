// All kinds of shape, and the functions of each.
//
// A kind is a struct S, in a file of shapes/, that consists of one or more primitives:
//
//     uint32_t PrimitiveCount() const
//     Bounds3f WorldBounds() const
//     void Interact(const S&, const Ray&, const Hit&, SurfaceNeeds, SurfaceInteraction*)
//         fills in the needed fields of the hit, except wo, material and light.
//
// World space is that of the object where a shape belongs to one, and so is the ray; meshes do not
// read it. Triangles are intersected by Embree, other kinds by
//
//     std::optional<float> Intersect(const S&, const Ray&)
//         returns the least t in (0, ray.tMax); in double, as a ray that starts an error bound away
//         from the surface must find t on the right side of 0,
//
// or, where they can have several primitives,
//
//     std::optional<ShapeHit> Intersect(const S&, uint32_t primitive, const Ray&)
//     Bounds3f WorldBounds(uint32_t primitive) const.
//
// An emitter is one primitive: E is EmittingTriangle or a kind of one primitive, whose
// transform may move and turn it, but not stretch it:
//
//     std::optional<ShapeSample> Sample(const E&, const Vec3f& from, const Vec2f& u)
//         returns a point as seen from `from`; nothing where all of E is seen edge-on;
//     float Pdf(const E&, const Vec3f& from, const Vec3f& p, const Vec3f& n)
//         returns the density, 1/sr, with which Sample finds p, where the normal is n; finite;
//     ShapeSample SampleArea(const E&, const Vec2f& u)
//         returns a point of E, evenly by area: its `pdf` is 1 / Area();
//     float Area() const
//     Bounds3f WorldBounds() const
//     NormalBounds Normals() const
//         bounds the normals that samples and hits have.
#pragma once

#include "renderer/base/math.h"
#include "renderer/base/variant.h"
#include "renderer/scene/geometry/shapes/curves.h"
#include "renderer/scene/geometry/shapes/mesh.h"
#include "renderer/scene/geometry/shapes/quadric.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

// Limits how far from the origin a scene may go. Embree takes no ray with a coordinate of more than
// 1.84e18, and finds no triangle where products of three lengths are beyond floats. That is made
// sure of where rays come from, and costs those between surfaces nothing.

// All that a scene consists of lies within this distance of the origin, so that no ray that starts
// there and ends there is longer than kLongestRay.
constexpr float kFarthest = 1e12f;
constexpr float kLongestRay = 1e18f;

// Embree takes hits of triangles of less than 1e-18 square units for hits of their first corner: a
// scene of triangles has to be larger than this.
constexpr float kSmallestScene = 1e-6f;

// Returns the greatest distance of a point of the box from the origin, also where that is beyond
// the squares of floats; 0 for an empty box.
double Farthest(const Bounds3f& box);

// Returns the distance within which things may lie so that rays between them can be carried by the
// transform, an affine one; kFarthest at most. It may be negative.
double ReachThrough(const Mat4d& transform);

// Returns whether an affine transform can be inverted by Cramer's rule in floats, as Embree does:
// the products of two and of three lengths are floats.
bool IsInvertibleInFloats(const Mat4d& transform);

using Geometry = std::variant<Mesh, Sphere, Disk, Revolved, Curves>;

// An emitter. Shapes belong to the shape table, and outlive this.
using Emitter = std::variant<EmittingTriangle, const Sphere*, const Disk*, const Revolved*>;

// Returns the emitter of a primitive. The kind of shape must be one that can.
Emitter EmitterOf(const Geometry&, uint32_t primitive);

// Calls f with the E inside; see Visit().
template <typename F>
[[gnu::always_inline]] inline auto VisitEmitter(const Emitter& emitter, F&& f) {
    return Visit(emitter, [&]<typename E>(const E& e) {
        if constexpr (std::is_pointer_v<E>)
            return f(*e);
        else
            return f(e);
    });
}

// How much of a surface is there (glTF's alpha modes). With a cutoff a point is there or not;
// without, rays hit it at random, by a number derived from the ray itself, so that the right share
// passes.
struct Coverage {
    FloatTexture alpha;
    float factor = 1;
    float cutoff = -1;  // negative: none
    bool secondUv = false, vertexAlpha = false;
    bool openBehind = false;   // rays from behind pass
    bool singleSided = false;  // the camera's rays from behind pass

    // Returns whether rays from the front meet all of it: a factor of 1 that was rounded is no
    // reason to let light through.
    bool IsWhole() const {
        const float least = cutoff >= 0 ? cutoff : 1 - float(kRounding);
        return alpha.IsConstant() && !vertexAlpha && factor * alpha.constant >= least;
    }
};

// Kinds of rays, as bits: shapes can be hidden from some.
enum RayKind : unsigned { kOtherRay = 0, kCameraRay = 1, kShadowRay = 2 };

struct Shape {
    Geometry geometry{};
    int material = -1;
    int firstLight = -1;  // of its lights, one a primitive; -1: emits nothing
    std::optional<FloatTexture> alpha{}, shadowAlpha{};  // 0 there: not hit (by shadow rays)
    std::optional<Coverage> coverage{};
    unsigned hiddenFrom = 0;  // kinds of rays that pass it

    bool IsMesh() const { return std::holds_alternative<Mesh>(geometry); }
    bool IsInvisible() const { return alpha && alpha->IsConstant() && alpha->constant == 0; }
    uint32_t PrimitiveCount() const;
    Bounds3f WorldBounds() const;
};

// Returns the probability that a ray hits a mesh with coverage at this point of a triangle.
inline float CoverageAt(const Shape& shape, const TextureTable& textures, const Vec3f& p,
                        uint32_t triangle, float b1, float b2) {
    const Coverage& coverage = *shape.coverage;
    const Mesh& mesh = *std::get_if<Mesh>(&shape.geometry);
    float alpha = coverage.factor;
    if (!coverage.alpha.IsConstant()) {
        const Vec2f uv = coverage.secondUv ? mesh.Uv1(triangle, b1, b2) : mesh.Uv(triangle, b1, b2);
        alpha *= textures.Evaluate(coverage.alpha, TextureContext{p, uv});
    } else {
        alpha *= coverage.alpha.constant;
    }
    if (coverage.vertexAlpha) alpha *= mesh.Color(triangle, b1, b2)[3];
    if (coverage.cutoff >= 0) return alpha >= coverage.cutoff ? 1 : 0;
    return std::clamp(alpha, 0.f, 1.f);
}

}  // namespace lull
