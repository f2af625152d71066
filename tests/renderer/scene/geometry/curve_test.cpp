// Tests curves: their directives, and where rays meet them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/input/pbrt_parser.h"
#include "renderer/scene/geometry/shapes/shape_factory.h"
#include "renderer/scene/scene.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

using test::Random;

Parameter Points(std::vector<float> values) { return PointParameter("P", std::move(values)); }
Parameter Normals(std::vector<float> values) {
    return {ParameterType::Normal, "N", LocAt(7), std::move(values)};
}

Curves Read(const std::vector<Parameter>& parameters,
            const Mat4d& worldFromObject = Mat4d::Identity()) {
    ShapeEntity entity = ShapeOf("curve", parameters);
    entity.worldFromObject = worldFromObject;
    Warnings warnings;
    return ReadCurves(entity, warnings);
}

const std::vector<float> kBend = {-1, 0, 0, -0.5f, 0.8f, 0.3f, 0.4f, 0.9f, -0.5f, 1, 0.1f, 0.2f};

Vec3f PointAt(const CurvePiece& piece, double u) {
    const double b[] = {std::pow(1 - u, 3), 3 * u * Sqr(1 - u), 3 * u * u * (1 - u), u * u * u};
    Vec3f p = Vec3f::Zero();
    for (int i = 0; i < 4; ++i) p += float(b[i]) * piece.p[i];
    return p;
}
Vec3f DerivativeAt(const CurvePiece& piece, double u) {
    return 500 * (PointAt(piece, u + 0.001) - PointAt(piece, u - 0.001));
}

// Returns the nearest hit over all primitives, as the accelerator tells of it.
std::optional<Hit> Nearest(const Curves& curves, Ray ray) {
    std::optional<Hit> nearest;
    for (uint32_t i = 0; i < curves.PrimitiveCount(); ++i)
        if (const auto hit = Intersect(curves, i, ray)) {
            nearest = Hit{hit->t, hit->u, hit->v, 0, i, -1};
            ray.tMax = hit->t;
        }
    return nearest;
}

// A ray at a point beside the middle of the curve meets it there if it is within half the width,
// whatever the type of curve that faces it and however it is split.
TEST(Curves, AreHitWithinTheirWidth) {
    Random random(1);
    for (const char* kind : {"flat", "cylinder"})
        for (const int depth : {0, 3, 6}) {
            const Curves curves =
                Read({Points(kBend), String("type", kind), Int("splitdepth", depth),
                      Float("width0", 0.1f), Float("width1", 0.04f)});
            ASSERT_EQ(curves.PrimitiveCount(), 1u << depth);
            const CurvePiece& piece = curves.pieces[0];
            for (int i = 0; i < 1000; ++i) {
                const float u = 0.03f + 0.94f * random.Float();
                const float aside = 2.4f * random.Float() - 1.2f;  // in half widths
                const Vec3f d = random.Direction(), along = DerivativeAt(piece, u).normalized();
                if (std::abs(d.dot(along)) > 0.7f || std::abs(std::abs(aside) - 1) > 0.85f)
                    continue;
                const Vec3f across = d.cross(along).normalized();
                const float width = Lerp(u, 0.1f, 0.04f);
                const Vec3f target = PointAt(piece, u) + 0.5f * width * aside * across;
                const Ray ray{target - 3 * d, 2 * d, kInfinity};
                const auto hit = Nearest(curves, ray);
                if (!hit) {
                    EXPECT_GT(std::abs(aside), 0.85f) << u;
                    continue;
                }
                if (std::abs(hit->t - 1.5f) > 0.1f) continue;  // something else in front
                EXPECT_LT(std::abs(aside), 1.15f);
                EXPECT_NEAR(hit->t, 1.5f, 0.03f);
                EXPECT_NEAR(hit->b1, u, 0.03f);
                EXPECT_NEAR(hit->b2, 0.5f + 0.5f * aside, 0.1f);
                SurfaceInteraction at;
                Interact(curves, ray, *hit, kNeedsNothing, &at);
                EXPECT_NEAR((at.p - target).norm(), 0, 0.06f);
                EXPECT_NEAR(at.n.norm(), 1, 1e-5f);
                EXPECT_NEAR(at.n.dot(at.dpdu.normalized()), 0, 1e-5f);
                EXPECT_NEAR(at.dpdv.norm(), width, 0.005f);
                EXPECT_GT(at.dpdu.normalized().dot(along), 0.97f);
                // Flat ones face the ray; tubes turn aside towards their edges.
                const float turned = (at.uv.y() - 0.5f) * kPi;
                const float expected = std::string(kind) == "flat" ? 1 : std::cos(turned);
                const float facing = std::abs(at.n.dot((d - along * d.dot(along)).normalized()));
                EXPECT_NEAR(facing, expected, 0.15f);
            }
        }
}

