#include <tuple>

#include "renderer/base/sampling.h"
#include "renderer/scene/geometry/shapes/quadric_internal.h"

namespace lull {
namespace {

Vec3f SampledNormal(const Disk& disk) {
    const Vec3f n = TransformNormal(disk.place.shapeFromWorld, Vec3f(0, 0, 1)).normalized();
    return disk.place.reverseOrientation ? Vec3f(-n) : n;
}

}  // namespace

Bounds3f Disk::WorldBounds() const {
    return TransformBounds(place.worldFromShape, Vec3f(-radius, -radius, height),
                           Vec3f(radius, radius, height));
}

std::optional<float> Intersect(const Disk& disk, const Ray& worldRay) {
    const ShapeRay ray(disk.place, worldRay);
    if (ray.d.z() == 0) return {};
    const double t = (disk.height - ray.o.z()) / ray.d.z();
    if (!(t > 0 && t < worldRay.tMax)) return {};
    const Eigen::Vector3d p = ray(t);
    const double r2 = p.x() * p.x() + p.y() * p.y();
    if (r2 > Sqr(double(disk.radius)) || r2 < Sqr(double(disk.innerRadius))) return {};
    if (disk.phiMax < 2 * kPi && Azimuth(p.x(), p.y()) > disk.phiMax) return {};
    return float(t);
}

void Interact(const Disk& disk, const Ray& worldRay, const Hit& found, SurfaceNeeds needs,
              SurfaceInteraction* hit) {
    Vec3f p = ShapeRay(disk.place, worldRay)(found.t).cast<float>();
    p.z() = disk.height;
    const float r = std::max(std::hypot(p.x(), p.y()), 1e-20f);
    const float width = disk.radius - disk.innerRadius;
    hit->uv = {Azimuth(p.x(), p.y()) / disk.phiMax, (disk.radius - r) / width};
    if (p.x() == 0 && p.y() == 0) p.x() = r;  // any tangent will do at the centre
    hit->dpdu = {-disk.phiMax * p.y(), disk.phiMax * p.x(), 0};
    hit->dpdv = Vec3f(p.x(), p.y(), 0) * (-width / r);
    hit->dndu = hit->dndv = Vec3f::Zero();
    FinishQuadricHit(disk.place, p, Vec3f::Zero(), Vec3f::UnitZ(), needs, hit);
}

// Under a transform that mirrors, rays find the normal on the other side than samples.
NormalBounds Disk::Normals() const {
    return {SampledNormal(*this), 1, place.reverseOrientation != place.flipNormals};
}

ShapeSample SampleArea(const Disk& disk, const Vec2f& u) {
    const Vec2f d = disk.radius * SampleConcentricDisk(u);
    ShapeSample sample;
    std::tie(sample.p, sample.pError) = TransformWithError(
        disk.place.worldFromShape, Vec3f(d.x(), d.y(), disk.height), Vec3f::Zero());
    sample.n = SampledNormal(disk);
    sample.pdf = 1 / disk.Area();
    return sample;
}

std::optional<ShapeSample> Sample(const Disk& disk, const Vec3f& from, const Vec2f& u) {
    ShapeSample sample = SampleArea(disk, u);
    sample.pdf = SolidAnglePdf(1 / disk.Area(), from, sample.p, sample.n);
    if (!(sample.pdf > 0)) return {};
    return sample;
}

float Pdf(const Disk& disk, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    return SolidAnglePdf(1 / disk.Area(), from, p, n);
}

}  // namespace lull
