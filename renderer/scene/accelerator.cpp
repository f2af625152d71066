#include "renderer/scene/accelerator.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

namespace lull {
namespace {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

#ifdef LULL_RECORD_RAYS
// For tests/transport/traversal_bench.cpp alone, which includes this file: keeps the rays that a
// thread traces, and lets Embree's callbacks see packets. Programs are built without.
struct RayLog {
    struct Entry {
        Ray ray;
        int bounce;
    };
    std::vector<Entry> nearest, occlusion;
    RTCScene world = nullptr;
    int bounce = -1;  // the caller sets it back at the start of each path
};
thread_local RayLog* rayLog = nullptr;

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
#endif

// Holds what Embree's callbacks get to see of a shape.
struct ShapeUser {
    const ShapeTable* shapes;
    const TextureTable* textures;
    int shape;
};

// Receives every error of Embree, so that its calls need not be checked one by one.
void ReportEmbreeError(void*, RTCError, const char* message) {
    throw Error(fmt::format("the acceleration structure could not be built: {}",
                            message ? message : "unknown error"));
}

Ray RayOf(const RTCRay& r) {
    return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar};
}

bool IsCutOut(const ShapeUser& user, const RTCRay& ray, const RTCHit& hit, bool isShadow) {
    const Shape& shape = user.shapes->shapes[user.shape];
    const TextureContext context{
        {ray.org_x + ray.tfar * ray.dir_x, ray.org_y + ray.tfar * ray.dir_y,
         ray.org_z + ray.tfar * ray.dir_z},
        user.shapes->Uv(user.shape, hit.primID, hit.u, hit.v)};
    const auto isZero = [&](const std::optional<FloatTexture>& alpha) {
        return alpha && user.textures->Evaluate(*alpha, context) == 0;
    };
    return isZero(shape.alpha) || (isShadow && isZero(shape.shadowAlpha));
}

// Rays are traced one at a time, so that the callbacks always see a single one.
template <bool isShadow>
void FilterByAlpha(const RTCFilterFunctionNArguments* args) {
#ifdef LULL_RECORD_RAYS
    if (args->N > 1) return ForEachLane(args, FilterByAlpha<isShadow>);
#endif
    if (IsCutOut(*static_cast<const ShapeUser*>(args->geometryUserPtr),
                 *reinterpret_cast<const RTCRay*>(args->ray),
                 *reinterpret_cast<const RTCHit*>(args->hit), isShadow))
        args->valid[0] = 0;
}

std::optional<float> IntersectQuadric(const ShapeUser& user, const Ray& ray) {
    const auto& geometry = user.shapes->shapes[user.shape].geometry;
    if (const Sphere* sphere = std::get_if<Sphere>(&geometry)) return Intersect(*sphere, ray);
    return Intersect(std::get<Disk>(geometry), ray);
}

void QuadricBounds(const RTCBoundsFunctionArguments* args) {
    const auto& user = *static_cast<const ShapeUser*>(args->geometryUserPtr);
    const auto& geometry = user.shapes->shapes[user.shape].geometry;
    const Sphere* sphere = std::get_if<Sphere>(&geometry);
    const Bounds3f b = sphere ? sphere->WorldBounds() : std::get<Disk>(geometry).WorldBounds();
    // Leave room for the rounding between the exact bounds and the boxes.
    const Vec3f pad = Gamma(16) * (b.lower.cwiseAbs().cwiseMax(b.upper.cwiseAbs()));
    const Vec3f lower = b.lower - pad, upper = b.upper + pad;
    *args->bounds_o = {lower.x(), lower.y(), lower.z(), 0, upper.x(), upper.y(), upper.z(), 0};
}

void IntersectQuadricCallback(const RTCIntersectFunctionNArguments* args) {
#ifdef LULL_RECORD_RAYS
    if (args->N > 1) return ForEachLane(args, IntersectQuadricCallback);
#endif
    if (!args->valid[0]) return;
    auto* rayHit = reinterpret_cast<RTCRayHit*>(args->rayhit);
    const auto& user = *static_cast<const ShapeUser*>(args->geometryUserPtr);
    const auto t = IntersectQuadric(user, RayOf(rayHit->ray));
    if (!t) return;
    rayHit->ray.tfar = *t;
    rayHit->hit.u = rayHit->hit.v = 0;
    rayHit->hit.geomID = args->geomID;
    rayHit->hit.primID = args->primID;
    rayHit->hit.instID[0] = args->context->instID[0];
}

void OccludedQuadricCallback(const RTCOccludedFunctionNArguments* args) {
#ifdef LULL_RECORD_RAYS
    if (args->N > 1) return ForEachLane(args, OccludedQuadricCallback);
#endif
    if (!args->valid[0]) return;
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const auto& user = *static_cast<const ShapeUser*>(args->geometryUserPtr);
    if (IntersectQuadric(user, RayOf(*ray))) ray->tfar = -kInfinity;
}

RTCRay MakeRay(const Ray& ray) {
    RTCRay r;
    r.org_x = ray.o.x(), r.org_y = ray.o.y(), r.org_z = ray.o.z();
    r.dir_x = ray.d.x(), r.dir_y = ray.d.y(), r.dir_z = ray.d.z();
    // The range is closed for Embree. A ray that starts in an axis-aligned plane through the
    // origin, where error bounds are 0, meets that plane at exactly 0, which must not count.
    r.tnear = std::numeric_limits<float>::min();
    r.tfar = ray.tMax;
    r.time = 0;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
    return r;
}

}  // namespace

