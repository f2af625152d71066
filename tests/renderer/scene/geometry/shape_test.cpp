// Tests intersection, its error bounds and the sampling of shapes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/geometry/hit_at.h"
#include "tests/renderer/scene_of.h"

namespace lull::shape_test {
namespace {

using test::Random;

std::string Numbers(const Vec3f& v) {
    return fmt::format("{:.9g} {:.9g} {:.9g} ", v.x(), v.y(), v.z());
}

SurfaceInteraction HitOf(const Scene& scene, const Ray& ray, const Hit& hit) {
    SurfaceInteraction at;
    scene.shapes.Interact(ray, hit, kNeedsNothing, &at);
    return at;
}

// Rays that leave a convex surface never meet it again; those that go into a sphere meet only its
// far side.
TEST(Shapes, RaysDoNotMeetWhereTheyStart) {
    Random random(1);
    int rays = 0, failures = 0, placed = 0;
    for (int k = 0; k < 450; ++k) {
        const float scale = std::pow(10.f, 7 * random.Float() - 3);
        const Vec3f offset = scale * std::pow(10.f, 4 * random.Float() - 2) * random.Direction();
        std::string world;
        if (k % 3 == 0) {
            world = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [";
            for (int i = 0; i < 3; ++i) world += Numbers(offset + scale * random.Direction());
            world += "]";
        } else {
            world = "Translate " + Numbers(offset) +
                    fmt::format("Rotate {} ", 360 * random.Float()) + Numbers(random.Direction()) +
                    fmt::format("Shape \"{}\" \"float radius\" [{:.9g}]",
                                k % 3 == 1 ? "sphere" : "disk", scale);
        }
        const auto scene = SceneOf(WorldText(world));
        const Bounds3f& box = scene->shapes.bounds;
        for (int i = 0; i < 400; ++i) {
            const Vec3f u(random.Float(), random.Float(), random.Float());
            const Vec3f target = box.lower + box.Diagonal().cwiseProduct(u);
            const Vec3f d = random.Direction();
            const Ray ray{target - d * (scale * (1 + 10 * random.Float())), d, kInfinity};
            Hit hit;
            if (!scene->accelerator.Intersect(ray, &hit)) continue;
            ++placed;
            const SurfaceInteraction at = HitOf(*scene, ray, hit);
            for (int j = 0; j < 3; ++j) {
                // Among them grazing ones.
                Vec3f wi = random.Direction();
                if (j == 2) wi = (wi - wi.dot(at.n) * at.n + 1e-4f * at.n).normalized();
                const Ray next = at.SpawnRay(wi);
                ++rays;
                Hit again;
                if (!scene->accelerator.Intersect(next, &again)) continue;
                const Vec3f axis = at.p - offset;
                const bool goesIn = k % 3 == 1 && wi.dot(axis) < 0;
                const float chord = -2 * wi.dot(axis);
                if (!goesIn || again.t < 0.5f * chord) ++failures;
            }
        }
    }
    EXPECT_GT(placed, 30000);
    EXPECT_GT(rays, 90000);
    EXPECT_EQ(failures, 0);
}

Sphere SphereAt(const Vec3f& center, float radius) {
    Sphere sphere;
    sphere.radius = sphere.zMax = radius;
    sphere.zMin = -radius;
    sphere.place.worldFromShape.topRightCorner<3, 1>() = center.cast<double>();
    sphere.place.shapeFromWorld = sphere.place.worldFromShape.inverse();
    return sphere;
}

// The true surface lies within the error bounds of a hit.
TEST(Shapes, ErrorBoundsHold) {
    Random random(2);
    for (int k = 0; k < 100; ++k) {
        const float radius = std::pow(10.f, 4 * random.Float() - 2);
        const Vec3f center = 10 * radius * random.Float() * random.Direction();
        const Sphere sphere = SphereAt(center, radius);
        for (int i = 0; i < 100; ++i) {
            const Vec3f from = center + 100 * sphere.radius * random.Direction();
            const Vec3f to = center + 0.9f * sphere.radius * random.Direction();
            const Ray ray{from, (to - from).normalized(), kInfinity};
            const auto t = Intersect(sphere, ray);
            ASSERT_TRUE(t);
            SurfaceInteraction at;
            Interact(sphere, ray, HitAt(*t), kNeedsNothing, &at);
            const double distance = (at.p.cast<double>() - center.cast<double>()).norm();
            ASSERT_LE(std::abs(distance - sphere.radius), at.pError.norm());
        }
    }
}

// Far spheres are hit where they are, and missed where they are not.
TEST(Sphere, IsPreciseFromAfar) {
    const Sphere sphere;
    Random random(3);
    for (const float distance : {1e2f, 1e4f, 1e5f})
        for (int i = 0; i < 2000; ++i) {
            const float y = 3 * random.Float() - 1.5f;
            const auto t = Intersect(sphere, {{-distance, y, 0}, {1, 0, 0}, kInfinity});
            ASSERT_EQ(t.has_value(), std::abs(y) <= 1) << y;
            if (!t) continue;
            const double expected = distance - std::sqrt(1 - Sqr(double(y)));
            ASSERT_NEAR(*t, expected, 1e-7 * distance);
        }
}

TEST(Sphere, IsClipped) {
    Sphere sphere;
    sphere.zMin = -0.5f;
    sphere.zMax = 0.25f;
    sphere.phiMax = kPi;
    const auto hit = [&](const Vec3f& o, const Vec3f& d) {
        const auto t = Intersect(sphere, {o, d, kInfinity});
        return t ? *t : -1.f;
    };
    EXPECT_FLOAT_EQ(hit({0, 3, 0}, {0, -1, 0}), 2);   // phi = pi/2 is there
    EXPECT_FLOAT_EQ(hit({0, -3, 0}, {0, 1, 0}), 4);   // the other half is not
    EXPECT_FLOAT_EQ(hit({0, 0, 3}, {0, 0, -1}), -1);  // nor are the poles
    EXPECT_GT(hit({0, 3, 0.24f}, {0, -1, 0}), 0);
    EXPECT_EQ(hit({0, 3, 0.26f}, {0, -1, 0}), -1);
    EXPECT_GT(hit({0, 3, -0.49f}, {0, -1, 0}), 0);
    EXPECT_EQ(hit({0, 3, -0.51f}, {0, -1, 0}), -1);
    EXPECT_FLOAT_EQ(sphere.Area(), kPi * 0.75f);
    EXPECT_FALSE(Intersect(sphere, {{0, 3, 0}, {0, -1, 0}, 1.9f}));
}

TEST(Disk, HasItsHole) {
    Disk disk;
    disk.height = 1;
    disk.innerRadius = 0.5f;
    const auto isHit = [&](float x, float y) {
        return Intersect(disk, {{x, y, 3}, {0, 0, -1}, kInfinity}).has_value();
    };
    EXPECT_TRUE(isHit(0.6f, 0));
    EXPECT_TRUE(isHit(0, -0.99f));
    EXPECT_FALSE(isHit(0.4f, 0));
    EXPECT_FALSE(isHit(0.8f, 0.8f));
    disk.phiMax = kPi;
    EXPECT_FALSE(isHit(0, -0.9f));
    EXPECT_TRUE(isHit(0, 0.9f));
}

template <typename Shape>
void ExpectSamplesMatchPdf(const Shape& shape, const Vec3f& from, double solidAngle,
                           double tolerance) {
    Random random(4);
    test::SampleMean mean;  // of what is seen: nothing where there is no sample
    for (int i = 0; i < 40000; ++i) {
        const auto s = Sample(shape, from, random.Point());
        mean.Add(s ? 1 / double(s->pdf) : 0);
        if (!s) continue;
        const float pdf = Pdf(shape, from, s->p, s->n);
        ASSERT_NEAR(s->pdf, pdf, 1e-3 * pdf);
        // The shape is met on the way to the sample, there or before; not surely near its outline,
        // where a ray's rounded direction may pass it by.
        const Ray ray{from, s->p - from, kInfinity};
        const double facing = std::abs(s->n.dot(ray.d.normalized()));
        const auto t = Intersect(shape, ray);
        const double rounding = 3e-7 * ray.d.norm() / std::sqrt(shape.Area());
        if (facing > 0.02 + 2 * std::sqrt(rounding)) {
            ASSERT_TRUE(t);
            ASSERT_LT(*t, 1 + 1e-6 * (1 + from.norm() / ray.d.norm()) / facing);
        }
    }
    // From inside or in front, what is sampled is all that can be seen.
    EXPECT_NEAR(mean.Value(), solidAngle, 4.5 * mean.Error() + tolerance * solidAngle);
}

TEST(Sphere, SamplesTheSolidAngleItSubtends) {
    const Vec3f center(1, -2, 3);
    for (const double radius : {0.1, 2.0})
        for (const double ratio : {1.01, 1.5, 5.0, 100.0, 1e4, 1e5}) {
            const Vec3f from = center + float(ratio * radius) * Vec3f(2, 1, -2) / 3;
            const double sin2 = 1 / Sqr(ratio);
            ExpectSamplesMatchPdf(SphereAt(center, float(radius)), from,
                                  2 * std::numbers::pi * sin2 / (1 + std::sqrt(1 - sin2)), 1e-3);
        }
    for (const float ratio : {0.f, 0.3f, 0.9f})
        ExpectSamplesMatchPdf(SphereAt(center, 2), center + 2 * ratio * Vec3f(2, 1, -2) / 3,
                              4 * std::numbers::pi, 1e-4);
}

// A point of the sphere is inside it, whatever side rounding puts it on.
TEST(Sphere, SamplesAllOfItselfFromItsOwnSurface) {
    const Sphere sphere = SphereAt({1, -2, 3}, 2);
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f from = Vec3f(1, -2, 3) + 2 * random.Direction();
        const auto s = Sample(sphere, from, random.Point());
        ASSERT_TRUE(s);
        // There |cos| = distance / (2 r), so that the density is distance / (2 pi r).
        const double distance = (s->p - from).cast<double>().norm();
        if (distance > 0.1) {
            ASSERT_NEAR(s->pdf, distance / (4 * std::numbers::pi), 1e-3);
        }
    }
}

TEST(Disk, SamplesTheSolidAngleItSubtends) {
    Disk disk;
    disk.radius = 0.7f;
    const Eigen::Affine3d place = Eigen::Translation3d(1, 2, 3) *
                                  Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 1, 0).normalized());
    disk.place.worldFromShape = place.matrix();
    disk.place.shapeFromWorld = place.inverse().matrix();
    for (const double z : {0.2, -1.0, 5.0}) {
        const Vec3f axisPoint = (place * Eigen::Vector3d(0, 0, z)).cast<float>();
        const double cosMax = std::abs(z) / std::hypot(z, 0.7);
        ExpectSamplesMatchPdf(disk, axisPoint, 2 * std::numbers::pi * (1 - cosMax), 1e-4);
    }
}

