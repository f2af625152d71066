// Tests cylinders, cones, paraboloids and hyperboloids against their parametric forms.
#include "renderer/scene/geometry/shapes/quadric.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/geometry/hit_at.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

using Eigen::Vector3d;
using test::Random;

constexpr float kSweep = 1.5f * kPi;

struct Example {
    std::string name;
    Revolved shape;
    std::function<Vector3d(double u, double v)> point;  // in shape space
};

Vector3d Turned(const Vector3d& p, double phi) {
    return {p.x() * std::cos(phi) - p.y() * std::sin(phi),
            p.x() * std::sin(phi) + p.y() * std::cos(phi), p.z()};
}

std::vector<Example> Examples() {
    const Vec3f p1(0.5f, -0.72f, -0.8f), p2(0.5f, 0.45f, 0.5f);  // its waist is at z = 0
    std::vector<Example> examples = {
        {"cylinder", MakeCylinder(0.7f, 0.9f, -0.4f, kSweep),
         [](double u, double v) {
             return Turned({0.7, 0, -0.4 + 1.3 * v}, u * kSweep);
         }},
        {"cone", MakeCone(0.8f, 1.5f, kSweep),
         [](double u, double v) {
             return Turned({0.8 * (1 - v), 0, 1.5 * v}, u * kSweep);
         }},
        {"paraboloid", MakeParaboloid(0.9f, 0.1f, 1.2f, kSweep),
         [](double u, double v) {
             const double z = 0.1 + 1.1 * v;
             return Turned({0.9 * std::sqrt(z / 1.2), 0, z}, u * kSweep);
         }},
        {"hyperboloid", MakeHyperboloid(p1, p2, kSweep),
         [=](double u, double v) {
             return Turned((1 - v) * p1.cast<double>() + v * p2.cast<double>(), u * kSweep);
         }},
    };
    for (Example& e : examples) {
        const Eigen::Affine3d place =
            Eigen::Translation3d(1, -2, 3) *
            Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 1, 0.3).normalized()) *
            Eigen::Scaling(1.5, 0.7, 2.0);
        e.shape.place.worldFromShape = place.matrix();
        e.shape.place.shapeFromWorld = place.inverse().matrix();
    }
    return examples;
}

Vec3f InWorld(const Example& e, const Vector3d& p) {
    return TransformPoint(e.shape.place.worldFromShape, p.cast<float>());
}

// A ray at a point of the surface meets it, or another of its points before; what is known of the
// hit is what the parametric form and its differences say.
TEST(Revolved, IsHitWhereItsParametersSay) {
    Random random(1);
    for (const Example& e : Examples()) {
        ASSERT_TRUE(HasArea(e.shape));
        int same = 0, grazing = 0;
        for (int i = 0; i < 5000; ++i) {
            const double u = random.Float(), v = 0.001 + 0.998 * random.Float();
            const Vec3f target = InWorld(e, e.point(u, v));
            const Vec3f from = target + 8 * random.Direction();
            const Ray ray{from, (target - from).normalized(), kInfinity};
            const auto t = Intersect(e.shape, ray);
            if (!t) {
                ++grazing;  // rounding has carried the ray past the surface
                continue;
            }
            ASSERT_LT(*t, 8.001f) << e.name;
            SurfaceInteraction hit;
            Interact(e.shape, ray, HitAt(*t), kNeedsNormalDerivatives, &hit);
            ASSERT_NEAR((hit.p - (ray.o + *t * ray.d)).norm(), 0, 1e-5);
            const double hu = hit.uv.x(), hv = hit.uv.y();
            ASSERT_TRUE(hu >= -1e-5 && hu <= 1.00001 && hv >= -1e-4 && hv <= 1.0001) << e.name;
            ASSERT_NEAR((InWorld(e, e.point(hu, hv)) - hit.p).norm(), 0, 1e-4) << e.name;
            if (*t > 7.999f) ++same;
            if (hv < 0.01 || hv > 0.99) continue;  // the cone's tip and the differences' ends

            const double h = 1e-4;
            const auto worldVector = [&](const Vector3d& d) {
                return TransformVector(e.shape.place.worldFromShape, d.cast<float>());
            };
            const Vec3f du = worldVector((e.point(hu + h, hv) - e.point(hu - h, hv)) / (2 * h));
            const Vec3f dv = worldVector((e.point(hu, hv + h) - e.point(hu, hv - h)) / (2 * h));
            ASSERT_NEAR((hit.dpdu - du).norm(), 0, 2e-3 * du.norm()) << e.name;
            ASSERT_NEAR((hit.dpdv - dv).norm(), 0, 2e-3 * dv.norm()) << e.name;
            ASSERT_GT(hit.n.dot(du.cross(dv).normalized()), 0.9999) << e.name;
        }
        EXPECT_GT(same, 1000) << e.name;
        EXPECT_LT(grazing, 25) << e.name;
    }
}

