// Owns the geometry of a scene: shapes, object definitions and instances.
#pragma once

#include <vector>

#include "renderer/scene/geometry/animated_transform.h"
#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/materials/material.h"

namespace lull {

// A range of ShapeTable::shapes that is placed as a whole.
struct Object {
    int firstShape = 0, shapeCount = 0;
};

struct Instance {
    int object = -1;
    int motion = -1;                             // into ShapeTable::motions; -1: does not move
    Mat4d worldFromInstance, instanceFromWorld;  // of one that moves: when the shutter opens
    int entity = -1;                             // into Description::instances
};

struct ShapeTable {
    std::vector<Shape> shapes;  // those of the world, then those of the objects
    int worldShapeCount = 0;
    std::vector<Object> objects;
    std::vector<Instance> instances;
    std::vector<std::vector<AnimatedTransform>> motions;  // each outermost first
    Bounds3f bounds;                                      // of everything placed, world
    // The distance from the origin within which all else has to lie that rays start from or go to,
    // so that they can be followed into all instances.
    float reach = kFarthest;

    // Makes every shape, loading meshes. Unknown kinds and meshes that cannot be read are left out
    // as a substitute. Zero-area triangles are dropped with a counted warning. Errors of shapes are
    // kept in the warnings; throws Error for instances. Lights come later.
    ShapeTable(const Description&, const TextureTable&, Warnings&);
    ShapeTable() = default;

    size_t TriangleCount() const;  // instances counted as often as they are placed

    // Fills in the interaction at a hit of `ray`, all but the fields that `needs` leaves out.
    // `time` is the ray's, from 0 where the shutter opens to 1; only moving objects use it.
    void Interact(const Ray& ray, const Hit& hit, SurfaceNeeds needs,
                  SurfaceInteraction* interaction, float time = 0) const;

    // Returns the instance, which moves, as it stands at `time`.
    Instance InstanceAt(const Instance& instance, float time) const;
    // Returns where an object's shapes are, in its own space.
    Bounds3f ObjectBounds(int object) const;

    // Returns the light whose surface was hit, -1 for none.
    int LightAt(const Hit& hit) const {
        const int first = shapes[hit.shape].firstLight;
        return first < 0 ? -1 : first + int(hit.primitive);
    }

    // Returns the texture coordinates of a hit, for alpha textures.
    Vec2f Uv(int shape, uint32_t primitive, float b1, float b2) const;

  private:
    void AddInstances(const Description&, std::span<const Bounds3f> objectBounds, Warnings&);
    void AddMotion(const Description&, const InstanceEntity&, const Shutter&, Instance*, Warnings&);
    void LimitReach(std::span<const FileLoc> placesOfInstances);
    // `instance` is null for shapes of the world itself.
    void InteractIn(const Instance* instance, const Ray&, const Hit&, SurfaceNeeds,
                    SurfaceInteraction*) const;
};

// Carries a ray from the world into the space of the instance; its parameter stays the same.
Ray IntoInstance(const Instance& instance, const Ray& ray);

}  // namespace lull