// No ray leaves a bumpy closed mesh, not even through an edge. One aimed at a vertex may, once in
// some 200,000: Embree's tests of the edges around it agree about each edge, not about the vertex.
TEST(Mesh, IsWatertight) {
    constexpr int kRings = 9, kSectors = 14;
    Random random(7);
    std::vector<Vec3f> points = {{0, 0, 1}};
    for (int i = 1; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const Vec3f w = test::FromAngles(180.0 * i / kRings, 360.0 * j / kSectors);
            points.push_back(w * (1 + 0.2f * random.Float()));
        }
    points.push_back({0, 0, -1});
    const int last = int(points.size()) - 1;
    std::string indices, positions;
    for (int j = 0; j < kSectors; ++j) {
        const int k = (j + 1) % kSectors;
        indices += fmt::format("0 {} {} ", 1 + j, 1 + k);
        for (int i = 0; i + 2 < kRings; ++i) {
            const int a = 1 + i * kSectors, b = a + kSectors;
            indices += fmt::format("{} {} {} {} {} {} ", a + j, b + j, b + k, a + j, b + k, a + k);
        }
        indices += fmt::format("{} {} {} ", last - kSectors + j, last, last - kSectors + k);
    }
    for (const Vec3f& p : points) positions += Numbers(p);
    const auto scene = SceneOf(WorldText("Shape \"trianglemesh\" \"integer indices\" [" + indices +
                                         "] \"point P\" [" + positions + "]"));
    int escapes = 0, vertexEscapes = 0;
    for (int i = 0; i < 1000000; ++i) {
        const Vec3f o = 0.5f * random.Float() * random.Direction();
        Vec3f d = random.Direction();
        const Vec3f& a = points[random.Below(last + 1)];
        if (i % 4 == 1) d = (a - o).normalized();
        if (i % 4 == 2) d = (0.5f * (a + points[random.Below(last + 1)]) - o).normalized();
        // Along edges: a vertex and the next one of its ring.
        if (i % 4 == 3) {
            const int v = 1 + random.Below(last - 2);
            const float t = random.Float();
            d = ((1 - t) * points[v] + t * points[v + 1] - o).normalized();
        }
        Hit hit;
        if (scene->accelerator.Intersect({o, d, kInfinity}, &hit)) continue;
        ++(i % 4 == 1 ? vertexEscapes : escapes);
    }
    EXPECT_EQ(escapes, 0);
    EXPECT_LE(vertexEscapes, 10);
}

