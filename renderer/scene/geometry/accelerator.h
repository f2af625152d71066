// Intersects rays with the scene. With accelerator_internal.h the only place that knows Embree.
#pragma once

#include <memory>

#include "renderer/scene/geometry/shape_table.h"

namespace lull {

class Accelerator {
  public:
    Accelerator();
    ~Accelerator();
    Accelerator(Accelerator&&) noexcept;
    Accelerator& operator=(Accelerator&&) noexcept;

    // Builds over the shapes, on as many threads as RunWithThreads() allows. `shapes` and
    // `textures` must outlive it and stay where they are. Throws Error when memory runs out.
    Accelerator(const ShapeTable& shapes, const TextureTable& textures);

    // Finds the nearest hit in (0, ray.tMax) at `time`, from 0 where the shutter opens to 1.
    bool Intersect(const Ray& ray, Hit* hit, float time = 0, RayKind = kOtherRay) const;

    // Returns whether anything lies in (0, ray.tMax) of a shadow ray at `time`.
    bool Occluded(const Ray& ray, float time = 0) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
};

}  // namespace lull
