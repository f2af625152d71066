#include "renderer/scene/accelerator_internal.h"

namespace lull {

bool Accelerator::Intersect(const Ray& ray, Hit* hit) const {
    return FindNearest(*implementation, ray, hit);
}

bool Accelerator::Occluded(const Ray& ray) const { return IsOccluded(*implementation, ray); }

}  // namespace lull