TEST(Instances, GiveWhatPlacedShapesGive) {
    const char* shapes = R"(
        Shape "sphere" "float radius" [.5]
        Translate 1 .2 .3
        Rotate 30 1 2 3
        Shape "disk" "float radius" [.6]
        Shape "trianglemesh" "integer indices" [0 1 2] "point P" [-1 -1 .5  1 -1 .2  0 1 .3]
    )";
    const char* transform = "Translate .3 -.2 .1 Rotate 70 1 -1 .5 Scale 1.5 1.5 1.5\n";
    const auto placed =
        SceneOf(WorldText(fmt::format("AttributeBegin {} {} AttributeEnd", transform, shapes)));
    const auto instanced =
        SceneOf(WorldText(fmt::format("ObjectBegin \"o\" {} ObjectEnd\nAttributeBegin {} "
                                      "ObjectInstance \"o\" AttributeEnd",
                                      shapes, transform)));
    EXPECT_LT((placed->shapes.bounds.Diagonal() - instanced->shapes.bounds.Diagonal()).norm(), 4);
    Random random(8);
    int hits = 0, differences = 0;
    for (int i = 0; i < 50000; ++i) {
        const Vec3f o = 6 * random.Direction(), to = 1.5f * random.Float() * random.Direction();
        const Ray ray{o, (to - o).normalized(), kInfinity};
        Hit a, b;
        const bool isHit = placed->accelerator.Intersect(ray, &a);
        // At an outline rounding decides.
        if (instanced->accelerator.Intersect(ray, &b) != isHit || (isHit && a.shape != b.shape)) {
            ++differences;
            continue;
        }
        if (!isHit) continue;
        ++hits;
        const SurfaceInteraction p = HitOf(*placed, ray, a), q = HitOf(*instanced, ray, b);
        ASSERT_NEAR(a.t, b.t, 1e-3);
        ASSERT_NEAR((p.p - q.p).norm(), 0, 1e-3);
        ASSERT_GT(p.n.dot(q.n), 0.99);
    }
    EXPECT_GT(hits, 5000);
    EXPECT_LE(differences, 5);
}

// Shapes that are no meshes, with parts missing or without.
TEST(Shapes, AreHiddenFromOneKindOfRays) {
    for (const std::string shape : {"\"disk\"", "\"sphere\""})
        for (const std::string coverage : {"", "\"float coverage\" .999999"}) {
            const auto scene = SceneOf(WorldText("Shape " + shape + " " + coverage +
                                                 "\"bool hiddenfromcamera\" \"true\""));
            const Ray ray{{.1f, .2f, -5}, Vec3f(.1f, 0, 1).normalized(), kInfinity};
            Hit hit;
            EXPECT_FALSE(scene->accelerator.Intersect(ray, &hit, 0, kCameraRay)) << shape;
            EXPECT_TRUE(scene->accelerator.Intersect(ray, &hit, 0, kOtherRay)) << shape;
        }
}

}  // namespace
}  // namespace lull::shape_test
