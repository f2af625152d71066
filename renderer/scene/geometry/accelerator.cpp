#include "renderer/scene/geometry/accelerator.h"

#include <fmt/format.h>

#include "renderer/scene/geometry/accelerator_internal.h"
#include "renderer/scene/geometry/shape.h"
#include "stopping/base/hash.h"

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

namespace {

// Receives every error of Embree, so that its calls need not be checked one by one.
void ReportEmbreeError(void*, RTCError, const char* message) {
    throw Error("the acceleration structure could not be built: {}",
                message ? message : "unknown error");
}

bool IsFromBehind(const Shape& shape, const RTCRay& ray, const RTCHit& hit) {
    const Vec3f front = std::get_if<Mesh>(&shape.geometry)->EmitterAt(hit.primID).n;
    return front.dot(Vec3f(ray.dir_x, ray.dir_y, ray.dir_z)) > 0;
}

bool IsUncovered(const ShapeUser& user, const RTCRay& ray, const RTCHit& hit) {
    if (IsHidden(user, ray)) return true;
    const Shape& shape = user.shapes->shapes[user.shape];
    if (!shape.coverage) return false;
    const bool opens =
        shape.coverage->openBehind || (shape.coverage->singleSided && (ray.id & kCameraRay));
    if (opens && IsFromBehind(shape, ray, hit)) return true;
    const Vec3f p(ray.org_x + ray.tfar * ray.dir_x, ray.org_y + ray.tfar * ray.dir_y,
                  ray.org_z + ray.tfar * ray.dir_z);
    const float share = CoverageAt(shape, *user.textures, p, hit.primID, hit.u, hit.v);
    return share <= 0 || (share < 1 && NumberOf(ray, hit) >= share);
}

template <bool isShadow>
bool IsCutOut(const ShapeUser& user, const RTCRay& ray, const RTCHit& hit) {
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

bool IsBehindSingleSided(const ShapeUser& user, const RTCRay& ray, const RTCHit& hit) {
    return (ray.id & kCameraRay) && IsFromBehind(user.shapes->shapes[user.shape], ray, hit);
}

// A filter of Embree, which rejects hits. It is called with one ray at a time.
template <auto Rejects>
void FilterBy(const RTCFilterFunctionNArguments* args) {
    if (Rejects(*static_cast<const ShapeUser*>(args->geometryUserPtr),
                *reinterpret_cast<const RTCRay*>(args->ray),
                *reinterpret_cast<const RTCHit*>(args->hit)))
        args->valid[0] = 0;
}

// Traces rays through instances that move. Embree could interpolate their transforms itself, but
// not outside of its span of time, nor with pbrt-v3's choice of arc, nor in double, as hits are
// placed; so that it is told no more than where they are.

void MovingBounds(const RTCBoundsFunctionArguments* args) {
    const auto& user = *static_cast<const MovingUser*>(args->geometryUserPtr);
    *args->bounds_o = PaddedBounds(user.bounds[args->timeStep]);
}

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

float NumberOf(const RTCRay& ray, const RTCHit& hit) {
    uint64_t state = 0;
    const auto mix = [&](uint64_t bits) { state = HashWith(state, bits); };
    const auto pair = [](float a, float b) {
        return uint64_t(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b);
    };
    mix(pair(ray.org_x, ray.org_y));
    mix(pair(ray.org_z, ray.dir_x));
    mix(pair(ray.dir_y, ray.dir_z));
    mix(uint64_t(hit.geomID) << 32 | hit.primID);
    mix(hit.instID[0]);
    return UnitFloat(state);
}

EmbreeScene Accelerator::Implementation::NewScene() {
    EmbreeScene scene(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
    return scene;
}

void Accelerator::Implementation::Attach(RTCScene scene, const ShapeTable& shapes, int index) {
    const Shape& shape = shapes.shapes[index];
    if (shape.IsInvisible() || shape.PrimitiveCount() == 0) return;
    const Mesh* mesh = std::get_if<Mesh>(&shape.geometry);
    RTCGeometry geometry =
        rtcNewGeometry(device.get(), mesh ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
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
        rtcSetGeometryUserPrimitiveCount(geometry, shape.PrimitiveCount());
        std::visit(
            [&]<typename S>(const S&) {
                if constexpr (!std::is_same_v<S, Mesh>) {
                    if (shape.coverage)
                        SetCallbacks<S, Passing::Uncovered>(geometry);
                    else if (shape.hiddenFrom)
                        SetCallbacks<S, Passing::Hidden>(geometry);
                    else
                        SetCallbacks<S, Passing::None>(geometry);
                }
            },
            shape.geometry);
    }
    if (mesh && shape.alpha)
        rtcSetGeometryIntersectFilterFunction(geometry, FilterBy<IsCutOut<false>>);
    if (mesh && (shape.alpha || shape.shadowAlpha))
        rtcSetGeometryOccludedFilterFunction(geometry, FilterBy<IsCutOut<true>>);
    const bool isUsual = !shape.hiddenFrom && shape.coverage && shape.coverage->IsWhole() &&
                         !shape.coverage->openBehind;
    if (mesh && isUsual) {  // as most meshes of glTF: shadow rays need no filter
        rtcSetGeometryIntersectFilterFunction(geometry, FilterBy<IsBehindSingleSided>);
    } else if (mesh && (shape.coverage || shape.hiddenFrom)) {
        rtcSetGeometryIntersectFilterFunction(geometry, FilterBy<IsUncovered>);
        rtcSetGeometryOccludedFilterFunction(geometry, FilterBy<IsUncovered>);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, unsigned(index));
    rtcReleaseGeometry(geometry);
}

void Accelerator::Implementation::AttachInstance(const Instance& instance, int index) {
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, objects[instance.object].get());
    const Eigen::Matrix<float, 3, 4> m =
        instance.worldFromInstance.topRows<3>().cast<float>();  // column-major
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(world.get(), geometry, unsigned(shapeCount + index));
    rtcReleaseGeometry(geometry);
}

void Accelerator::Implementation::AttachMoving(const ShapeTable& shapes, int index) {
    const Instance& instance = shapes.instances[index];
    movingUsers.push_back(std::make_unique<MovingUser>(MovingUser{
        &shapes, index, objects[instance.object].get(),
        BoundMotion(shapes.motions[instance.motion], shapes.ObjectBounds(instance.object))}));
    movingUsers.back()->Attach(device.get(), world.get(), unsigned(shapeCount + index));
}

Accelerator::Accelerator() = default;
Accelerator::~Accelerator() = default;
Accelerator::Accelerator(Accelerator&&) noexcept = default;
Accelerator& Accelerator::operator=(Accelerator&&) noexcept = default;

Accelerator::Accelerator(const ShapeTable& shapes, const TextureTable& textures)
    : implementation(std::make_unique<Implementation>()) {
    Implementation& impl = *implementation;
    // A number of threads for the device would limit oneTBB as long as it lives.
    impl.device.reset(rtcNewDevice(nullptr));
    if (!impl.device)
        throw Error(rtcGetDeviceError(nullptr) == RTC_ERROR_UNSUPPORTED_CPU
                        ? "Embree does not support this processor"
                        : "Embree cannot be started: there is not enough memory");
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
        if (shapes.instances[i].motion < 0)
            impl.AttachInstance(shapes.instances[i], int(i));
        else
            impl.AttachMoving(shapes, int(i));
    rtcCommitScene(impl.world.get());
}

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
