#include "renderer/scene/geometry/shapes/quadric.h"

#include "renderer/scene/geometry/animated_transform.h"

namespace lull {
namespace {

using Eigen::Vector3d;

double Radius2(const Revolved& shape, double z) {
    return shape.r2[0] + z * (shape.r2[1] + z * shape.r2[2]);
}

// Returns x^2 + y^2 - r2(z), which is 0 on the surface, and half its gradient.
double Implicit(const Revolved& shape, const Vector3d& p) {
    return p.x() * p.x() + p.y() * p.y() - Radius2(shape, p.z());
}
Vector3d HalfGradient(const Revolved& shape, const Vector3d& p) {
    return {p.x(), p.y(), -0.5 * shape.r2[1] - shape.r2[2] * p.z()};
}

double HeightToV(const Revolved& shape, double z) {
    return (z - shape.start.z()) / (shape.end.z() - shape.start.z());
}

struct CurvePoint {
    Vector3d p, dp, d2p;
};
CurvePoint Curve(const Revolved& shape, double z) {
    const double dz = shape.end.z() - shape.start.z();
    if (!shape.isParabola) {
        const double v = HeightToV(shape, z);
        return {(1 - v) * shape.start + v * shape.end, shape.end - shape.start, Vector3d::Zero()};
    }
    // x = sqrt(r2[1] z), whose derivatives are infinite at the tip.
    const double x = std::sqrt(shape.r2[1] * std::max(z, 1e-12 * std::abs(shape.zMax)));
    const double slope = 0.5 * shape.r2[1] / x;
    return {{x, 0, z}, {slope * dz, 0, dz}, {-slope * slope / x * dz * dz, 0, 0}};
}

double AzimuthFromCurve(const Revolved& shape, const Vector3d& p) {
    const Vector3d c = Curve(shape, p.z()).p;
    const double phi = std::atan2(c.x() * p.y() - p.x() * c.y(), p.x() * c.x() + p.y() * c.y());
    return phi < 0 ? phi + 2 * std::numbers::pi : phi;
}

bool IsClipped(const Revolved& shape, const Vector3d& p) {
    return !(p.z() >= shape.zMin && p.z() <= shape.zMax) ||
           (shape.phiMax < 2 * kPi && AzimuthFromCurve(shape, p) > double(shape.phiMax));
}

// Sets the members that follow from the curve: the heights, and the side of dpdu x dpdv.
Revolved Finished(Revolved shape) {
    shape.zMin = std::min(shape.start.z(), shape.end.z());
    shape.zMax = std::max(shape.start.z(), shape.end.z());
    const CurvePoint c = Curve(shape, 0.5 * (shape.zMin + shape.zMax));
    const Vector3d dpdu(-c.p.y(), c.p.x(), 0);
    shape.normalSign = dpdu.cross(c.dp).dot(HalfGradient(shape, c.p)) < 0 ? -1 : 1;
    return shape;
}

double LargestRadius2(const Revolved& shape) {
    if (shape.isOnSurface)
        return std::max(shape.start.head<2>().squaredNorm(), shape.end.head<2>().squaredNorm());
    const double middle = std::clamp(0., shape.zMin, shape.zMax);  // where r2 has its extremum
    return std::max(
        {Radius2(shape, shape.zMin), Radius2(shape, middle), Radius2(shape, shape.zMax)});
}

Revolved TurnedLine(const Vector3d& start, const Vector3d& end, float phiMax) {
    Revolved shape;
    shape.start = start;
    shape.end = end;
    shape.phiMax = phiMax;
    // Substitute v = (z - z0) / dz in |start + v (end - start)|^2 across the axis.
    const double dz = end.z() - start.z();
    const Eigen::Vector2d slope = (end - start).head<2>() / dz;
    const Eigen::Vector2d atZero = start.head<2>() - slope * start.z();
    shape.r2 = {atZero.squaredNorm(), 2 * atZero.dot(slope), slope.squaredNorm()};
    return Finished(shape);
}

// Returns r2 of pbrt-v3's hyperboloid, x^2 + y^2 = r2[0] + r2[2] z^2 through the circles of p2 and
// of a second point of the line from p1: the first of p1 + 2 k (p2 - p1) for which float can tell
// the surface from a cone. Nothing where there is none, as for lines through the origin, with which
// pbrt-v3 does not end, or where the circles have the same distance from z = 0.
std::optional<Vector3d> PbrtHyperboloid(const Vector3d& p1, const Vector3d& p2) {
    constexpr int kMost = 32;
    const double r2 = p2.head<2>().squaredNorm(), z2 = p2.z() * p2.z();
    for (int k = 1; k <= kMost; ++k) {
        const Vector3d q = p1 + 2 * k * (p2 - p1);
        const double qr2 = q.head<2>().squaredNorm(), qz2 = q.z() * q.z();
        if (qz2 == z2) return {};
        if (qr2 == 0 || float(r2 * qz2 / (qr2 * z2)) == 1) continue;
        return Vector3d((qr2 * z2 - r2 * qz2) / (z2 - qz2), 0, (qr2 - r2) / (qz2 - z2));
    }
    return {};
}

}  // namespace

Revolved MakeCylinder(float radius, float zMin, float zMax, float phiMax) {
    return TurnedLine({radius, 0, std::min(zMin, zMax)}, {radius, 0, std::max(zMin, zMax)}, phiMax);
}

Revolved MakeCone(float radius, float height, float phiMax) {
    return TurnedLine({radius, 0, 0}, {0, 0, height}, phiMax);
}

Revolved MakeParaboloid(float radius, float zMin, float zMax, float phiMax) {
    Revolved shape;
    shape.isParabola = true;
    shape.phiMax = phiMax;
    if (zMin > zMax) std::swap(zMin, zMax);
    shape.r2 = {0, double(radius) * radius / zMax, 0};
    shape.start = {std::sqrt(std::max(0., shape.r2[1] * zMin)), 0, zMin};
    shape.end = {radius, 0, zMax};
    return Finished(shape);
}

Revolved MakeHyperboloid(const Vec3f& p1, const Vec3f& p2, float phiMax) {
    // pbrt-v3 swaps the ends here, which turns the surface inside out.
    const bool swaps = p2.z() == 0;
    const Vector3d a = p1.cast<double>(), b = p2.cast<double>();
    Revolved shape = swaps ? TurnedLine(b, a, phiMax) : TurnedLine(a, b, phiMax);
    if (const auto r2 = PbrtHyperboloid(shape.start, shape.end)) {
        shape.r2 = *r2;
        shape.isOnSurface = false;
    }
    return shape;
}

bool HasArea(const Revolved& shape) {
    const double radius =
        std::max(shape.start.head<2>().squaredNorm(), shape.end.head<2>().squaredNorm());
    return shape.zMax > shape.zMin && radius > 0 && shape.phiMax > 0 && shape.r2.allFinite() &&
           std::isfinite(shape.zMax - shape.zMin) && (!shape.isParabola || shape.zMax > 0);
}

Bounds3f Revolved::WorldBounds() const {
    const auto r = float(std::sqrt(LargestRadius2(*this)));
    return TransformBox(place.worldFromShape,
                        {Vec3f(-r, -r, float(zMin)), Vec3f(r, r, float(zMax))});
}

float Revolved::Area() const {
    return float(start.head<2>().norm() * (zMax - zMin) * double(phiMax));
}

std::optional<float> Intersect(const Revolved& shape, const Ray& worldRay) {
    const ShapeRay ray(shape.place, worldRay);
    const Vector3d &o = ray.o, &d = ray.d;
    const double a = d.x() * d.x() + d.y() * d.y() - shape.r2[2] * d.z() * d.z();
    const double halfB = d.dot(HalfGradient(shape, o));
    const double c = Implicit(shape, o);
    const double discriminant = halfB * halfB - a * c;
    if (!(discriminant >= 0)) return {};
    // Where a is 0 the ray meets the surface once, and the other root is infinite.
    const double q = -(halfB + std::copysign(std::sqrt(discriminant), halfB));
    double t0 = q / a, t1 = q != 0 ? c / q : 0;
    if (t0 > t1) std::swap(t0, t1);
    for (const double t : {t0, t1})
        if (t > 0 && t < double(worldRay.tMax) && !IsClipped(shape, ray(t))) return float(t);
    return {};
}

void Interact(const Revolved& shape, const Ray& worldRay, const Hit& found, SurfaceNeeds needs,
              SurfaceInteraction* hit) {
    // Carry the point back onto the surface, off which the rounding of t has put it.
    Vector3d p = ShapeRay(shape.place, worldRay)(found.t);
    for (int step = 0; step < 2; ++step) {
        const Vector3d g = HalfGradient(shape, p);
        const double g2 = g.squaredNorm();
        if (g2 > 0) p -= (0.5 * Implicit(shape, p) / g2) * g;
    }
    const CurvePoint c = Curve(shape, p.z());
    const double phi = AzimuthFromCurve(shape, p), phiMax = double(shape.phiMax);
    const double cosPhi = std::cos(phi), sinPhi = std::sin(phi);
    const auto turned = [&](const Vector3d& w) {
        return Vector3d(cosPhi * w.x() - sinPhi * w.y(), sinPhi * w.x() + cosPhi * w.y(), w.z());
    };
    const Vector3d dpdu(-phiMax * p.y(), phiMax * p.x(), 0), dpdv = turned(c.dp);
    Vector3d gradient = shape.normalSign * HalfGradient(shape, p);
    if (!shape.isOnSurface)
        if (const Vector3d cross = dpdu.cross(dpdv); cross.squaredNorm() > 0) gradient = cross;
    if (!(gradient.squaredNorm() > 0)) gradient = Vector3d(0, 0, 1);  // the tip of a cone
    const double length = gradient.norm();
    const Vector3d n = gradient / length;

    hit->uv = {float(phi / phiMax), float(HeightToV(shape, p.z()))};
    hit->dndu = hit->dndv = Vec3f::Zero();
    if (needs & kNeedsNormalDerivatives) {
        // Differentiate the unit gradient, whose own derivative is diagonal, or that cross product.
        const auto ofUnit = [&](const Vector3d& dg) -> Vec3f {
            const Vec3f dn = ((dg - n * n.dot(dg)) / length).cast<float>();
            return dn.allFinite() ? dn : Vec3f(Vec3f::Zero());
        };
        const auto ofGradient = [&](const Vector3d& dp) {
            return Vector3d(shape.normalSign * Vector3d(dp.x(), dp.y(), -shape.r2[2] * dp.z()));
        };
        const Vector3d duu = -phiMax * phiMax * Vector3d(p.x(), p.y(), 0);
        const Vector3d duv = phiMax * Vector3d(-dpdv.y(), dpdv.x(), 0);
        hit->dndu = ofUnit(shape.isOnSurface ? ofGradient(dpdu)
                                             : Vector3d(duu.cross(dpdv) + dpdu.cross(duv)));
        hit->dndv = ofUnit(shape.isOnSurface ? ofGradient(dpdv) : Vector3d(duv.cross(dpdv)));
    }
    hit->dpdu = dpdu.cast<float>();
    hit->dpdv = dpdv.cast<float>();
    const Vec3f point = p.cast<float>();
    FinishQuadricHit(shape.place, point, Gamma(5) * point.cwiseAbs(), n.cast<float>(), needs, hit);
}

ShapeSample SampleArea(const Revolved& shape, const Vec2f& u) {
    const auto z = float((1 - u.x()) * shape.zMin + u.x() * shape.zMax);
    const float phi = u.y() * shape.phiMax, radius = float(shape.start.x());
    const Vec3f p(radius * std::cos(phi), radius * std::sin(phi), z);
    return SampleAt(shape.place, p, Gamma(5) * p.cwiseAbs(), Vec3f(p.x(), p.y(), 0),
                    1 / shape.Area());
}

std::optional<ShapeSample> Sample(const Revolved& shape, const Vec3f& from, const Vec2f& u) {
    return SeenFrom(from, SampleArea(shape, u));
}

float Pdf(const Revolved& shape, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    return SolidAnglePdf(1 / shape.Area(), from, p, n);
}

}  // namespace lull
