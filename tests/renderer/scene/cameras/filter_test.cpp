#include "renderer/scene/cameras/film_settings.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

using Function = std::function<double(double)>;

Filter MakeFilter(const std::string& kind, std::vector<Parameter> parameters) {
    Description description;
    description.filter = {kind, {}, LocAt(3)};
    for (Parameter& p : parameters) description.filter.parameters.Add(std::move(p));
    Warnings warnings;
    Filter filter(description, warnings);
    EXPECT_EQ(warnings.Total(), 0);
    return filter;
}

// Returns the mean of g(x) under the normalised filter f over [-radius, radius].
double Filtered(const Function& f, const Function& g, double radius) {
    double numerator = 0, denominator = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double x = ((i + 0.5) / kSteps * 2 - 1) * radius;
        numerator += f(x) * g(x);
        denominator += f(x);
    }
    return numerator / denominator;
}

double Mitchell(double x, double b, double c) {
    x = std::abs(x);
    if (x < 1)
        return (12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b);
    return (-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b +
           24 * c;
}

// Integrates any function as the filter does, through offsets and weights.
void ExpectFilters(const Filter& filter, const Function& fx, const Function& fy, double rx,
                   double ry) {
    const std::vector<Function> tests = {
        [](double) { return 1.0; }, [](double x) { return x; }, [](double x) { return x * x; },
        [](double x) { return x * x * x * x; }, [](double x) { return std::cos(3 * x); }};
    constexpr int kSamples = 200000;
    test::Random random(1);
    std::vector<FilterSample> samples(kSamples);
    for (FilterSample& s : samples) {
        s = filter.Sample(random.Point());
        ASSERT_LE(std::abs(s.offset.x()), rx * (1 + 1e-6));
        ASSERT_LE(std::abs(s.offset.y()), ry * (1 + 1e-6));
    }
    for (const Function& gx : tests)
        for (const Function& gy : tests) {
            test::SampleMean mean;
            for (const FilterSample& s : samples)
                mean.Add(s.weight * gx(s.offset.x()) * gy(s.offset.y()));
            const double expected = Filtered(fx, gx, rx) * Filtered(fy, gy, ry);
            EXPECT_NEAR(mean.Value(), expected, 4.5 * mean.Error() + 1e-5);
        }
}

TEST(Filter, BoxIsEven) {
    const Function one = [](double) { return 1.0; };
    ExpectFilters(Filter(), one, one, 0.5, 0.5);
    ExpectFilters(MakeFilter("box", {}), one, one, 0.5, 0.5);
    ExpectFilters(MakeFilter("box", {Float("xwidth", 2), Float("ywidth", 1)}), one, one, 2, 1);
}

TEST(Filter, GaussianFallsToZeroAtItsEdge) {
    const auto gaussian = [](double alpha, double r) -> Function {
        return [=](double x) { return std::exp(-alpha * x * x) - std::exp(-alpha * r * r); };
    };
    ExpectFilters(MakeFilter("gaussian", {}), gaussian(2, 2), gaussian(2, 2), 2, 2);
    ExpectFilters(
        MakeFilter("gaussian", {Float("alpha", 0.5f), Float("xwidth", 1), Float("ywidth", 3)}),
        gaussian(0.5, 1), gaussian(0.5, 3), 1, 3);
}

TEST(Filter, MitchellHasNegativeLobes) {
    const auto mitchell = [](double r, double b, double c) -> Function {
        return [=](double x) { return Mitchell(2 * x / r, b, c); };
    };
    ExpectFilters(MakeFilter("mitchell", {}), mitchell(2, 1 / 3., 1 / 3.),
                  mitchell(2, 1 / 3., 1 / 3.), 2, 2);
    const Filter sharp =
        MakeFilter("mitchell", {Float("B", 0), Float("C", 1), Float("xwidth", 1.5f)});
    ExpectFilters(sharp, mitchell(1.5, 0, 1), mitchell(2, 0, 1), 1.5, 2);
    test::Random random(2);
    float least = 1;
    for (int i = 0; i < 1000; ++i) least = std::min(least, sharp.Sample(random.Point()).weight);
    EXPECT_LT(least, 0);
}

TEST(Filter, SincIsWindowedBySinc) {
    const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x); };
    const auto windowed = [&](double tau) -> Function {
        return [=](double x) { return sinc(x) * sinc(x / tau); };
    };
    ExpectFilters(MakeFilter("sinc", {}), windowed(3), windowed(3), 4, 4);
    ExpectFilters(
        MakeFilter("sinc", {Float("tau", 1.5f), Float("xwidth", 1.5f), Float("ywidth", 2)}),
        windowed(1.5), windowed(1.5), 1.5, 2);
}

TEST(Filter, TriangleIsATent) {
    const auto tent = [](double r) -> Function {
        return [=](double x) { return r - std::abs(x); };
    };
    ExpectFilters(MakeFilter("triangle", {Float("ywidth", 1)}), tent(2), tent(1), 2, 1);
}

TEST(Filter, PositiveOnesHaveWeightOne) {
    test::Random random(3);
    for (const char* kind : {"box", "gaussian", "triangle"}) {
        const Filter filter = MakeFilter(kind, {});
        for (int i = 0; i < 1000; ++i)
            ASSERT_FLOAT_EQ(filter.Sample(random.Point()).weight, 1) << kind;
    }
}

// The mean of a function over samples is its integral with the filter's values.
TEST(Filter, HasTheValuesThatItSamples) {
    const auto function = [](const Vec2f& p) { return double(1 + p.x() + Sqr(p.y())); };
    for (const char* kind : {"box", "gaussian", "mitchell", "triangle", "sinc"}) {
        const Filter filter = MakeFilter(kind, {});
        const Vec2f radius = filter.Radius();
        constexpr int kSteps = 512;
        double integral = 0, sampled = 0, squares = 0;
        for (int y = 0; y < kSteps; ++y)
            for (int x = 0; x < kSteps; ++x) {
                const Vec2f u((float(x) + 0.5f) / kSteps, (float(y) + 0.5f) / kSteps);
                const Vec2f offset = (2 * u - Vec2f::Ones()).cwiseProduct(radius);
                integral += double(filter.Evaluate(offset)) * function(offset) * 4 *
                            double(radius.prod()) / Sqr(double(kSteps));
                const FilterSample sample = filter.Sample(u);
                const double value = double(sample.weight) * function(sample.offset);
                sampled += value / Sqr(double(kSteps));
                squares += value * value / Sqr(double(kSteps));
            }
        EXPECT_NEAR(integral, sampled, 0.01 + 0.02 * std::abs(sampled)) << kind;
        EXPECT_EQ(filter.Evaluate(radius * 1.01f), 0) << kind;
    }
}

TEST(Filter, RefusesWhatItCannotSample) {
    EXPECT_HAS(ErrorOf([] { MakeFilter("lanczos", {}); }), "scene.pbrt:3: ");
    EXPECT_NE(ErrorOf([] { MakeFilter("sinc", {Float("tau", 0)}); }), "");
    for (const float width : {0.f, -1.f, 1e20f, std::nanf(""), kInfinity})
        EXPECT_NE(ErrorOf([&] { MakeFilter("box", {Float("xwidth", width)}); }), "");
}

}  // namespace
}  // namespace lull