// The derivatives of the normal, in shape space, where it is unit.
TEST(Revolved, KnowsHowItsNormalTurns) {
    for (Example& e : Examples()) {
        e.shape.place = {};
        Random random(2);
        const auto normal = [&](double u, double v) {
            const double h = 1e-5;
            const Vector3d du = e.point(u + h, v) - e.point(u - h, v);
            const Vector3d dv = e.point(u, v + h) - e.point(u, v - h);
            return Vector3d(du.cross(dv).normalized());
        };
        for (int i = 0; i < 300; ++i) {
            const double u = 0.05 + 0.9 * random.Float(), v = 0.1 + 0.8 * random.Float();
            const Vec3f p = e.point(u, v).cast<float>(), n = normal(u, v).cast<float>();
            const Ray ray{p + 0.01f * n, -n, kInfinity};
            SurfaceInteraction hit;
            const auto t = Intersect(e.shape, ray);
            ASSERT_TRUE(t) << e.name;
            Interact(e.shape, ray, HitAt(*t), kNeedsNormalDerivatives, &hit);
            const double h = 1e-3;
            const Vec3f dndu = ((normal(u + h, v) - normal(u - h, v)) / (2 * h)).cast<float>();
            const Vec3f dndv = ((normal(u, v + h) - normal(u, v - h)) / (2 * h)).cast<float>();
            ASSERT_NEAR((hit.dndu - dndu).norm(), 0, 5e-3 * (1 + dndu.norm())) << e.name;
            ASSERT_NEAR((hit.dndv - dndv).norm(), 0, 5e-3 * (1 + dndv.norm())) << e.name;
        }
    }
}

// What pbrt-v3 computes of its hyperboloid: ah (x^2 + y^2) - ch z^2 = 1, and what its line says.
struct PbrtHyperboloid {
    Vector3d p1, p2;
    double phiMax, ah, ch;

    PbrtHyperboloid(const Vector3d& a, const Vector3d& b, double phiMax)
        : p1(b.z() == 0 ? b : a), p2(b.z() == 0 ? a : b), phiMax(phiMax) {
        const double xy2 = p2.head<2>().squaredNorm(), zz2 = p2.z() * p2.z();
        Vector3d pp = p1;
        do {
            pp += 2 * (p2 - p1);
            const double ratio = pp.z() * pp.z() / (pp.head<2>().squaredNorm() * zz2);
            ah = (1 / pp.head<2>().squaredNorm() - ratio) / (1 - xy2 * ratio);
            ch = (ah * xy2 - 1) / zz2;
        } while (!std::isfinite(ah));
    }

    struct At {
        double t, u, v;
        Vector3d p, dpdu, dpdv;
    };
    std::optional<At> Intersect(const Vector3d& o, const Vector3d& d) const {
        const Vector3d scale(ah, ah, -ch);
        const double a = d.cwiseProduct(scale).dot(d), b = 2 * d.cwiseProduct(scale).dot(o);
        const double c = o.cwiseProduct(scale).dot(o) - 1, root = std::sqrt(b * b - 4 * a * c);
        const double t0 = (-b - root) / (2 * a), t1 = (-b + root) / (2 * a);
        for (const double t : {std::min(t0, t1), std::max(t0, t1)}) {
            const Vector3d p = o + t * d;
            const double v = (p.z() - p1.z()) / (p2.z() - p1.z());
            const Vector3d pr = (1 - v) * p1 + v * p2;
            double phi = std::atan2(p.y(), p.x()) - std::atan2(pr.y(), pr.x());
            while (phi < 0) phi += 2 * std::numbers::pi;
            if (t > 0 && v >= 0 && v <= 1 && phi <= phiMax)
                return At{t,
                          phi / phiMax,
                          v,
                          p,
                          {-phiMax * p.y(), phiMax * p.x(), 0},
                          Turned(p2 - p1, phi)};
        }
        return {};
    }
    // The coefficients of the fundamental forms, with which pbrt-v3 turns the normal.
    void NormalDerivatives(const At& at, Vector3d* dndu, Vector3d* dndv) const {
        const Vector3d n = at.dpdu.cross(at.dpdv).normalized();
        const double e = n.dot(-phiMax * phiMax * Vector3d(at.p.x(), at.p.y(), 0));
        const double f = n.dot(phiMax * Vector3d(-at.dpdv.y(), at.dpdv.x(), 0));
        const double E = at.dpdu.dot(at.dpdu), F = at.dpdu.dot(at.dpdv), G = at.dpdv.dot(at.dpdv);
        const double determinant = E * G - F * F;
        *dndu = ((f * F - e * G) * at.dpdu + (e * F - f * E) * at.dpdv) / determinant;
        *dndv = (-f * G * at.dpdu + f * F * at.dpdv) / determinant;
    }
};