// A ribbon is as wide as it looks from where the ray comes, and has its own normal.
TEST(Curves, RibbonsAreSeenFromTheSideAsThin) {
    const Curves ribbon =
        Read({Points({-1, 0, 0, -0.3f, 0, 0, 0.3f, 0, 0, 1, 0, 0}), Normals({0, 0, 1, 0, 1, 0}),
              String("type", "ribbon"), Float("width", 0.2f)});
    const auto isHit = [&](float x, float y, const Vec3f& d) {
        return Nearest(ribbon, {Vec3f(x, y, 0) - 5 * d, d, kInfinity}).has_value();
    };
    const Vec3f down(0, 0, -1);
    EXPECT_TRUE(isHit(-0.95f, 0.09f, down));
    EXPECT_TRUE(isHit(-0.95f, -0.09f, down));
    EXPECT_FALSE(isHit(-0.95f, 0.11f, down));
    EXPECT_TRUE(isHit(0, 0.065f, down));  // turned by 45 degrees
    EXPECT_FALSE(isHit(0, 0.08f, down));
    EXPECT_FALSE(isHit(0.97f, 0.02f, down));  // nearly edge-on
    const Ray ray{Vec3f(-0.9f, 0.05f, 5), down, kInfinity};
    const auto hit = Nearest(ribbon, ray);
    ASSERT_TRUE(hit.has_value());
    SurfaceInteraction at;
    Interact(ribbon, ray, *hit, kNeedsNothing, &at);
    EXPECT_GT(std::abs(at.n.z()), 0.99f);
    // Normals that are the same at both ends are not a quotient of zeros.
    const Curves straight =
        Read({Points({-1, 0, 0, -0.3f, 0, 0, 0.3f, 0, 0, 1, 0, 0}), Normals({0, 0, 1, 0, 0, 1}),
              String("type", "ribbon"), Float("width", 0.2f)});
    const auto middle = Nearest(straight, {Vec3f(0, 0.09f, 5), down, kInfinity});
    ASSERT_TRUE(middle.has_value());
    EXPECT_NEAR(std::abs(middle->b2 - 0.5f), 0.45f, 1e-3f);
}

// Splines and quadratic curves become cubic Bezier curves with the same points.
TEST(Curves, KnowBothBasesAndDegrees) {
    const std::vector<float> five = {0, 0, 0, 1, 2, 0, 2, -1, 1, 3, 0, 2, 4, 1, 1};
    const auto at = [&](int i) { return Vec3f(five[3 * i], five[3 * i + 1], five[3 * i + 2]); };
    const Curves quadratic = Read({Points(five), Int("degree", 2)});
    ASSERT_EQ(quadratic.pieces.size(), 2u);
    for (const float u : {0.f, 0.3f, 1.f})
        EXPECT_NEAR((PointAt(quadratic.pieces[1], u) -
                     (Sqr(1 - u) * at(2) + 2 * u * (1 - u) * at(3) + u * u * at(4)))
                        .norm(),
                    0, 1e-6f);
    const Curves spline =
        Read({Points(five), String("basis", "bspline"), Float("width0", 1), Float("width1", 3)});
    ASSERT_EQ(spline.pieces.size(), 2u);
    EXPECT_EQ(spline.pieces[0].width, (std::array{1.f, 2.f}));
    EXPECT_EQ(spline.pieces[1].width, (std::array{2.f, 3.f}));
    for (const float u : {0.f, 0.3f, 1.f}) {
        const Vec3f expected =
            (std::pow(1 - u, 3.f) * at(1) + (3 * u * u * u - 6 * u * u + 4) * at(2) +
             (-3 * u * u * u + 3 * u * u + 3 * u + 1) * at(3) + u * u * u * at(4)) /
            6;
        EXPECT_NEAR((PointAt(spline.pieces[1], u) - expected).norm(), 0, 1e-5f);
    }
    const Curves square = Read({Points(five), String("basis", "bspline"), Int("degree", 2)});
    ASSERT_EQ(square.pieces.size(), 3u);
    for (const float u : {0.f, 0.3f, 1.f}) {
        const Vec3f expected =
            0.5f * Sqr(1 - u) * at(1) + (0.5f + u - u * u) * at(2) + 0.5f * u * u * at(3);
        EXPECT_NEAR((PointAt(square.pieces[1], u) - expected).norm(), 0, 1e-5f);
    }
}

