// Tests media: what they transmit and where they scatter, and how they are read.
#include "renderer/scene/media/medium_table.h"

#include <gtest/gtest.h>

#include "renderer/bsdf/subsurface.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

MediumTable MakeTable(const std::string& kind, std::vector<Parameter> parameters,
                      const Mat4d& place = Mat4d::Identity()) {
    Description description;
    MediumEntity entity;
    entity.name = kind;
    entity.mediumName = "m";
    entity.loc = LocAt(3);
    entity.worldFromMedium = place;
    for (Parameter& p : parameters) entity.parameters.Add(std::move(p));
    description.media.push_back(std::move(entity));
    Warnings warnings;
    MediumTable table(description, warnings);
    EXPECT_EQ(warnings.Total(), 0);
    return table;
}

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

struct Moments {
    Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = sum;
    int count = 0;

    void Add(const Rgb& v) {
        sum += v.cast<double>();
        squares += v.cast<double>().square();
        ++count;
    }
    void ExpectMean(const Eigen::Array3d& expected) const {
        const Eigen::Array3d mean = sum / count;
        const Eigen::Array3d error = ((squares / count - mean.square()) / count).max(0).sqrt();
        EXPECT_TRUE(((mean - expected).abs() <= 4.5 * error + 1e-5).all())
            << mean.transpose() << " instead of " << expected.transpose();
    }
};

// Both the estimates of transmittance and the rays that pass have the mean exp(-depth); those that
// scatter have the albedo of the rest. `depth` is that of the ray, by channel.
void ExpectBeerLambert(const MediumTable& table, const Ray& ray, const Eigen::Array3d& depth,
                       const Eigen::Array3d& albedo) {
    Sampler sampler(SamplerKind::Random, 1);
    Moments transmitted, passed, scattered;
    for (int i = 0; i < 200000; ++i) {
        sampler.StartSample({0, 0}, uint32_t(i));
        transmitted.Add(table.Transmittance(0, ray, sampler));
        const MediumSample s = table.Sample(0, ray, sampler);
        ASSERT_TRUE((s.weight >= 0).all() && IsFinite(s.weight));
        ASSERT_TRUE(!s.t || (*s.t >= 0 && *s.t <= ray.tMax * 1.00001f));
        passed.Add(s.t ? Rgb(Rgb::Zero()) : s.weight);
        scattered.Add(s.t ? s.weight : Rgb(Rgb::Zero()));
    }
    transmitted.ExpectMean((-depth).exp());
    passed.ExpectMean((-depth).exp());
    scattered.ExpectMean(albedo * (1 - (-depth).exp()));
}

TEST(HomogeneousMedium, FollowsBeerAndLambert) {
    const MediumTable table = MakeTable(
        "homogeneous", {RgbParameter("sigma_a", 0.1f, 0.5f, 0), FloatParameter("scale", {2}),
                        RgbParameter("sigma_s", 0.3f, 0.1f, 0.2f)});
    const Eigen::Array3d extinction(0.8, 1.2, 0.4), albedo(0.75, 1 / 6.0, 1);
    // The direction need not be unit.
    ExpectBeerLambert(table, {Vec3f::Zero(), Vec3f(0, 0, 2), 0.7f}, 1.4 * extinction, albedo);
    ExpectBeerLambert(table, {Vec3f::Zero(), Vec3f(0, 0, 1), kInfinity},
                      Eigen::Array3d::Constant(1e9), albedo);
}

TEST(HomogeneousMedium, MayBeEmptyOrDense) {
    Sampler sampler(SamplerKind::Random, 2);
    const auto rgb = [](const char* name, float v) { return RgbParameter(name, v, v, v); };
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
    return {IntParameter("nx", 2),
            IntParameter("ny", 2),
            IntParameter("nz", 3),
            FloatParameter("density", std::move(density)),
            {ParameterType::Point3, "p0", LocAt(7), std::vector<float>{-1, 0, 2}},
            {ParameterType::Point3, "p1", LocAt(7), std::vector<float>{1, 1, 5}},
            RgbParameter("sigma_a", 0.25f * sigma, 0.5f * sigma, 0),
            RgbParameter("sigma_s", 0.75f * sigma, 0.5f * sigma, sigma)};
}

