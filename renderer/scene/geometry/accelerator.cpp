#include "renderer/scene/geometry/accelerator_internal.h"

namespace lull {

namespace {

RTCRay MakeRay(const Ray& ray, float time) {
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

}  // namespace

bool Accelerator::Intersect(const Ray& ray, Hit* hit, float time) const {
    RTCRayHit r;
    r.ray = MakeRay(ray, time);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(implementation->world.get(), &r);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(implementation->world.get(), &context, &r);
#endif
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit->t = r.ray.tfar;
    hit->b1 = r.hit.u;
    hit->b2 = r.hit.v;
    hit->shape = int(r.hit.geomID);
    hit->primitive = r.hit.primID;
    hit->instance = r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID
                        ? -1
                        : int(r.hit.instID[0]) - implementation->shapeCount;
    return true;
}

bool Accelerator::Occluded(const Ray& ray, float time) const {
    RTCRay r = MakeRay(ray, time);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(implementation->world.get(), &r);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(implementation->world.get(), &context, &r);
#endif
    return r.tfar < 0;
}

}  // namespace lull
