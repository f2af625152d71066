#include "tests/renderer/transport/recording_accelerator.h"

namespace lull {

thread_local RayLog* rayLog = nullptr;

namespace {

// Calls a callback that handles single rays for each ray of a packet.
void ForEachLane(const RTCFilterFunctionNArguments* args, RTCFilterFunctionN callback) {
    for (unsigned i = 0; i < args->N; ++i) {
        if (!args->valid[i]) continue;
        RTCRay ray = rtcGetRayFromRayN(args->ray, args->N, i);
        RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, i);
        RTCFilterFunctionNArguments one = *args;
        one.N = 1, one.valid += i;
        one.ray = reinterpret_cast<RTCRayN*>(&ray), one.hit = reinterpret_cast<RTCHitN*>(&hit);
        callback(&one);
    }
}

void ForEachLane(const RTCIntersectFunctionNArguments* args, RTCIntersectFunctionN callback) {
    for (unsigned i = 0; i < args->N; ++i) {
        if (!args->valid[i]) continue;
        RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
        RTCRayHit lane = {rtcGetRayFromRayN(rays, args->N, i), {}};
        lane.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectFunctionNArguments one = *args;
        one.N = 1, one.valid += i, one.rayhit = reinterpret_cast<RTCRayHitN*>(&lane);
        callback(&one);
        if (lane.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
        RTCRayN_tfar(rays, args->N, i) = lane.ray.tfar;
        rtcCopyHitToHitN(RTCRayHitN_HitN(args->rayhit, args->N), &lane.hit, args->N, i);
    }
}

void ForEachLane(const RTCOccludedFunctionNArguments* args, RTCOccludedFunctionN callback) {
    for (unsigned i = 0; i < args->N; ++i) {
        if (!args->valid[i]) continue;
        RTCRay ray = rtcGetRayFromRayN(args->ray, args->N, i);
        RTCOccludedFunctionNArguments one = *args;
        one.N = 1, one.valid += i, one.ray = reinterpret_cast<RTCRayN*>(&ray);
        callback(&one);
        RTCRayN_tfar(args->ray, args->N, i) = ray.tfar;
    }
}

template <auto callback, class Arguments>
void OneByOne(const Arguments* args) {
    args->N > 1 ? ForEachLane(args, callback) : callback(args);
}

template <int width>
struct Packet;
template <>
struct Packet<8> {
    using RayHit = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packet<16> {
    using RayHit = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

}  // namespace

bool Accelerator::Intersect(const Ray& ray, Hit* hit, float time) const {
    if (rayLog) rayLog->nearest.push_back({ray, ++rayLog->bounce});
    return FindNearest(*implementation, ray, time, hit);
}

bool Accelerator::Occluded(const Ray& ray, float time) const {
    if (rayLog) rayLog->occlusion.push_back({ray, rayLog->bounce});
    return IsOccluded(*implementation, ray, time);
}

RTCScene AdmitPackets(const Scene& scene) {
    const Accelerator::Implementation& impl = scene.accelerator.Internals();
    const ShapeTable& shapes = scene.shapes;
    const auto admit = [&](RTCScene world, int first, int count) {
        for (int i = first; i < first + count; ++i) {
            const Shape& shape = shapes.shapes[i];
            if (shape.IsInvisible() || shape.PrimitiveCount() == 0) continue;
            RTCGeometry geometry = rtcGetGeometry(world, unsigned(i));
            std::visit(
                [&]<typename S>(const S&) {
                    if constexpr (!std::is_same_v<S, Mesh>) {
                        rtcSetGeometryIntersectFunction(geometry, OneByOne<IntersectCallback<S>>);
                        rtcSetGeometryOccludedFunction(geometry, OneByOne<OccludedCallback<S>>);
                    }
                },
                shape.geometry);
            if (shape.IsMesh() && (shape.alpha || shape.shadowAlpha)) {
                if (shape.alpha)
                    rtcSetGeometryIntersectFilterFunction(geometry, OneByOne<FilterNearestByAlpha>);
                rtcSetGeometryOccludedFilterFunction(geometry, OneByOne<FilterOcclusionByAlpha>);
            }
            rtcCommitGeometry(geometry);
        }
        rtcCommitScene(world);
    };
    for (size_t i = 0; i < shapes.objects.size(); ++i)
        admit(impl.objects[i].get(), shapes.objects[i].firstShape, shapes.objects[i].shapeCount);
    admit(impl.world.get(), 0, shapes.worldShapeCount);
    return impl.world.get();
}

template <int width>
size_t TracePackets(RTCScene world, std::span<const RecordedRay> rays, bool isOcclusion,
                    bool areCoherent) {
    const auto trace = [&](auto function, const int* valid, auto* packet) {
#if RTC_VERSION_MAJOR >= 4
        RTCRayQueryFlags flags =
            areCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
        if constexpr (std::is_same_v<decltype(packet), typename Packet<width>::RayHit*>) {
            RTCIntersectArguments arguments;
            rtcInitIntersectArguments(&arguments);
            arguments.flags = flags;
            function(valid, world, packet, &arguments);
        } else {
            RTCOccludedArguments arguments;
            rtcInitOccludedArguments(&arguments);
            arguments.flags = flags;
            function(valid, world, packet, &arguments);
        }
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        if (areCoherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        function(valid, world, &context, packet);
#endif
    };
    alignas(64) int valid[width];
    typename Packet<width>::RayHit p;
    size_t hits = 0;
    for (size_t first = 0; first < rays.size(); first += width) {
        const int count = int(std::min<size_t>(width, rays.size() - first));
        for (int i = 0; i < width; ++i) {
            valid[i] = i < count ? -1 : 0;
            const RTCRay r = MakeRay(rays[first + std::min(i, count - 1)].ray, 0);
            p.ray.org_x[i] = r.org_x, p.ray.org_y[i] = r.org_y, p.ray.org_z[i] = r.org_z;
            p.ray.dir_x[i] = r.dir_x, p.ray.dir_y[i] = r.dir_y, p.ray.dir_z[i] = r.dir_z;
            p.ray.tnear[i] = r.tnear, p.ray.tfar[i] = r.tfar, p.ray.time[i] = r.time;
            p.ray.mask[i] = r.mask, p.ray.id[i] = r.id, p.ray.flags[i] = r.flags;
            p.hit.geomID[i] = p.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        if (isOcclusion)
            trace(Packet<width>::occluded, valid, &p.ray);
        else
            trace(Packet<width>::intersect, valid, &p);
        for (int i = 0; i < count; ++i)
            hits += isOcclusion ? p.ray.tfar[i] < 0 : p.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

template size_t TracePackets<8>(RTCScene, std::span<const RecordedRay>, bool, bool);
template size_t TracePackets<16>(RTCScene, std::span<const RecordedRay>, bool, bool);

}  // namespace lull
