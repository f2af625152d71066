// Traces rays through instances that move. Embree could interpolate their transforms itself, but
// not outside of its span of time, nor with pbrt-v3's choice of arc, nor in double, as hits are
// placed; so that it is told no more than where they are.
#include "renderer/scene/geometry/accelerator_internal.h"

namespace lull {
namespace {

void MovingBounds(const RTCBoundsFunctionArguments* args) {
    const auto& user = *static_cast<const MovingUser*>(args->geometryUserPtr);
    *args->bounds_o = PaddedBounds(user.bounds[args->timeStep]);
}

// Finds the ray as the instance sees it at the ray's time; false where it cannot be traced there.
bool IntoMoving(const MovingUser& user, const RTCRay& r, RTCRay* inner) {
    const Instance& instance = user.shapes->instances[user.instance];
    const Ray ray =
        IntoInstance(user.shapes->InstanceAt(instance, r.time),
                     {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar});
    *inner = MakeRay(ray, RayKind(r.id), r.time);
    return ray.o.squaredNorm() + ray.d.squaredNorm() < Sqr(kLongestRay);
}

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;

void Intersect(RTCScene scene, Context* context, RTCRayHit* ray) {
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = context;
    rtcIntersect1(scene, ray, &args);
}
void FindOcclusion(RTCScene scene, Context* context, RTCRay* ray) {
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = context;
    rtcOccluded1(scene, ray, &args);
}
#else
using Context = RTCIntersectContext;

void Intersect(RTCScene scene, Context* context, RTCRayHit* ray) {
    rtcIntersect1(scene, context, ray);
}
void FindOcclusion(RTCScene scene, Context* context, RTCRay* ray) {
    rtcOccluded1(scene, context, ray);
}
#endif

void IntersectMoving(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* outer = reinterpret_cast<RTCRayHit*>(args->rayhit);
    const auto& user = *static_cast<const MovingUser*>(args->geometryUserPtr);
    RTCRayHit inner;
    if (!IntoMoving(user, outer->ray, &inner.ray)) return;
    inner.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    args->context->instID[0] = args->geomID;
    Intersect(user.object, args->context, &inner);
    args->context->instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (inner.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    outer->ray.tfar = inner.ray.tfar;
    outer->hit = inner.hit;
    outer->hit.instID[0] = args->geomID;
}

void OccludedMoving(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    auto* outer = reinterpret_cast<RTCRay*>(args->ray);
    const auto& user = *static_cast<const MovingUser*>(args->geometryUserPtr);
    RTCRay inner;
    if (!IntoMoving(user, *outer, &inner)) return;
    args->context->instID[0] = args->geomID;
    FindOcclusion(user.object, args->context, &inner);
    args->context->instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (inner.tfar < 0) outer->tfar = -kInfinity;
}

}  // namespace

void MovingUser::Attach(RTCDevice device, RTCScene world, unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryTimeStepCount(geometry, unsigned(bounds.size()));
    rtcSetGeometryBoundsFunction(geometry, MovingBounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, IntersectMoving);
    rtcSetGeometryOccludedFunction(geometry, OccludedMoving);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(world, geometry, id);
    rtcReleaseGeometry(geometry);
}

}  // namespace lull
