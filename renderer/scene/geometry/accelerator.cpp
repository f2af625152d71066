#include "renderer/scene/geometry/accelerator_internal.h"

namespace lull {

bool Accelerator::Intersect(const Ray& ray, Hit* hit, float time, RayKind kind) const {
    RTCRayHit r;
    r.ray = MakeRay(ray, kind, time);
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
    RTCRay r = MakeRay(ray, kShadowRay, time);
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
