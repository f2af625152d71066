#include "renderer/scene/shape_table.h"

#include <fmt/format.h>

#include "renderer/scene/shapes/shape_factory.h"

namespace lull {
namespace {

Bounds3f ShapeBounds(const Shape& shape) {
    return std::visit(
        [](const auto& geometry) {
            if constexpr (std::is_same_v<std::decay_t<decltype(geometry)>, Mesh>) {
                Bounds3f bounds;
                for (const auto& triangle : geometry.triangles)
                    for (const uint32_t v : triangle) bounds.Extend(geometry.p[v]);
                return bounds;
            } else {
                return geometry.WorldBounds();
            }
        },
        shape.geometry);
}

// Carries an interaction from the space of an object into the world.
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

Ray IntoInstance(const Instance& instance, const Ray& ray) {
    return {TransformPoint(instance.instanceFromWorld, ray.o),
            TransformVector(instance.instanceFromWorld, ray.d), ray.tMax};
}

}  // namespace

uint32_t Shape::PrimitiveCount() const {
    const Mesh* mesh = std::get_if<Mesh>(&geometry);
    return mesh ? uint32_t(mesh->triangles.size()) : 1;
}

ShapeTable::ShapeTable(const Description& description, const TextureTable& textures,
                       bool substitute, Warnings& warnings) {
    const auto add = [&](const ShapeEntity& entity) {
        shapes.push_back(MakeShape(description, entity, textures, substitute, warnings));
    };
    for (const ShapeEntity& entity : description.shapes) add(entity);
    worldShapeCount = int(shapes.size());
    std::vector<Bounds3f> objectBounds;
    for (const ObjectEntity& object : description.objects) {
        objects.push_back({int(shapes.size()), int(object.shapes.size())});
        for (const ShapeEntity& entity : object.shapes) add(entity);
        Bounds3f bounds;
        for (int i = objects.back().firstShape; i < int(shapes.size()); ++i)
            bounds.Extend(ShapeBounds(shapes[i]));
        objectBounds.push_back(bounds);
    }

    for (int i = 0; i < worldShapeCount; ++i) bounds.Extend(ShapeBounds(shapes[i]));
    for (const InstanceEntity& entity : description.instances) {
        const Bounds3f& b = objectBounds[entity.object];
        if (b.IsEmpty()) continue;
        instances.push_back(
            {entity.object, entity.worldFromInstance, entity.worldFromInstance.inverse()});
        if (!instances.back().instanceFromWorld.allFinite())
            throw Error(entity.loc, "the instance's transform cannot be inverted");
        for (int corner = 0; corner < 8; ++corner)
            bounds.Extend(TransformPoint(entity.worldFromInstance,
                                         Vec3f(corner & 1 ? b.lower.x() : b.upper.x(),
                                               corner & 2 ? b.lower.y() : b.upper.y(),
                                               corner & 4 ? b.lower.z() : b.upper.z())));
    }
}

size_t ShapeTable::TriangleCount() const {
    const auto triangles = [&](int first, int count) {
        size_t sum = 0;
        for (int i = first; i < first + count; ++i)
            if (const Mesh* mesh = std::get_if<Mesh>(&shapes[i].geometry))
                sum += mesh->triangles.size();
        return sum;
    };
    size_t sum = triangles(0, worldShapeCount);
    for (const Instance& instance : instances)
        sum += triangles(objects[instance.object].firstShape, objects[instance.object].shapeCount);
    return sum;
}

void ShapeTable::Interact(const Ray& ray, const Hit& hit, SurfaceNeeds needs,
                          SurfaceInteraction* interaction) const {
    const Shape& shape = shapes[hit.shape];
    if (const Mesh* mesh = std::get_if<Mesh>(&shape.geometry)) {
        mesh->Interact(hit.primitive, hit.b1, hit.b2, needs, interaction);
    } else {
        const Ray local = hit.instance < 0 ? ray : IntoInstance(instances[hit.instance], ray);
        if (const Sphere* sphere = std::get_if<Sphere>(&shape.geometry))
            lull::Interact(*sphere, local, hit.t, needs, interaction);
        else if (const Disk* disk = std::get_if<Disk>(&shape.geometry))
            lull::Interact(*disk, local, hit.t, needs, interaction);
        else
            lull::Interact(std::get<Revolved>(shape.geometry), local, hit.t, needs, interaction);
    }
    if ((needs & (kNeedsSecondUv | kNeedsColor)) && !std::holds_alternative<Mesh>(shape.geometry)) {
        interaction->uv1 = interaction->uv;
        interaction->color = Rgb::Ones();
    }
    if (hit.instance >= 0) Place(instances[hit.instance], interaction);
    interaction->wo = -ray.d;
    interaction->material = shape.material;
    interaction->areaLight = LightAt(hit);
}

Vec2f ShapeTable::Uv(int shape, uint32_t primitive, float b1, float b2) const {
    const Mesh* mesh = std::get_if<Mesh>(&shapes[shape].geometry);
    return mesh ? mesh->Uv(primitive, b1, b2) : Vec2f(Vec2f::Zero());
}

}  // namespace lull