// Moving the pieces into the world is the same as rays into the shape.
TEST(Curves, MayBePlacedByAnyTransform) {
    const Eigen::Affine3d rigid = Eigen::Translation3d(3, -1, 2) *
                                  Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 0.5).normalized()) *
                                  Eigen::Scaling(1.5);
    Eigen::Affine3d stretched = rigid;
    stretched.matrix().topLeftCorner<3, 1>() *= 1.001;
    const std::vector<Parameter> parameters = {Points(kBend), Float("width", 0.2f),
                                               String("type", "cylinder")};
    const Curves moved = Read(parameters, rigid.matrix());
    const Curves kept = Read(parameters, stretched.matrix());
    EXPECT_FALSE(moved.place.has_value());
    ASSERT_TRUE(kept.place.has_value());
    Random random(3);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3f target =
            (rigid * PointAt(kept.pieces[0], random.Float()).cast<double>()).cast<float>();
        const Vec3f d = random.Direction();
        const Ray ray{target + 0.12f * random.Direction() - 4 * d, d, kInfinity};
        const auto a = Nearest(moved, ray), b = Nearest(kept, ray);
        if (!a || !b || std::abs(a->t - b->t) > 0.01f) continue;
        ++hits;
        SurfaceInteraction atA, atB;
        Interact(moved, ray, *a, kNeedsNothing, &atA);
        Interact(kept, ray, *b, kNeedsNothing, &atB);
        EXPECT_NEAR((atA.p - atB.p).norm(), 0, 0.01f);
        EXPECT_NEAR((atA.dpdu - atB.dpdu).norm(), 0, 0.2f);
        EXPECT_NEAR((atA.pError - atB.pError).norm(), 0, 0.05f);
        if (std::abs(a->b2 - b->b2) < 0.02f) {
            EXPECT_GT(atA.n.dot(atB.n), 0.98f);
        }
    }
    EXPECT_GT(hits, 700);
}

TEST(Curves, MayHaveNoWidthOrLength) {
    const Curves thin = Read({Points(kBend), Float("width", 0)});
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f d = random.Direction();
        EXPECT_FALSE(
            Nearest(thin, {PointAt(thin.pieces[0], random.Float()) - d, d, kInfinity}).has_value());
    }
    // It tapers to a point; whatever is hit is finite.
    const Curves tip = Read(
        {Points(kBend), Float("width0", 1e-3f), Float("width1", 0), String("type", "cylinder")});
    for (int i = 0; i < 1000; ++i) {
        const Vec3f d = random.Direction();
        const float u = 1 - 1e-4f * random.Float();
        const Ray ray{PointAt(tip.pieces[0], u) - d, d, kInfinity};
        if (const auto hit = Nearest(tip, ray)) {
            SurfaceInteraction at;
            Interact(tip, ray, *hit, kNeedsNothing, &at);
            EXPECT_TRUE(at.p.allFinite() && at.n.allFinite() && at.uv.allFinite());
            EXPECT_NEAR(at.n.norm(), 1, 1e-5f);
        }
    }
    ShapeEntity point = ShapeOf("curve", {Points({1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3})});
    Warnings warnings;
    EXPECT_EQ(ReadCurves(point, warnings).PrimitiveCount(), 0u);
    EXPECT_EQ(warnings.Total(), 1);
    // A ray along the curve, and one from its middle.
    const Curves straight = Read({Points({0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3})});
    EXPECT_FALSE(Nearest(straight, {Vec3f(0, 0, -1), Vec3f(0, 0, 1), kInfinity}).has_value());
    EXPECT_FALSE(Nearest(straight, {Vec3f(0, 0, 1.5f), Vec3f(1, 0, 0), kInfinity}).has_value());
}