struct Accelerator::Implementation {
    Device device;
    std::vector<ShapeUser> users;
    std::vector<EmbreeScene> objects;
    EmbreeScene world;
    int shapeCount = 0;

    EmbreeScene NewScene() {
        EmbreeScene scene(rtcNewScene(device.get()));
        rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
        return scene;
    }

    // Attaches a shape under its own number, so that a hit names it directly.
    void Attach(RTCScene scene, const ShapeTable& shapes, int index) {
        const Shape& shape = shapes.shapes[index];
        if (shape.IsInvisible() || shape.PrimitiveCount() == 0) return;
        const Mesh* mesh = std::get_if<Mesh>(&shape.geometry);
        RTCGeometry geometry = rtcNewGeometry(
            device.get(), mesh ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserData(geometry, &users[index]);
        if (mesh) {
            // Embree reads the vertices where they are; it may read 4 bytes past the last one,
            // for which the loader keeps a spare vertex.
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       mesh->p.data(), 0, sizeof(Vec3f), mesh->p.size() - 1);
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                       mesh->triangles.data(), 0, 3 * sizeof(uint32_t),
                                       mesh->triangles.size());
        } else {
            rtcSetGeometryUserPrimitiveCount(geometry, 1);
            rtcSetGeometryBoundsFunction(geometry, QuadricBounds, nullptr);
            rtcSetGeometryIntersectFunction(geometry, IntersectQuadricCallback);
            rtcSetGeometryOccludedFunction(geometry, OccludedQuadricCallback);
        }
        if (mesh && shape.alpha)
            rtcSetGeometryIntersectFilterFunction(geometry, FilterByAlpha<false>);
        if (mesh && (shape.alpha || shape.shadowAlpha))
            rtcSetGeometryOccludedFilterFunction(geometry, FilterByAlpha<true>);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, unsigned(index));
        rtcReleaseGeometry(geometry);
    }

    void AttachInstance(const Instance& instance, int index) {
        RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, objects[instance.object].get());
        const Eigen::Matrix<float, 3, 4> m =
            instance.worldFromInstance.topRows<3>().cast<float>();  // column-major
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m.data());
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(world.get(), geometry, unsigned(shapeCount + index));
        rtcReleaseGeometry(geometry);
    }
};

Accelerator::Accelerator() = default;
Accelerator::~Accelerator() = default;
Accelerator::Accelerator(Accelerator&&) noexcept = default;
Accelerator& Accelerator::operator=(Accelerator&&) noexcept = default;

Accelerator::Accelerator(const ShapeTable& shapes, const TextureTable& textures, int threads)
    : implementation(std::make_unique<Implementation>()) {
    Implementation& impl = *implementation;
    impl.device.reset(
        rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr));
    if (!impl.device) throw Error("Embree does not run on this machine");
    rtcSetDeviceErrorFunction(impl.device.get(), ReportEmbreeError, nullptr);

    impl.shapeCount = int(shapes.shapes.size());
    for (int i = 0; i < impl.shapeCount; ++i) impl.users.push_back({&shapes, &textures, i});
    for (const Object& object : shapes.objects) {
        impl.objects.push_back(impl.NewScene());
        for (int i = 0; i < object.shapeCount; ++i)
            impl.Attach(impl.objects.back().get(), shapes, object.firstShape + i);
        rtcCommitScene(impl.objects.back().get());
    }
    impl.world = impl.NewScene();
    for (int i = 0; i < shapes.worldShapeCount; ++i) impl.Attach(impl.world.get(), shapes, i);
    for (size_t i = 0; i < shapes.instances.size(); ++i)
        impl.AttachInstance(shapes.instances[i], int(i));
    rtcCommitScene(impl.world.get());
}

bool Accelerator::Intersect(const Ray& ray, Hit* hit) const {
#ifdef LULL_RECORD_RAYS
    if (rayLog) {
        rayLog->world = implementation->world.get();
        rayLog->nearest.push_back({ray, ++rayLog->bounce});
    }
#endif
    RTCRayHit r;
    r.ray = MakeRay(ray);
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

bool Accelerator::Occluded(const Ray& ray) const {
#ifdef LULL_RECORD_RAYS
    if (rayLog) rayLog->occlusion.push_back({ray, rayLog->bounce});
#endif
    RTCRay r = MakeRay(ray);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(implementation->world.get(), &r);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(implementation->world.get(), &context, &r);
#endif
    return r.tfar < 0;
}

#ifdef LULL_RECORD_RAYS
namespace {

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

// Traces the rays in packets of 8 or 16, gathering each packet first. Returns how many hit.
template <int width>
size_t TracePackets(RTCScene world, std::span<const RayLog::Entry> rays, bool isOcclusion) {
    const auto trace = [&](auto function, const int* valid, auto* packet) {
#if RTC_VERSION_MAJOR >= 4
        function(valid, world, packet, nullptr);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
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
            const RTCRay r = MakeRay(rays[first + std::min(i, count - 1)].ray);
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

}  // namespace
#endif

}  // namespace lull
