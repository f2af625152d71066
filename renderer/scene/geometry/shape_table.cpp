#include "renderer/scene/geometry/shape_table.h"

#include <fmt/format.h>

#include "renderer/scene/geometry/shapes/shape_factory.h"

namespace lull {
namespace {

// Refuses points that no ray reaches. `what` is the grammatical subject.
void CheckReach(const Bounds3f& bounds, const FileLoc& loc, const std::string& what) {
    if (!(Farthest(bounds) <= double(kFarthest)))
        throw Error(loc,
                    "{} reaches farther than {:g} from the origin, where no ray is traced; scale "
                    "the scene down",
                    what, kFarthest);
}

void Place(const Instance& instance, SurfaceInteraction* hit) {
    // The transform itself is rounded to float where rays go through it, so its error counts with
    // the size of the summands (pbrt 3rd ed., 3.9.4).
    const Mat4d& m = instance.worldFromInstance;
    const Vec3f p = TransformPoint(m, hit->p);
    const Eigen::Matrix3f magnitude = m.topLeftCorner<3, 3>().cwiseAbs().cast<float>();
    hit->pError = magnitude * (hit->pError + Gamma(3) * hit->p.cwiseAbs()) +
                  Gamma(3) * m.topRightCorner<3, 1>().cwiseAbs().cast<float>();
    hit->p = p;
    hit->n = TransformNormal(instance.instanceFromWorld, hit->n).normalized();
    hit->ns = TransformNormal(instance.instanceFromWorld, hit->ns).normalized();
    hit->ns = FaceForward(hit->ns, hit->n);
    hit->dpdu = TransformVector(m, hit->dpdu);
    hit->dpdv = TransformVector(m, hit->dpdv);
    hit->surfaceDpdu = TransformVector(m, hit->surfaceDpdu);
    hit->surfaceDpdv = TransformVector(m, hit->surfaceDpdv);
    hit->dndu = TransformNormal(instance.instanceFromWorld, hit->dndu);
    hit->dndv = TransformNormal(instance.instanceFromWorld, hit->dndv);
}

}  // namespace

Ray IntoInstance(const Instance& instance, const Ray& ray) {
    return {TransformPoint(instance.instanceFromWorld, ray.o),
            TransformVector(instance.instanceFromWorld, ray.d), ray.tMax};
}

ShapeTable::ShapeTable(const Description& description, const TextureTable& textures,
                       Warnings& warnings) {
    // Returns the bounds of the new shape.
    const auto add = [&](const ShapeEntity& entity) {
        Shape shape;
        Bounds3f b;
        warnings.Try([&] {
            shape = MakeShape(description, entity, textures, warnings);
            b = shape.WorldBounds();
            CheckReach(b, entity.loc, "Shape \"" + entity.name + "\"");
        });
        shapes.push_back(std::move(shape));
        return b;
    };
    for (const ShapeEntity& entity : description.shapes) bounds.Extend(add(entity));
    worldShapeCount = int(shapes.size());
    std::vector<Bounds3f> objectBounds;
    for (const ObjectEntity& object : description.objects) {
        objects.push_back({int(shapes.size()), int(object.shapes.size())});
        objectBounds.emplace_back();
        for (const ShapeEntity& entity : object.shapes) objectBounds.back().Extend(add(entity));
    }
    AddInstances(description, objectBounds, warnings);
}

void ShapeTable::AddInstances(const Description& description,
                              std::span<const Bounds3f> objectBounds, Warnings& warnings) {
    std::vector<FileLoc> places;
    const Shutter shutter = ReadShutter(description.camera);
    for (const InstanceEntity& entity : description.instances) {
        const Bounds3f& b = objectBounds[entity.object];
        if (b.IsEmpty()) continue;
        Instance instance{entity.object, -1, entity.worldFromInstance, Mat4d::Identity(),
                          int(&entity - description.instances.data())};
        if (entity.motion >= 0) AddMotion(description, entity, shutter, &instance, warnings);
        instance.instanceFromWorld = instance.worldFromInstance.inverse();
        if (!instance.instanceFromWorld.allFinite())
            throw Error(entity.loc, "the instance's transform cannot be inverted");
        instances.push_back(instance);
        places.push_back(entity.loc);
        Bounds3f placed;
        if (instance.motion < 0)
            placed = TransformBox(instance.worldFromInstance, b);
        else
            for (const Bounds3f& box : BoundMotion(motions[instance.motion], b)) placed.Extend(box);
        CheckReach(placed, entity.loc, "the instance");
        bounds.Extend(placed);
    }
    LimitReach(places);
}

// Embree carries rays into instances at rest itself, and takes them as they come out.
void ShapeTable::LimitReach(std::span<const FileLoc> placesOfInstances) {
    for (size_t i = 0; i < instances.size(); ++i) {
        if (instances[i].motion >= 0) continue;
        const double through = ReachThrough(instances[i].instanceFromWorld);
        if (!(through >= Farthest(bounds)) || !IsInvertibleInFloats(instances[i].worldFromInstance))
            throw Error(placesOfInstances[i],
                        "the instance's transform changes sizes so much that no ray could be "
                        "followed into it; give the object itself another size");
        reach = std::min(reach, float(through));
    }
}

// Gives an instance its motion in the description, or the place where it is all the time.
void ShapeTable::AddMotion(const Description& description, const InstanceEntity& entity,
                           const Shutter& shutter, Instance* instance, Warnings& warnings) {
    const auto& [startTime, endTime] = description.transformTimes;
    std::vector<AnimatedTransform> transforms;
    for (const TransformPair& pair : description.motions[entity.motion]) {
        if (Mirrors(pair.at[0]) != Mirrors(pair.at[1]))
            warnings.Add(entity.loc,
                         "motion from a pose to a mirrored one, which no rotation joins: it is "
                         "turned and flattened between them");
        transforms.emplace_back(pair.at[0], pair.at[1], startTime, endTime, shutter);
    }
    instance->worldFromInstance = ProductAt(transforms, 0);
    if (std::ranges::all_of(transforms, &AnimatedTransform::IsConstant)) return;
    instance->motion = int(motions.size());
    motions.push_back(std::move(transforms));
}

Bounds3f ShapeTable::ObjectBounds(int object) const {
    const auto [first, count] = objects[object];
    Bounds3f bounds;
    for (int i = first; i < first + count; ++i) bounds.Extend(shapes[i].WorldBounds());
    return bounds;
}

Instance ShapeTable::InstanceAt(const Instance& instance, float time) const {
    Instance moved = instance;
    moved.worldFromInstance = ProductAt(motions[instance.motion], time);
    moved.instanceFromWorld =
        Eigen::Affine3d(moved.worldFromInstance).inverse(Eigen::Affine).matrix();
    return moved;
}

size_t ShapeTable::TriangleCount() const {
    const auto triangles = [&](int first, int count) {
        size_t sum = 0;
        for (int i = first; i < first + count; ++i)
            if (shapes[i].IsMesh()) sum += shapes[i].PrimitiveCount();
        return sum;
    };
    size_t sum = triangles(0, worldShapeCount);
    for (const Instance& instance : instances)
        sum += triangles(objects[instance.object].firstShape, objects[instance.object].shapeCount);
    return sum;
}

void ShapeTable::Interact(const Ray& ray, const Hit& hit, SurfaceNeeds needs,
                          SurfaceInteraction* interaction, float time) const {
    const Instance* instance = hit.instance < 0 ? nullptr : &instances[hit.instance];
    if (!instance || instance->motion < 0)
        return InteractIn(instance, ray, hit, needs, interaction);
    const Instance moved = InstanceAt(*instance, time);
    InteractIn(&moved, ray, hit, needs, interaction);
}

void ShapeTable::InteractIn(const Instance* instance, const Ray& ray, const Hit& hit,
                            SurfaceNeeds needs, SurfaceInteraction* interaction) const {
    const Shape& shape = shapes[hit.shape];
    const Ray local = instance && !shape.IsMesh() ? IntoInstance(*instance, ray) : ray;
    Visit(shape.geometry,
          [&](const auto& s) { lull::Interact(s, local, hit, needs, interaction); });
    if ((needs & (kNeedsSecondUv | kNeedsColor)) && !shape.IsMesh()) {
        interaction->uv1 = interaction->uv;
        interaction->color = Rgb::Ones();
    }
    if (instance) Place(*instance, interaction);
    interaction->wo = -ray.d;
    interaction->material = shape.material;
    interaction->areaLight = LightAt(hit);
}

Vec2f ShapeTable::Uv(int shape, uint32_t primitive, float b1, float b2) const {
    const Mesh* mesh = std::get_if<Mesh>(&shapes[shape].geometry);
    return mesh ? mesh->Uv(primitive, b1, b2) : Vec2f(Vec2f::Zero());
}

}  // namespace lull