TEST(Curves, RefuseNonsense) {
    const auto error = [](const std::vector<Parameter>& parameters) {
        return ErrorOf([&] { Read(parameters); });
    };
    EXPECT_HAS(error({}), "scene.pbrt:3: the curve has 0 points");
    EXPECT_HAS(error({Points({1, 2, 3, 4, 5, 6})}), "4 + n * 3 are needed");
    EXPECT_HAS(error({Points(kBend), Int("degree", 2)}), "3 + n * 2");
    EXPECT_HAS(error({Points({1, 2, 3}), String("basis", "bspline")}), "4 or more");
    EXPECT_HAS(error({Points(kBend), Int("degree", 4)}), "degree 4");
    EXPECT_HAS(error({Points(kBend), String("basis", "hermite")}), "hermite");
    EXPECT_HAS(error({Points(kBend), String("type", "tube")}), "tube");
    EXPECT_HAS(error({Points(kBend), Float("width", -1)}), "is -1");
    EXPECT_HAS(error({Points(kBend), Float("width", -1), Float("width0", 1)}), "\"width1\" is -1");
    EXPECT_EQ(error({Points(kBend), Float("width", -1), Float("width0", 1), Float("width1", 1)}),
              "");
    EXPECT_HAS(error({Points(kBend), Float("width0", kInfinity)}), "width");
    EXPECT_HAS(error({Points(kBend), Int("splitdepth", 11)}), "is 11");
    EXPECT_HAS(error({Points(kBend), Float("splitdepth", -4e20f)}), "is -1");
    EXPECT_HAS(error({Points(kBend), String("type", "ribbon")}), "2 normals");
    EXPECT_HAS(error({Points(kBend), String("type", "ribbon"), Normals({0, 0, 0, 0, 0, 1})}),
               "zero");
    std::vector<float> broken = kBend;
    broken[4] = std::nanf("");
    EXPECT_HAS(error({Points(broken)}), "not finite");
    ShapeEntity lamp = ShapeOf("curve", {Points(kBend)});
    lamp.areaLight = Entity{};
    Warnings warnings;
    EXPECT_HAS(ErrorOf([&] { ReadCurves(lamp, warnings); }), "pbrt-v3 cannot sample");
}

// Hair comes as one directive a strand and makes one shape where nothing else changes.
TEST(Curves, StrandsMakeOneShape) {
    const TemporaryDirectory directory;
    const std::string strand =
        "Shape \"curve\" \"point P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"float width\" .1\n";
    const std::string text =
        "WorldBegin\n" + strand + strand + strand + "Translate 1 0 0\n" + strand +
        "Material \"hair\"\n" + strand + strand +
        "Shape \"curve\" \"string type\" \"cylinder\" \"point P\" [0 0 0 0 0 1 0 "
        "0 2 0 0 3] \"float width\" .1\nObjectBegin \"o\"\n" +
        strand + strand + "ObjectEnd\nObjectInstance \"o\"\nWorldEnd\n";
    Warnings warnings;
    const Description d = ParsePbrt(directory.Write("test.pbrt", text), warnings);
    ASSERT_EQ(d.shapes.size(), 4u);
    EXPECT_EQ(d.shapes[0].strands.size(), 2u);
    EXPECT_EQ(d.shapes[2].strands.size(), 1u);
    ASSERT_EQ(d.objects[0].shapes.size(), 1u);
    const auto scene = Compile(d, {}, warnings);
    EXPECT_EQ(scene->shapes.shapes[0].PrimitiveCount(), 24u);
    Hit hit;
    ASSERT_TRUE(
        scene->accelerator.Intersect({Vec3f(1.02f, -5, 2.2f), Vec3f(0, 1, 0), kInfinity}, &hit));
    EXPECT_NEAR(hit.t, 5, 1e-3f);
    EXPECT_FALSE(scene->accelerator.Occluded({Vec3f(1.06f, -5, 2.2f), Vec3f(0, 1, 0), 9}));
    EXPECT_TRUE(scene->accelerator.Occluded({Vec3f(0.96f, -5, 0.2f), Vec3f(0, 1, 0), 9}));
}

}  // namespace
}  // namespace lull