TEST(GridMedium, FollowsBeerAndLambert) {
    const std::vector<float> density = {0, 1, 2, 0.5f, 1.5f, 0, 3, 1, 0.2f, 0.7f, 0, 2};
    Mat4d place = Mat4d::Identity();
    place(0, 0) = 2;
    place(1, 3) = -0.5;
    const MediumTable table = MakeTable("heterogeneous", GridParameters(density), place);
    const auto& grid = std::get<GridMedium>(table.media[0]);
    // At the middles of cells the density is the grid's; outside there is none.
    EXPECT_NEAR(grid.Density(Vec3f(0.75f, 0.25f, 0.5f)), 0, 1e-6);
    EXPECT_NEAR(grid.Density(Vec3f(0.25f, 0.75f, 0.5f)), 3, 1e-5);
    EXPECT_NEAR(grid.Density(Vec3f(0.5f, 0.5f, 1 / 6.f)), 0.875, 1e-5);
    EXPECT_EQ(grid.Density(Vec3f(2, 2, 2)), 0);

    const Ray ray{Vec3f(-3, -0.3f, 1), Vec3f(0.9f, 0.12f, 0.5f).normalized() * 2, 3};
    const Mat4d inverse = place.inverse();
    double depth = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const Vec3f p = TransformPoint(inverse, Vec3f(ray.o + (i + 0.5f) / kSteps * 3 * ray.d));
        const Vec3f q = (p - Vec3f(-1, 0, 2)).cwiseQuotient(Vec3f(2, 1, 3));
        if ((q.array() >= 0).all() && (q.array() <= 1).all())
            depth += grid.Density(q) * 6.0 / kSteps;
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

TEST(MediumTable, KnowsPresetsAndDefaults) {
    const MediumTable milk = MakeTable("homogeneous", {});
    const auto& m = std::get<HomogeneousMedium>(milk.media[0]);
    EXPECT_NEAR(m.sigmaS.x(), 2.55f, 1e-6);
    EXPECT_NEAR(m.sigmaT.z(), 3.784f, 1e-5);
    const MediumTable coke = MakeTable("homogeneous", {StringParameter("preset", "Coke")});
    EXPECT_NEAR(std::get<HomogeneousMedium>(coke.media[0]).sigmaT.y(), 0.16503 + 8.372e-5, 1e-6);
}

TEST(MediumTable, RefusesNonsense) {
    const auto error = [](const std::string& kind, std::vector<Parameter> parameters) {
        return ErrorOf([&] { MakeTable(kind, std::move(parameters)); });
    };
    EXPECT_TRUE(Contains(error("smoke", {}), "scene.pbrt:3: medium \"m\": kind \"smoke\""));
    EXPECT_TRUE(Contains(error("homogeneous", {RgbParameter("sigma_a", 0, -1, 0)}), "\"sigma_a\""));
    EXPECT_TRUE(
        Contains(error("homogeneous", {RgbParameter("sigma_s", 0, kInfinity, 0)}), "\"sigma_s\""));
    for (const float g : {1.001f, -2.f, std::nanf("")})
        EXPECT_TRUE(Contains(error("homogeneous", {FloatParameter("g", {g})}), "\"g\""));
    EXPECT_TRUE(Contains(error("heterogeneous", {}), "0 values"));
    EXPECT_TRUE(Contains(error("heterogeneous", GridParameters({1, 2})), "2 values"));
    for (const float densest : {1e8f, 1e30f}) {
        std::vector<float> density(12, 0.f);
        density[0] = densest;
        EXPECT_TRUE(Contains(error("heterogeneous", GridParameters(density)),
                             "scene.pbrt:3: medium \"m\" is too dense to be traced"));
    }
    std::vector<float> bad(12, 1.f);
    bad[5] = -1;
    EXPECT_TRUE(Contains(error("heterogeneous", GridParameters(bad)), "density"));
    std::vector<Parameter> flat = GridParameters(std::vector<float>(12, 1.f));
    flat.push_back({ParameterType::Point3, "p1", LocAt(7), std::vector<float>{-1, 1, 5}});
    EXPECT_TRUE(Contains(error("heterogeneous", flat), "span a box"));
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
}  // namespace lull
