#include "renderer/scene/geometry/accelerator_internal.h"

namespace lull {

bool Accelerator::Intersect(const Ray& ray, Hit* hit, float time) const {
    return FindNearest(*implementation, ray, time, hit);
}

bool Accelerator::Occluded(const Ray& ray, float time) const {
    return IsOccluded(*implementation, ray, time);
}

}  // namespace lull