TEST(Revolved, HyperboloidIsPbrtV3s) {
    const struct {
        Vec3f p1, p2;
        bool isSwept;  // by its line
    } lines[] = {{{-3.2f, 0.8f, 0.4f}, {-1, -0.5f, -1.25f}, false},
                 {{0.9f, 0.2f, -0.8f}, {0.3f, 1.1f, 0.5f}, false},
                 {{0.2f, 0, 0}, {0.02f, 0.17f, 0.6f}, false},
                 {{1, 0.3f, 0.7f}, {0.2f, 0.6f, 0}, false},  // the ends are swapped
                 {{0.4f, 0.1f, 1}, {0.9f, 0.3f, 2}, false},  // two sheets
                 {{1.5f, 0.2f, 0.5f}, {0.7f, 0.4f, 1.5f}, false},
                 {{0.9f, 0.2f, -0.8f}, {0.2f, 0.9f, 0.8f}, true}};
    Random random(5);
    for (const auto& line : lines) {
        const PbrtHyperboloid pbrt(line.p1.cast<double>(), line.p2.cast<double>(), double(kSweep));
        const Revolved shape = MakeHyperboloid(line.p1, line.p2, kSweep);
        ASSERT_TRUE(HasArea(shape));
        const Bounds3f bounds = shape.WorldBounds();
        int hits = 0, differ = 0, offLine = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3f from = 6 * random.Direction();
            const Vec3f to = line.p1 + random.Float() * (line.p2 - line.p1) +
                             2 * random.Float() * random.Direction();
            const Ray ray{from, (to - from).normalized(), kInfinity};
            const auto theirs = pbrt.Intersect(ray.o.cast<double>(), ray.d.cast<double>());
            const auto t = Intersect(shape, ray);
            if (t.has_value() != theirs.has_value() ||
                (t && std::abs(double(*t) - theirs->t) > 1e-3)) {
                ++differ;  // at an edge
                continue;
            }
            if (!t) continue;
            ++hits;
            SurfaceInteraction hit;
            Interact(shape, ray, HitAt(*t), kNeedsNormalDerivatives, &hit);
            ASSERT_NEAR((hit.p - theirs->p.cast<float>()).norm(), 0, 1e-4);
            ASSERT_NEAR(hit.uv.x(), theirs->u, 1e-3);
            ASSERT_NEAR(hit.uv.y(), theirs->v, 1e-3);
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GT(hit.p[axis], bounds.lower[axis] - 1e-4f);
                ASSERT_LT(hit.p[axis], bounds.upper[axis] + 1e-4f);
            }
            const Vec3f n = theirs->dpdu.cross(theirs->dpdv).normalized().cast<float>();
            ASSERT_GT(hit.n.dot(n), 0.9999);
            Vector3d dndu, dndv;
            pbrt.NormalDerivatives(*theirs, &dndu, &dndv);
            ASSERT_NEAR((hit.dndu.cast<double>() - dndu).norm(), 0, 1e-2 * (1 + dndu.norm()));
            ASSERT_NEAR((hit.dndv.cast<double>() - dndv).norm(), 0, 1e-2 * (1 + dndv.norm()));
            const double v = theirs->v;
            const Vector3d onLine = ((1 - v) * pbrt.p1 + v * pbrt.p2);
            offLine += std::abs(onLine.head<2>().norm() - theirs->p.head<2>().norm()) > 1e-3;
        }
        EXPECT_GT(hits, 500) << line.p1.transpose();
        EXPECT_LT(differ, 20) << line.p1.transpose();
        EXPECT_EQ(offLine == 0, line.isSwept) << line.p1.transpose();
    }
}

