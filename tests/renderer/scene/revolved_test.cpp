// Tests cylinders, cones, paraboloids and hyperboloids against their parametric forms.
#include "renderer/scene/shapes/revolved.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/input/pbrt_parser.h"
#include "renderer/scene/compile.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/output/test_files.h"

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
    const Vec3f p1(0.9f, 0.2f, -0.8f), p2(0.3f, 1.1f, 0.5f);  // its waist is not at z = 0
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
            Interact(e.shape, ray, *t, kNeedsNormalDerivatives, &hit);
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
            Interact(e.shape, ray, *t, kNeedsNormalDerivatives, &hit);
            const double h = 1e-3;
            const Vec3f dndu = ((normal(u + h, v) - normal(u - h, v)) / (2 * h)).cast<float>();
            const Vec3f dndv = ((normal(u, v + h) - normal(u, v - h)) / (2 * h)).cast<float>();
            ASSERT_NEAR((hit.dndu - dndu).norm(), 0, 5e-3 * (1 + dndu.norm())) << e.name;
            ASSERT_NEAR((hit.dndv - dndv).norm(), 0, 5e-3 * (1 + dndv.norm())) << e.name;
        }
    }
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
            Interact(shape, ray, *t, kNeedsNothing, &hit);
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
    // The solid angle, twice: a ray that meets the cylinder meets both of its sides.
    const Vec3f from(2, 0.3f, 0.4f);
    double sum = 0, squares = 0, crossings = 0;
    constexpr int kSamples = 200000;
    for (int i = 0; i < kSamples; ++i) {
        const auto s = Sample(shape, from, random.Point());
        ASSERT_TRUE(s);
        ASSERT_NEAR(s->p.head<2>().norm(), 0.5, 1e-5);
        ASSERT_FLOAT_EQ(Pdf(shape, from, s->p, s->n), s->pdf);
        sum += 1 / s->pdf;
        squares += Sqr(1 / double(s->pdf));
        const Vec3f d = random.Direction();
        Ray ray{from, d, kInfinity};
        for (int k = 0; k < 2; ++k) {
            const auto t = Intersect(shape, ray);
            if (!t) break;
            ++crossings;
            ray.o = ray.o + (*t + 1e-3f) * d;
        }
    }
    const double mean = sum / kSamples, p = crossings / kSamples;
    EXPECT_NEAR(mean, 4 * kPi * p,
                4.5 * std::sqrt((squares / kSamples - mean * mean) / kSamples +
                                Sqr(4 * kPi) * 2 * p / kSamples));
}

std::string ErrorOfWorld(const std::string& world) {
    const TemporaryDirectory directory;
    Warnings warnings;
    try {
        const auto d = ParsePbrt(
            directory.Write("test.pbrt", "WorldBegin\n" + world + "\nWorldEnd\n"), warnings);
        Compile(d, {}, warnings);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
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
        EXPECT_NE(ErrorOfWorld(world).find("test.pbrt:2: "), std::string::npos) << world;
    for (const char* kind : {"cone", "paraboloid", "hyperboloid"})
        EXPECT_NE(ErrorOfWorld(fmt::format("AreaLightSource \"diffuse\"\nShape \"{}\"", kind))
                      .find("test.pbrt:3: a light of shape"),
                  std::string::npos)
            << kind;
    // The defaults of pbrt-v3, with which its own hyperboloid does not end.
    for (const char* kind : {"cylinder", "cone", "paraboloid", "hyperboloid"})
        EXPECT_EQ(ErrorOfWorld(fmt::format("Shape \"{}\"", kind)), "") << kind;
}

}  // namespace
}  // namespace lull
