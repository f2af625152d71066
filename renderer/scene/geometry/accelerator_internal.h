// The parts of the accelerator, for its own sources and for programs that measure Embree itself.
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

// Holds what Embree's callbacks know of a shape.
struct ShapeUser {
    const ShapeTable* shapes;
    const TextureTable* textures;
    int shape;
};

// Holds what the callbacks of a moving instance know.
struct MovingUser {
    const ShapeTable* shapes;
    int instance;
    RTCScene object;
    std::vector<Bounds3f> bounds;  // one a time step

    // Attaches the geometry to the world under `id`.
    void Attach(RTCDevice device, RTCScene world, unsigned id);
};

// Callbacks of Embree, called with one ray at a time, as rays are traced one at a time. Those of
// quadrics and curves intersect shapes that are not meshes; the filters reject hits that alpha cuts
// out.
void IntersectQuadricCallback(const RTCIntersectFunctionNArguments* args);
void OccludedQuadricCallback(const RTCOccludedFunctionNArguments* args);
void IntersectCurveCallback(const RTCIntersectFunctionNArguments* args);
void OccludedCurveCallback(const RTCOccludedFunctionNArguments* args);
void FilterNearestByAlpha(const RTCFilterFunctionNArguments* args);
void FilterOcclusionByAlpha(const RTCFilterFunctionNArguments* args);
void FilterByCoverage(const RTCFilterFunctionNArguments* args);

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

inline RTCRay MakeRay(const Ray& ray, float time) {
    RTCRay r;
    r.org_x = ray.o.x(), r.org_y = ray.o.y(), r.org_z = ray.o.z();
    r.dir_x = ray.d.x(), r.dir_y = ray.d.y(), r.dir_z = ray.d.z();
    // Embree's range is closed. A ray that starts in an axis-aligned plane through the origin,
    // where error bounds are 0, hits that plane at exactly 0, which must not count.
    r.tnear = std::numeric_limits<float>::min();
    r.tfar = ray.tMax;
    r.time = time;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
    return r;
}

// Do what the accelerator is asked for; see there.
inline bool FindNearest(const Accelerator::Implementation& impl, const Ray& ray, float time,
                        Hit* hit) {
    RTCRayHit r;
    r.ray = MakeRay(ray, time);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(impl.world.get(), &r);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(impl.world.get(), &context, &r);
#endif
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit->t = r.ray.tfar;
    hit->b1 = r.hit.u;
    hit->b2 = r.hit.v;
    hit->shape = int(r.hit.geomID);
    hit->primitive = r.hit.primID;
    hit->instance =
        r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? -1 : int(r.hit.instID[0]) - impl.shapeCount;
    return true;
}

inline bool IsOccluded(const Accelerator::Implementation& impl, const Ray& ray, float time) {
    RTCRay r = MakeRay(ray, time);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(impl.world.get(), &r);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl.world.get(), &context, &r);
#endif
    return r.tfar < 0;
}

}  // namespace lull
