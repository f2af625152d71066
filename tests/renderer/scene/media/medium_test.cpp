// Tests media: what they transmit and where they scatter, and how they are read.
#include <gtest/gtest.h>

#include "renderer/bsdf/subsurface.h"
#include "renderer/input/spectrum.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene/media/medium_scene.h"

namespace lull::media_test {
namespace {

// No path ends by chance where nothing scatters.
TEST(HomogeneousMedium, TakesItsShareOfEveryRayWhereItOnlyAbsorbs) {
    const HomogeneousMedium medium{Rgb::Zero(), Rgb(1, 0.5f, 0), 0};
    Sampler sampler(SamplerKind::Random, 1);
    sampler.StartSample({0, 0}, 0);
    const Ray ray{Vec3f::Zero(), Vec3f::UnitX(), 2};
    for (int i = 0; i < 100; ++i) {
        const MediumSample s = medium.Sample(ray, sampler);
        EXPECT_FALSE(s.t);
        EXPECT_TRUE(s.weight.isApprox(Rgb(std::exp(-2.f), std::exp(-1.f), 1)));
    }
}

// Those that scatter have the albedo of the rest.
void ExpectBeerLambert(const MediumTable& table, const Ray& ray, const Eigen::Array3d& depth,
                       const Eigen::Array3d& albedo) {
    ExpectMeans(table, ray, depth, albedo * (1 - (-depth).exp()), Eigen::Array3d::Zero());
}

TEST(HomogeneousMedium, FollowsBeerAndLambert) {
    const MediumTable table =
        MakeTable("homogeneous", {Color("sigma_a", {0.1f, 0.5f, 0}), Float("scale", 2),
                                  Color("sigma_s", {0.3f, 0.1f, 0.2f})});
    const Eigen::Array3d extinction(0.8, 1.2, 0.4), albedo(0.75, 1 / 6.0, 1);
    // The direction need not be unit.
    ExpectBeerLambert(table, {Vec3f::Zero(), Vec3f(0, 0, 2), 0.7f}, 1.4 * extinction, albedo);
    ExpectBeerLambert(table, {Vec3f::Zero(), Vec3f(0, 0, 1), kInfinity},
                      Eigen::Array3d::Constant(1e9), albedo);
}

TEST(HomogeneousMedium, MayBeEmptyOrDense) {
    Sampler sampler(SamplerKind::Random, 2);
    const auto rgb = [](const char* name, float v) { return Grey(name, v); };
    const MediumTable empty = MakeTable("homogeneous", {rgb("sigma_a", 0), rgb("sigma_s", 0)});
    const MediumTable dense = MakeTable("homogeneous", {rgb("sigma_a", 0), rgb("sigma_s", 1e6f)});
    for (int i = 0; i < 10000; ++i) {
        sampler.StartSample({0, 0}, uint32_t(i));
        const Ray ray{Vec3f::Zero(), Vec3f::UnitX(), i % 2 ? kInfinity : 1.f};
        const MediumSample through = empty.Sample(0, ray, sampler);
        ASSERT_FALSE(through.t);
        ASSERT_TRUE((through.weight == 1).all());
        ASSERT_TRUE((empty.Transmittance(0, ray, sampler) == 1).all());
        const MediumSample inside = dense.Sample(0, ray, sampler);
        ASSERT_TRUE(inside.t && *inside.t < 1e-4f);
        ASSERT_NEAR((inside.weight - 1).abs().maxCoeff(), 0, 1e-4);  // albedo 1: nothing is lost
        ASSERT_TRUE((dense.Transmittance(0, ray, sampler) == 0).all());
    }
}

std::vector<Parameter> GridParameters(std::vector<float> density, float sigma = 1) {
    return {Int("nx", 2),
            Int("ny", 2),
            Int("nz", 3),
            Floats("density", std::move(density)),
            {ParameterType::Point3, "p0", LocAt(7), std::vector<float>{-1, 0, 2}},
            {ParameterType::Point3, "p1", LocAt(7), std::vector<float>{1, 1, 5}},
            Color("sigma_a", {0.25f * sigma, 0.5f * sigma, 0}),
            Color("sigma_s", {0.75f * sigma, 0.5f * sigma, sigma})};
}

TEST(GridMedium, FollowsBeerAndLambert) {
    const std::vector<float> density = {0, 1, 2, 0.5f, 1.5f, 0, 3, 1, 0.2f, 0.7f, 0, 2};
    Mat4d place = Mat4d::Identity();
    place(0, 0) = 2;
    place(1, 3) = -0.5;
    const MediumTable table = MakeTable("heterogeneous", GridParameters(density), place);
    const auto& grid = std::get<GridMedium>(table.media[0]);
    const auto& values = std::get<Grid<float>>(grid.density);
    // At the middles of cells the density is the grid's; outside there is none.
    EXPECT_NEAR(values(Vec3f(0.75f, 0.25f, 0.5f)), 0, 1e-6);
    EXPECT_NEAR(values(Vec3f(0.25f, 0.75f, 0.5f)), 3, 1e-5);
    EXPECT_NEAR(values(Vec3f(0.5f, 0.5f, 1 / 6.f)), 0.875, 1e-5);
    EXPECT_EQ(values(Vec3f(2, 2, 2)), 0);

    const Ray ray{Vec3f(-3, -0.3f, 1), Vec3f(0.9f, 0.12f, 0.5f).normalized() * 2, 3};
    const Mat4d inverse = place.inverse();
    double depth = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const Vec3f p = TransformPoint(inverse, Vec3f(ray.o + (i + 0.5f) / kSteps * 3 * ray.d));
        const Vec3f q = (p - Vec3f(-1, 0, 2)).cwiseQuotient(Vec3f(2, 1, 3));
        if ((q.array() >= 0).all() && (q.array() <= 1).all()) depth += values(q) * 6.0 / kSteps;
    }
    ASSERT_GT(depth, 0.5);
    ExpectBeerLambert(table, ray, Eigen::Array3d::Constant(depth), {0.75, 0.5, 1});
}

TEST(GridMedium, MayBeEmptyOrDense) {
    Sampler sampler(SamplerKind::Random, 3);
    const Ray ray{Vec3f(0, 0.5f, 0), Vec3f::UnitZ(), kInfinity};
    const MediumTable empty =
        MakeTable("heterogeneous", GridParameters(std::vector<float>(12, 0.f)));
    const MediumTable dense =
        MakeTable("heterogeneous", GridParameters(std::vector<float>(12, 1e6f)));
    for (int i = 0; i < 1000; ++i) {
        sampler.StartSample({0, 0}, uint32_t(i));
        EXPECT_FALSE(empty.Sample(0, ray, sampler).t);
        EXPECT_TRUE((empty.Transmittance(0, ray, sampler) == 1).all());
        const MediumSample s = dense.Sample(0, ray, sampler);
        ASSERT_TRUE(s.t && *s.t >= 2 && *s.t < 2.01f);
        EXPECT_TRUE((dense.Transmittance(0, ray, sampler) == 0).all());
        // Past it and beside it.
        EXPECT_FALSE(dense.Sample(0, {Vec3f(0, 0.5f, 6), Vec3f::UnitZ(), kInfinity}, sampler).t);
        EXPECT_FALSE(dense.Sample(0, {Vec3f(0, 3, 0), Vec3f::UnitZ(), kInfinity}, sampler).t);
    }
}

// Where floats lie farther apart than collisions, and hardly any of these is one: half of the box
// is empty.
TEST(GridMedium, HasAnEndHoweverFarAway) {
    const MediumTable table =
        MakeTable("heterogeneous", GridParameters({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1e6f}));
    Sampler sampler(SamplerKind::Random, 4);
    for (int i = 0; i < 10; ++i) {
        sampler.StartSample({0, 0}, uint32_t(i));
        const Ray ray{Vec3f(-0.5f, 0.25f, -1e6f), Vec3f::UnitZ(), kInfinity};
        EXPECT_FALSE(table.Sample(0, ray, sampler).t);
        EXPECT_TRUE((table.Transmittance(0, ray, sampler) == 1).all());
    }
}

// Radiance through a slab: Le sigma_a / sigma_t (1 - exp(-sigma_t d)).
TEST(HomogeneousMedium, Emits) {
    const MediumTable table =
        MakeTable("homogeneous", {Color("sigma_a", {0.5f, 1, 0}), Color("sigma_s", {0, 1, 0}),
                                  Color("emission", {3, 5, 7})});
    EXPECT_TRUE(table.Emit());
    Sampler sampler(SamplerKind::Random, 1);
    sampler.StartSample({0, 0}, 0);
    const Ray ray{Vec3f::Zero(), 2 * Vec3f::UnitX(), 2};
    const auto emitted = [&](const Ray& r) { return table.Sample(0, r, sampler).emitted; };
    EXPECT_TRUE(
        emitted(ray).isApprox(Rgb(3 * (1 - std::exp(-2.f)), 2.5f * (1 - std::exp(-8.f)), 0)));
    EXPECT_TRUE(emitted({ray.o, ray.d, kInfinity}).isApprox(Rgb(3, 2.5f, 0)));
    EXPECT_TRUE(emitted({ray.o, ray.d, 1e-6f}).isApprox(Rgb(3e-6f, 10e-6f, 0), 1e-4f));
    EXPECT_FALSE(
        MakeTable("homogeneous", {Grey("sigma_a", 0), Color("emission", {3, 5, 7})}).Emit());
}

const Vec3f kP0(-1, 0, 2), kP1(1, 1, 5);
const Ray kAcross{Vec3f(-1.5f, -0.2f, 1.5f), Vec3f(0.6f, 0.25f, 0.7f).normalized(), 4};

TEST(GridMedium, EmitsWithTheScaleOfItsGrid) {
    const std::vector<float> density = {0, 1, 2, 0.5f, 1.5f, 0, 3, 1, 0.2f, 0.7f, 0, 2};
    const std::vector<float> scale = {1, 0, 0.5f, 2, 1, 0, 0, 3, 1, 1, 2, 0};
    auto parameters = GridParameters(density);
    parameters.push_back(Color("emission", {2, 1, 4}));
    for (const bool isScaled : {false, true}) {
        if (isScaled) parameters.push_back(Floats("Lescale", scale));
        const MediumTable table = MakeTable("heterogeneous", parameters);
        const Grid<float> densities{{2, 2, 3}, density}, scales{{2, 2, 3}, scale};
        const Grid<float> whole{{1, 1, 1}, {1}};  // what pbrt-v4 has without "Lescale"
        ExpectIntegrals(table, kAcross, kP0, kP1, [&](const Vec3f&, const Vec3f& u) {
            const float d = densities(u), s = isScaled ? scales(u) : whole(u);
            return Point{Rgb(0.25f, 0.5f, 0) * d, Rgb(0.75f, 0.5f, 1) * d, Rgb(2, 1, 4) * s};
        });
    }
}

// As pbrt-v4 has it: the radiance of a black body whose spectrum is 1 at its peak.
TEST(GridMedium, GlowsByItsTemperatures) {
    const std::vector<float> density(12, 1.f);
    const std::vector<float> celsius = {900,  1000, 1100, 2000, 1500, 1200,
                                        1300, 100,  1250, 1800, -273, 1727};
    auto parameters = GridParameters(density);
    parameters.push_back(Floats("temperature", celsius));
    parameters.push_back(Float("temperatureoffset", -273));
    parameters.push_back(Float("temperaturescale", 1.5f));
    parameters.push_back(Floats("Lescale", std::vector<float>(12, 2.f)));
    const MediumTable table = MakeTable("heterogeneous", parameters);
    const Grid<float> densities{{2, 2, 3}, density}, temperatures{{2, 2, 3}, celsius};
    ExpectIntegrals(table, kAcross, kP0, kP1, [&](const Vec3f&, const Vec3f& u) {
        const double kelvin = (double(temperatures(u)) + 273) * 1.5;
        const Rgb Le =
            kelvin > 100 ? Rgb(106.8569f * RgbFromBlackbody(kelvin).max(0.f)) : Rgb(0, 0, 0);
        const float d = densities(u);  // which is 1 in the middle, as half of the scale is
        return Point{Rgb(0.25f, 0.5f, 0) * d, Rgb(0.75f, 0.5f, 1) * d, 2 * d * Le};
    });
    parameters.push_back(Float("temperaturescale", 0.01f));
    EXPECT_FALSE(MakeTable("heterogeneous", parameters).Emit());
}

TEST(RgbGrid, HasColoursOfItsOwn) {
    std::vector<float> sigmaA, Le;
    Grid<Rgb> absorption{{2, 2, 3}, {}}, emission = absorption;
    for (int i = 0; i < 12; ++i) {
        const Rgb a(0.1f * float(i), 0.5f, i % 3 ? 0 : 2), L(float(i), 2, 1);
        sigmaA.insert(sigmaA.end(), a.data(), a.data() + 3);
        Le.insert(Le.end(), L.data(), L.data() + 3);
        absorption.values.push_back(a);
        emission.values.push_back(L);
    }
    std::vector<Parameter> parameters = GridParameters({});
    std::erase_if(parameters, [](const Parameter& p) {
        return p.name == "density" || p.name.starts_with("sigma");
    });
    parameters.push_back({ParameterType::Spectrum, "sigma_a", LocAt(7), sigmaA});
    parameters.push_back({ParameterType::Spectrum, "Le", LocAt(7), Le});
    parameters.push_back(Float("Lescale", 0.25f));
    parameters.push_back(Float("scale", 0.5f));
    // The scattering that is not given is 1 everywhere, and RGB stands for so many times D65.
    ExpectIntegrals(MakeTable("rgbgrid", parameters), kAcross, kP0, kP1,
                    [&](const Vec3f&, const Vec3f& u) {
                        return Point{0.5f * absorption(u), Rgb::Constant(0.5f),
                                     0.25f * 106.8569f * emission(u)};
                    });
    parameters.back() = Int("nx", 3);
    EXPECT_HAS(ErrorOf([&] { MakeTable("rgbgrid", parameters); }),
               "scene.pbrt:3: medium \"m\" has 12 values of \"sigma_a\" for a grid of");
}

TEST(Cloud, HasTheDensityOfPbrtV4) {
    struct Case {
        Vec3f p;
        float density, wispiness, frequency, expected;
    };
    // By pbrt-v4's own functions.
    constexpr float kTolerance = 2e-5f;
    for (const Case& c : {Case{{0.31f, 0.62f, 0.17f}, 1, 1, 5, 0.5080121f},
                          {{0.31f, 0.62f, 0.17f}, 1, 0, 5, 0.4088092f},
                          {{0.71f, 0.55f, 0.93f}, 2, 1, 5, 0.800458f},
                          {{0.12f, 0.8f, 0.44f}, 3, 1, 3, 0.7101943f},
                          {{0.5f, 0.45f, 0.21f}, 1, 1, 5, 0.3015476f},
                          {{0.2f, 0.9f, 0.64f}, 10, 0.5f, 7, 0},
                          {{0.3f, -0.1f, 0.8f}, 1, 1, 5, 1},
                          {{0.3f, 1.1f, 0.8f}, 1, 1, 5, 0}}) {
        const CloudDensity cloud{Vec3f(0, -1, 0), Vec3f(1, 2, 4), c.density, c.wispiness,
                                 c.frequency};
        const Vec3f u(c.p.x(), (c.p.y() + 1) / 2, c.p.z() / 4);
        EXPECT_NEAR(cloud(u), c.expected, kTolerance) << c.p.transpose();
    }
    const MediumTable table =
        MakeTable("cloud", {PointParameter("p0", {-1, 0, 2}), PointParameter("p1", {1, 1, 5}),
                            Color("sigma_a", {0, 1, 0}), Color("sigma_s", {2, 1, 0.5f})});
    const CloudDensity cloud{kP0, kP1 - kP0, 1, 1, 5};
    ExpectIntegrals(
        table, kAcross, kP0, kP1,
        [&](const Vec3f&, const Vec3f& u) {
            const float d = cloud(u);
            return Point{Rgb(0, 1, 0) * d, Rgb(2, 1, 0.5f) * d};
        },
        30000);
}

TEST(MediumTable, KnowsPresetsAndDefaults) {
    const MediumTable milk = MakeTable("homogeneous", {});
    const auto& m = std::get<HomogeneousMedium>(milk.media[0]);
    EXPECT_NEAR(m.sigmaS.x(), 2.55f, 1e-6);
    EXPECT_NEAR(m.sigmaT.z(), 3.784f, 1e-5);
    const MediumTable coke = MakeTable("homogeneous", {String("preset", "Coke")});
    EXPECT_NEAR(std::get<HomogeneousMedium>(coke.media[0]).sigmaT.y(), 0.16503 + 8.372e-5, 1e-6);
}

TEST(MediumTable, RefusesNonsense) {
    const auto error = [](const std::string& kind, std::vector<Parameter> parameters) {
        return ErrorOf([&] { MakeTable(kind, std::move(parameters)); });
    };
    EXPECT_HAS(error("smoke", {}), "scene.pbrt:3: medium \"m\": kind \"smoke\"");
    EXPECT_HAS(error("homogeneous", {Color("sigma_a", {0, -1, 0})}), "\"sigma_a\"");
    EXPECT_HAS(error("homogeneous", {Color("sigma_s", {0, kInfinity, 0})}), "\"sigma_s\"");
    for (const float g : {1.001f, -2.f, std::nanf("")})
        EXPECT_HAS(error("homogeneous", {Float("g", g)}), "\"g\"");
    EXPECT_HAS(error("heterogeneous", {}), "0 values");
    EXPECT_HAS(error("heterogeneous", GridParameters({1, 2})), "2 values");
    for (const float densest : {1e8f, 1e30f}) {
        std::vector<float> density(12, 0.f);
        density[0] = densest;
        EXPECT_HAS(error("heterogeneous", GridParameters(density)),
                   "scene.pbrt:3: medium \"m\" is too dense to be traced");
    }
    std::vector<float> bad(12, 1.f);
    bad[5] = -1;
    EXPECT_HAS(error("heterogeneous", GridParameters(bad)), "density");
    std::vector<Parameter> flat = GridParameters(std::vector<float>(12, 1.f));
    flat.push_back({ParameterType::Point3, "p1", LocAt(7), std::vector<float>{-1, 1, 5}});
    EXPECT_HAS(error("heterogeneous", flat), "span a box");
}

TEST(MediumTable, KnowsWhatLiesBeyond) {
    MediumTable table;
    const auto beyond = [&](int shape, bool onNormalSide, int current) {
        return table.Beyond(shape, onNormalSide, true, MediumStack(current)).Top();
    };
    EXPECT_EQ(beyond(0, true, 3), 3);
    table.ofShapes = {{0, 1}, {2, 2}, {kVacuum, 0}};
    EXPECT_EQ(beyond(0, true, 5), 1);
    EXPECT_EQ(beyond(0, false, 5), 0);
    EXPECT_EQ(beyond(1, false, 5), 5);
    EXPECT_EQ(beyond(2, false, 0), kVacuum);
}

TEST(MediumStack, LeavesTheLatestOfAMedium) {
    MediumStack stack;
    EXPECT_EQ(stack.Top(), kVacuum);
    stack.Leave(3);
    for (const int medium : {1, 2, 1, 3}) stack.Enter(medium);
    stack.Leave(1);
    EXPECT_EQ(stack.Top(), 3);
    stack.Leave(3);
    EXPECT_EQ(stack.Top(), 2);
    stack.Leave(2);
    EXPECT_EQ(stack.Top(), 1);
    for (int medium = 10; medium < 30; ++medium) stack.Enter(medium);
    EXPECT_EQ(stack.Top(), 29);
    for (int medium = 29; medium >= 10; --medium) stack.Leave(medium);
    EXPECT_EQ(stack.Top(), kVacuum);
}

TEST(HenyeyGreenstein, IsSampledAsItIs) {
    const Vec3f wo = Vec3f(0.3f, -0.5f, 0.7f).normalized();
    for (const float g : {0.f, 0.0005f, 0.5f, -0.7f, 0.95f}) {
        constexpr int kSamples = 200000;
        double total, cosine = 0;
        const double p = test::PValueOf(
            test::EvenGrid(20, 24),
            [&](const Vec3f& wi) { return PhaseHenyeyGreenstein(wo.dot(wi), g); }, kSamples, 4,
            [&](test::Random& random) {
                const Vec3f wi = SampleHenyeyGreenstein(wo, g, random.Point());
                EXPECT_NEAR(wi.norm(), 1, 1e-5);
                cosine -= wi.dot(wo) / kSamples;
                return wi;
            },
            &total);
        EXPECT_NEAR(total, 1, 5e-3) << g;
        EXPECT_NEAR(cosine, g, 0.01);  // the mean cosine of the deflection
        if (g < 0.9f) {
            EXPECT_GT(p, 1e-4) << g;
        }
    }
}

}  // namespace
}  // namespace lull::media_test
