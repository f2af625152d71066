// The parts of the accelerator that are shared by its sources.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <limits>
#include <memory>
#include <vector>

#include "renderer/scene/geometry/accelerator.h"

namespace lull {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

// Data of a shape for Embree's callbacks.
struct ShapeUser {
    const ShapeTable* shapes;
    const TextureTable* textures;
    int shape;
};

// Data of a moving instance for Embree's callbacks.
struct MovingUser {
    const ShapeTable* shapes;
    int instance;
    RTCScene object;
    std::vector<Bounds3f> bounds;  // one a time step

    // Attaches the geometry to the world under `id`.
    void Attach(RTCDevice device, RTCScene world, unsigned id);
};

struct Accelerator::Implementation {
    Device device;
    std::vector<ShapeUser> users;
    std::vector<EmbreeScene> objects;
    std::vector<std::unique_ptr<MovingUser>> movingUsers;
    EmbreeScene world;
    int shapeCount = 0;

    EmbreeScene NewScene();
    // Attaches a shape under its own number, so that a hit names it directly.
    void Attach(RTCScene scene, const ShapeTable& shapes, int index);
    void AttachInstance(const Instance& instance, int index);
    void AttachMoving(const ShapeTable& shapes, int index);
};

// Returns the box for Embree, with room for the rounding between exact bounds and boxes.
inline RTCBounds PaddedBounds(const Bounds3f& b) {
    const Vec3f pad = Gamma(16) * (b.lower.cwiseAbs().cwiseMax(b.upper.cwiseAbs()));
    const Vec3f lower = b.lower - pad, upper = b.upper + pad;
    return {lower.x(), lower.y(), lower.z(), 0, upper.x(), upper.y(), upper.z(), 0};
}

inline RTCRay MakeRay(const Ray& ray, RayKind kind, float time) {
    RTCRay r;
    r.org_x = ray.o.x(), r.org_y = ray.o.y(), r.org_z = ray.o.z();
    r.dir_x = ray.d.x(), r.dir_y = ray.d.y(), r.dir_z = ray.d.z();
    // Embree's range is closed. A ray that starts in an axis-aligned plane through the origin,
    // where error bounds are 0, hits that plane at exactly 0, which must not count.
    r.tnear = std::numeric_limits<float>::min();
    r.tfar = ray.tMax;
    r.time = time;
    r.mask = ~0u;
    r.id = kind;
    r.flags = 0;
    return r;
}

inline Ray RayOf(const RTCRay& r) {
    return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar};
}

template <typename S>
const S& ShapeOf(void* user) {
    const auto& [shapes, textures, index] = *static_cast<const ShapeUser*>(user);
    return *std::get_if<S>(&shapes->shapes[index].geometry);
}

inline bool IsHidden(const ShapeUser& user, const RTCRay& ray) {
    return user.shapes->shapes[size_t(user.shape)].hiddenFrom & ray.id;
}

template <typename S>
std::optional<ShapeHit> IntersectPrimitive(const S& shape, uint32_t primitive, const Ray& ray) {
    if constexpr (requires { Intersect(shape, primitive, ray); })
        return Intersect(shape, primitive, ray);
    else if (const auto t = Intersect(shape, ray))
        return ShapeHit{*t, 0, 0};
    return {};
}

// Let Embree see and hit shapes of kind S, which are not meshes.
template <typename S>
void BoundsCallback(const RTCBoundsFunctionArguments* args) {
    const S& shape = ShapeOf<S>(args->geometryUserPtr);
    if constexpr (requires { shape.WorldBounds(args->primID); })
        *args->bounds_o = PaddedBounds(shape.WorldBounds(args->primID));
    else
        *args->bounds_o = PaddedBounds(shape.WorldBounds());
}

// Makes a number in [0, 1) of a ray and a primitive: the same for both always, and as good as
// random from one ray or one primitive to another.
float NumberOf(const RTCRay& ray, const RTCHit& hit);

// Returns the first point of a primitive that is there.
template <typename S>
std::optional<ShapeHit> IntersectCovered(const ShapeUser& user, uint32_t geometry,
                                         uint32_t primitive, const RTCRay& r) {
    constexpr int kMostTries = 8;
    const Shape& shape = user.shapes->shapes[size_t(user.shape)];
    const S& s = *std::get_if<S>(&shape.geometry);
    Ray ray = RayOf(r);
    float passed = 0;
    for (int i = 0; i < kMostTries; ++i) {
        const auto found = IntersectPrimitive(s, primitive, ray);
        if (!found) return {};
        Hit hit{};
        hit.t = found->t;
        hit.b1 = found->u;
        hit.b2 = found->v;
        hit.shape = user.shape;
        hit.primitive = primitive;
        SurfaceInteraction at;
        Interact(s, ray, hit, kNeedsUv, &at);
        const float alpha =
            user.textures->Evaluate(shape.coverage->alpha, TextureContext{at.p, at.uv});
        RTCHit number{};
        number.geomID = geometry;
        number.primID = primitive + uint32_t(i) * 0x9e3779b9u;
        if (NumberOf(r, number) < alpha) return ShapeHit{passed + found->t, found->u, found->v};
        const float step = found->t * 1.0001f;
        ray.o += step * ray.d;
        ray.tMax -= step;
        passed += step;
    }
    return {};
}

// The rays that pass a shape: none, those it is hidden from, or also some where it has holes.
enum class Passing { None, Hidden, Uncovered };

// Returns where a ray meets a primitive that `args` of a callback name, unless it passes.
template <typename S, Passing kPassing>
std::optional<ShapeHit> Meet(const auto* args, const RTCRay& ray) {
    const auto& user = *static_cast<const ShapeUser*>(args->geometryUserPtr);
    if (kPassing != Passing::None && IsHidden(user, ray)) return {};
    if constexpr (kPassing == Passing::Uncovered)
        return IntersectCovered<S>(user, args->geomID, args->primID, ray);
    return IntersectPrimitive(ShapeOf<S>(args->geometryUserPtr), args->primID, RayOf(ray));
}

template <typename S, Passing kPassing>
void IntersectCallback(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* rayHit = reinterpret_cast<RTCRayHit*>(args->rayhit);
    const auto hit = Meet<S, kPassing>(args, rayHit->ray);
    if (!hit) return;
    rayHit->ray.tfar = hit->t;
    rayHit->hit.u = hit->u;
    rayHit->hit.v = hit->v;
    rayHit->hit.geomID = args->geomID;
    rayHit->hit.primID = args->primID;
    rayHit->hit.instID[0] = args->context->instID[0];
}

template <typename S, Passing kPassing>
void OccludedCallback(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    if (Meet<S, kPassing>(args, *ray)) ray->tfar = -kInfinity;
}

template <typename S, Passing kPassing>
void SetCallbacks(RTCGeometry geometry) {
    rtcSetGeometryBoundsFunction(geometry, BoundsCallback<S>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, IntersectCallback<S, kPassing>);
    rtcSetGeometryOccludedFunction(geometry, OccludedCallback<S, kPassing>);
}

}  // namespace lull
