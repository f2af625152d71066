#include <tuple>

#include "renderer/base/sampling.h"
#include "renderer/scene/geometry/shapes/quadric_internal.h"

namespace lull {
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
// Returns theta where v is 0 and where it is 1.
std::pair<float, float> Thetas(const Sphere& sphere) {
    return {Theta(sphere, std::min(sphere.zMin, sphere.zMax)),
            Theta(sphere, std::max(sphere.zMin, sphere.zMax))};
}

// Computes the derivatives at p of position and, where asked for, normal, in shape space.
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
    return TransformBounds(place.worldFromShape, Vec3f(-radius, -radius, zMin),
                           Vec3f(radius, radius, zMax));
}

std::optional<float> Intersect(const Sphere& sphere, const Ray& worldRay) {
    // Solve |o + t d|^2 = r^2 about the point of closest approach: the discriminant is formed from
    // the distance there, which is stable for far origins (Haines et al. 2019, Ray Tracing Gems,
    // chapter 7).
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
    const Vec3f center = Center(sphere);
    ShapeSample sample;
    if (!IsWhole(sphere)) {
        sample = SampleArea(sphere, u);
        sample.pdf = SolidAnglePdf(1 / sphere.Area(), from, sample.p, sample.n);
        if (!(sample.pdf > 0)) return {};
        return sample;
    }
    if (IsInside(sphere, from)) {
        const Vec3f p = sphere.radius * SampleUniformSphere(u);
        std::tie(sample.p, sample.pError) =
            TransformWithError(sphere.place.worldFromShape, p, Gamma(5) * p.cwiseAbs());
        sample.n = TransformNormal(sphere.place.shapeFromWorld, p).normalized();
        sample.pdf = SolidAnglePdf(1 / sphere.Area(), from, sample.p, sample.n);
    } else {
        // Sample the cone that the sphere subtends (pbrt 3rd ed., 14.2.2, in 1 - cos, which
        // keeps its digits for small cones).
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
        sample.n = -(sinAlpha * cosPhi * s + sinAlpha * sinPhi * t + cosAlpha * axis);
        sample.p = center + sphere.radius * sample.n;
        sample.pError = Gamma(5) * sample.p.cwiseAbs();
        sample.pdf = 1 / (2 * kPi * oneMinusCosMax);
    }
    if (sphere.place.reverseOrientation) sample.n = -sample.n;
    if (!(sample.pdf > 0) || !std::isfinite(sample.pdf)) return {};
    return sample;
}

ShapeSample SampleArea(const Sphere& sphere, const Vec2f& u) {
    const float z = Lerp(u.x(), sphere.zMin, sphere.zMax), phi = u.y() * sphere.phiMax;
    const float r = SafeSqrt(Sqr(sphere.radius) - Sqr(z));
    const Vec3f p(r * std::cos(phi), r * std::sin(phi), z);
    ShapeSample sample;
    std::tie(sample.p, sample.pError) =
        TransformWithError(sphere.place.worldFromShape, p, Gamma(5) * p.cwiseAbs());
    sample.n = TransformNormal(sphere.place.shapeFromWorld, p).normalized();
    if (sphere.place.reverseOrientation) sample.n = -sample.n;
    sample.pdf = 1 / sphere.Area();
    return sample;
}

float Pdf(const Sphere& sphere, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    if (!IsWhole(sphere) || IsInside(sphere, from))
        return SolidAnglePdf(1 / sphere.Area(), from, p, n);
    const float sin2Max = Sqr(sphere.radius) / (Center(sphere) - from).squaredNorm();
    const float pdf = 1 / (2 * kPi * OneMinusCosMax(sin2Max));
    return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace lull
