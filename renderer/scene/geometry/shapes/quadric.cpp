#include "renderer/scene/geometry/shapes/quadric.h"

#include <tuple>

#include "renderer/base/sampling.h"
#include "renderer/scene/geometry/animated_transform.h"

namespace lull {

PointWithError TransformWithError(const Mat4d& m, const Vec3f& p, const Vec3f& error) {
    // Propagate the point's own error, to which double adds only the rounding to float.
    const Vec3f q = TransformPoint(m, p);
    const Vec3f propagated =
        (m.topLeftCorner<3, 3>().cwiseAbs() * error.cast<double>()).cast<float>();
    return {q, propagated + Gamma(3) * q.cwiseAbs()};
}

ShapeSample SampleAt(const QuadricPlacement& place, const Vec3f& p, const Vec3f& error,
                     const Vec3f& n, float pdf) {
    ShapeSample sample;
    std::tie(sample.p, sample.pError) = TransformWithError(place.worldFromShape, p, error);
    sample.n = TransformNormal(place.shapeFromWorld, n).normalized();
    if (place.reverseOrientation) sample.n = -sample.n;
    sample.pdf = pdf;
    return sample;
}

void FinishQuadricHit(const QuadricPlacement& place, const Vec3f& pShape, const Vec3f& errorShape,
                      const Vec3f& nShape, SurfaceNeeds needs, SurfaceInteraction* hit) {
    const Mat4d& m = place.worldFromShape;
    std::tie(hit->p, hit->pError) = TransformWithError(m, pShape, errorShape);
    hit->n = UnitOf(TransformNormal(place.shapeFromWorld, nShape));
    if (place.flipNormals) hit->n = -hit->n;
    hit->ns = hit->n;
    if (!(needs & (kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint))) return;
    hit->dpdu = TransformVector(m, hit->dpdu);
    hit->dpdv = TransformVector(m, hit->dpdv);
    hit->surfaceDpdu = hit->dpdu;
    hit->surfaceDpdv = hit->dpdv;
    hit->dndu = TransformNormal(place.shapeFromWorld, hit->dndu);
    hit->dndv = TransformNormal(place.shapeFromWorld, hit->dndv);
}

namespace {

bool IsClipped(const Sphere& sphere, const Eigen::Vector3d& p) {
    return (sphere.zMin > -sphere.radius && p.z() < sphere.zMin) ||
           (sphere.zMax < sphere.radius && p.z() > sphere.zMax) ||
           (sphere.phiMax < 2 * kPi && Azimuth(p.x(), p.y()) > sphere.phiMax);
}

bool IsWhole(const Sphere& sphere) {
    return sphere.zMin <= -sphere.radius && sphere.zMax >= sphere.radius &&
           sphere.phiMax >= 2 * kPi;
}

Vec3f Center(const Sphere& sphere) {
    return sphere.place.worldFromShape.topRightCorner<3, 1>().cast<float>();
}

// Takes points of the sphere itself as inside, whatever side rounding has put them on: the cone
// that the sphere subtends is a whole hemisphere there, and would hold nothing but the point.
bool IsInside(const Sphere& sphere, const Vec3f& p) {
    const Vec3f center = Center(sphere);
    const float rounding =
        Gamma(16) * (p.lpNorm<Eigen::Infinity>() + center.lpNorm<Eigen::Infinity>());
    return (p - center).squaredNorm() <= Sqr(sphere.radius + rounding);
}

// Returns 1 - cos of the half angle that the sphere subtends, without cancellation.
float OneMinusCosMax(float sin2Max) { return sin2Max / (1 + SafeSqrt(1 - sin2Max)); }

float Theta(const Sphere& sphere, float z) {
    return std::acos(std::clamp(z / sphere.radius, -1.f, 1.f));
}
std::pair<float, float> Thetas(const Sphere& sphere) {
    return {Theta(sphere, std::min(sphere.zMin, sphere.zMax)),
            Theta(sphere, std::max(sphere.zMin, sphere.zMax))};
}

void ComputeTangents(const Sphere& sphere, const Vec3f& p, SurfaceNeeds needs,
                     SurfaceInteraction* hit) {
    const float r = sphere.radius, zRadius = std::hypot(p.x(), p.y());
    const auto [first, last] = Thetas(sphere);
    const float dTheta = last - first, phiMax = sphere.phiMax;
    hit->dpdu = {-phiMax * p.y(), phiMax * p.x(), 0};
    hit->dpdv = dTheta * Vec3f(p.z() * p.x() / zRadius, p.z() * p.y() / zRadius, -zRadius);
    hit->dndu = hit->dndv = Vec3f::Zero();
    if (needs & kNeedsNormalDerivatives) {
        hit->dndu = hit->dpdu / r;
        hit->dndv = hit->dpdv / r;
    }
}

}  // namespace

Bounds3f Sphere::WorldBounds() const {
    return TransformBox(place.worldFromShape,
                        {Vec3f(-radius, -radius, zMin), Vec3f(radius, radius, zMax)});
}

std::optional<float> Intersect(const Sphere& sphere, const Ray& worldRay) {
    // Solve |o + t d|^2 = r^2 about the point of closest approach: the discriminant is formed from
    // the distance there, which is stable for far origins (Haines et al. 2019, Ray Tracing Gems 7).
    const ShapeRay ray(sphere.place, worldRay);
    const double a = ray.d.squaredNorm(), b = -ray.o.dot(ray.d);
    const double r = sphere.radius;
    const Eigen::Vector3d closest = ray.o + (b / a) * ray.d;
    const double discriminant = r * r - closest.squaredNorm();
    if (!(discriminant >= 0)) return {};
    const double c = ray.o.squaredNorm() - r * r;
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    double t0 = q != 0 ? c / q : 0, t1 = q / a;
    if (t0 > t1) std::swap(t0, t1);
    for (const double t : {t0, t1})
        if (t > 0 && t < worldRay.tMax && !IsClipped(sphere, ray(t))) return float(t);
    return {};
}

void Interact(const Sphere& sphere, const Ray& worldRay, const Hit& found, SurfaceNeeds needs,
              SurfaceInteraction* hit) {
    const float r = sphere.radius;
    Vec3f p = (ShapeRay(sphere.place, worldRay)(found.t).normalized() * double(r)).cast<float>();
    if (p.x() == 0 && p.y() == 0) p.x() = 1e-5f * r;
    if (needs & (kNeedsUv | kNeedsSecondUv)) {
        const auto [first, last] = Thetas(sphere);
        hit->uv = {Azimuth(p.x(), p.y()) / sphere.phiMax,
                   (Theta(sphere, p.z()) - first) / (last - first)};
    }
    if (needs & (kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint))
        ComputeTangents(sphere, p, needs, hit);
    FinishQuadricHit(sphere.place, p, Gamma(5) * p.cwiseAbs(), p / r, needs, hit);
}

std::optional<ShapeSample> Sample(const Sphere& sphere, const Vec3f& from, const Vec2f& u) {
    if (!IsWhole(sphere)) return SeenFrom(from, SampleArea(sphere, u));
    if (IsInside(sphere, from)) {
        const Vec3f p = sphere.radius * SampleUniformSphere(u);
        return SeenFrom(from,
                        SampleAt(sphere.place, p, Gamma(5) * p.cwiseAbs(), p, 1 / sphere.Area()));
    }
    // Sample the cone that the sphere subtends (pbrt 3rd ed., 14.2.2), in 1 - cos for its digits.
    const Vec3f center = Center(sphere);
    const float distance = (center - from).norm();
    const Vec3f axis = (center - from) / distance;
    Vec3f s, t;
    CoordinateSystem(axis, &s, &t);
    const float sinMax = sphere.radius / distance, sin2Max = Sqr(sinMax);
    const float oneMinusCosMax = OneMinusCosMax(sin2Max);
    const float x = oneMinusCosMax * u.x();  // 1 - cos(theta)
    const float sin2 = x * (2 - x);
    const float cosAlpha = sin2 / sinMax + (1 - x) * SafeSqrt(1 - sin2 / sin2Max);
    const float sinAlpha = SafeSqrt(1 - Sqr(cosAlpha));
    const auto [sinPhi, cosPhi] = SineCosineOfTurn(u.y());
    ShapeSample sample;
    sample.n = -(sinAlpha * cosPhi * s + sinAlpha * sinPhi * t + cosAlpha * axis);
    sample.p = center + sphere.radius * sample.n;
    sample.pError = Gamma(5) * sample.p.cwiseAbs();
    sample.pdf = 1 / (2 * kPi * oneMinusCosMax);
    if (sphere.place.reverseOrientation) sample.n = -sample.n;
    if (!(sample.pdf > 0) || !std::isfinite(sample.pdf)) return {};
    return sample;
}

ShapeSample SampleArea(const Sphere& sphere, const Vec2f& u) {
    const float z = Lerp(u.x(), sphere.zMin, sphere.zMax), phi = u.y() * sphere.phiMax;
    const float r = SafeSqrt(Sqr(sphere.radius) - Sqr(z));
    const Vec3f p(r * std::cos(phi), r * std::sin(phi), z);
    return SampleAt(sphere.place, p, Gamma(5) * p.cwiseAbs(), p, 1 / sphere.Area());
}

float Pdf(const Sphere& sphere, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    if (!IsWhole(sphere) || IsInside(sphere, from))
        return SolidAnglePdf(1 / sphere.Area(), from, p, n);
    const float sin2Max = Sqr(sphere.radius) / (Center(sphere) - from).squaredNorm();
    const float pdf = 1 / (2 * kPi * OneMinusCosMax(sin2Max));
    return std::isfinite(pdf) ? pdf : 0;
}

Bounds3f Disk::WorldBounds() const {
    return TransformBox(place.worldFromShape,
                        {Vec3f(-radius, -radius, height), Vec3f(radius, radius, height)});
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
    return {SampleArea(*this, Vec2f::Zero()).n, 1, place.reverseOrientation != place.flipNormals};
}

ShapeSample SampleArea(const Disk& disk, const Vec2f& u) {
    const Vec2f d = disk.radius * SampleConcentricDisk(u);
    return SampleAt(disk.place, Vec3f(d.x(), d.y(), disk.height), Vec3f::Zero(), Vec3f(0, 0, 1),
                    1 / disk.Area());
}

std::optional<ShapeSample> Sample(const Disk& disk, const Vec3f& from, const Vec2f& u) {
    return SeenFrom(from, SampleArea(disk, u));
}

float Pdf(const Disk& disk, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    return SolidAnglePdf(1 / disk.Area(), from, p, n);
}

}  // namespace lull