// A line through the origin sweeps out a cone; pbrt-v3 does not end with it.
TEST(Revolved, HyperboloidOfALineThroughTheOriginIsACone) {
    const Revolved shape = MakeHyperboloid({0, 0, 0}, {1, 1, 1}, 2 * kPi);
    const auto t = Intersect(shape, {{5, 0, 0.5f}, {-1, 0, 0}, kInfinity});
    ASSERT_TRUE(t);
    EXPECT_NEAR(*t, 5 - std::sqrt(0.5), 1e-5);
}

// Rays that leave the outside of a cylinder or cone away from its axis never meet it again.
TEST(Revolved, RaysDoNotMeetWhereTheyStart) {
    Random random(3);
    int failures = 0, rays = 0;
    for (int k = 0; k < 200; ++k) {
        const float scale = std::pow(10.f, 6 * random.Float() - 3);
        Revolved shape = k % 2 ? MakeCylinder(scale, -scale, scale, 2 * kPi)
                               : MakeCone(scale, 2 * scale, 2 * kPi);
        const Vec3f offset = scale * std::pow(10.f, 4 * random.Float() - 2) * random.Direction();
        shape.place.worldFromShape.topRightCorner<3, 1>() = offset.cast<double>();
        shape.place.shapeFromWorld = shape.place.worldFromShape.inverse();
        for (int i = 0; i < 200; ++i) {
            const Vec3f from = offset + 20 * scale * random.Direction();
            const Vec3f to = offset + scale * random.Direction();
            const Ray ray{from, (to - from).normalized(), kInfinity};
            const auto t = Intersect(shape, ray);
            if (!t) continue;
            SurfaceInteraction hit;
            Interact(shape, ray, HitAt(*t), kNeedsNothing, &hit);
            const Vec3f radial = hit.p - offset;
            if (hit.n.dot(Vec3f(radial.x(), radial.y(), 0)) <= 0) continue;
            Vec3f wi = random.Direction();
            if (wi.dot(hit.n) <= 0) wi = -wi;
            if (i % 3 == 0) wi = (wi - wi.dot(hit.n) * hit.n + 1e-4f * hit.n).normalized();
            ++rays;
            failures += Intersect(shape, hit.SpawnRay(wi)).has_value();
        }
    }
    EXPECT_GT(rays, 5000);
    EXPECT_EQ(failures, 0);
}

TEST(Revolved, CylinderSamplesItsArea) {
    const Revolved shape = MakeCylinder(0.5f, -1, 1, 2 * kPi);
    EXPECT_NEAR(shape.Area(), 2 * kPi, 1e-5);
    Random random(4);
    const Vec3f from(2, 0.3f, 0.4f);
    for (int i = 0; i < 10000; ++i) {
        const auto s = Sample(shape, from, random.Point());
        ASSERT_TRUE(s);
        ASSERT_NEAR(s->p.head<2>().norm(), 0.5, 1e-5);
        ASSERT_FLOAT_EQ(Pdf(shape, from, s->p, s->n), s->pdf);
    }
}

std::string ErrorOfWorld(const std::string& world) {
    return ErrorOf([&] { SceneOf(WorldText(world)); });
}

TEST(Revolved, RefusesWhatHasNoArea) {
    for (const char* world : {
             "Shape \"cylinder\" \"float radius\" 0",
             "Shape \"cylinder\" \"float zmin\" 1",
             "Shape \"cylinder\" \"float phimax\" 0",
             "Shape \"cone\" \"float height\" 0",
             "Shape \"cone\" \"float height\" -1",
             "Shape \"paraboloid\" \"float zmax\" 0",
             "Shape \"paraboloid\" \"float zmin\" -2 \"float zmax\" -1",
             "Shape \"hyperboloid\" \"point p1\" [1 0 1]",
             "Shape \"hyperboloid\" \"point p1\" [0 0 0] \"point p2\" [0 0 1]",
         })
        EXPECT_HAS(ErrorOfWorld(world), "test.pbrt:3: ") << world;
    for (const char* kind : {"cone", "paraboloid", "hyperboloid"})
        EXPECT_HAS(ErrorOfWorld(fmt::format("AreaLightSource \"diffuse\"\nShape \"{}\"", kind)),
                   "test.pbrt:4: a light of shape")
            << kind;
    // The defaults of pbrt-v3, with which its own hyperboloid does not end.
    for (const char* kind : {"cylinder", "cone", "paraboloid", "hyperboloid"})
        EXPECT_EQ(ErrorOfWorld(fmt::format("Shape \"{}\"", kind)), "") << kind;
}

}  // namespace
}  // namespace lull
