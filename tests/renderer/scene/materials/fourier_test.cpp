// Tests tabulated scattering: its file format, and that it is evaluated and sampled as it says.
#include <gtest/gtest.h>

#include "renderer/scene/materials/basic.h"
#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"

namespace lull::test {
namespace {

// What a .bsdf file does, to be spoilt.
struct BsdfFile {
    std::string magic = "SCATFUN\x01";
    int flags = 1, order = 2, channels = 3, bases = 1;
    float eta = 1;
    std::vector<float> mu, cdf, coefficients;
    std::vector<int> places;

    std::string Bytes() const {
        std::string bytes = magic;
        const auto add = [&](const auto& v) { bytes.append(reinterpret_cast<const char*>(&v), 4); };
        for (const int v :
             {flags, int(mu.size()), int(coefficients.size()), order, channels, bases, 0, 0, 0})
            add(v);
        add(eta);
        for (int i = 0; i < 4; ++i) add(0);
        for (const auto* values : {&mu, &cdf})
            for (const float v : *values) add(v);
        for (const int v : places) add(v);
        for (const float v : coefficients) add(v);
        return bytes;
    }
};

// Integrates the Catmull-Rom spline through the values up to each node.
std::vector<float> IntegralsOf(const std::vector<float>& x, const std::vector<float>& f) {
    std::vector<float> integrals = {0};
    const int n = int(x.size());
    for (int i = 0; i + 1 < n; ++i) {
        const float w = x[i + 1] - x[i];
        const float d0 =
            i > 0 ? w * (f[i + 1] - f[i - 1]) / (x[i + 1] - x[i - 1]) : f[i + 1] - f[i];
        const float d1 = i + 2 < n ? w * (f[i + 2] - f[i]) / (x[i + 2] - x[i]) : f[i + 1] - f[i];
        integrals.push_back(integrals.back() + ((d0 - d1) / 12 + (f[i] + f[i + 1]) / 2) * w);
    }
    return integrals;
}

// Scatters to both sides: luminance (1 + cos phi / 2) g(muI, muO), smooth and positive.
BsdfFile ExampleAt(std::vector<float> mu) {
    BsdfFile file;
    const int kNodes = int(mu.size());
    file.mu = std::move(mu);
    for (int o = 0; o < kNodes; ++o) {
        std::vector<float> row;
        for (int i = 0; i < kNodes; ++i) {
            const float muI = file.mu[i], muO = file.mu[o];
            const float y = 0.05f * std::abs(muI) * (2 - 0.5f * muI * muO);
            row.push_back(y);
            file.places.push_back(int(file.coefficients.size()));
            file.places.push_back(2);
            for (const float v : {y, 0.5f * y, 1.2f * y, 0.1f * y, 0.7f * y, 0.3f * y})
                file.coefficients.push_back(v);
        }
        for (const float v : IntegralsOf(file.mu, row)) file.cdf.push_back(v);
    }
    return file;
}

BsdfFile Example() {
    constexpr int kNodes = 20;
    std::vector<float> mu;
    for (int i = 0; i < kNodes; ++i) mu.push_back(-std::cos(kPi * float(i) / (kNodes - 1)));
    return ExampleAt(std::move(mu));
}

// Has the node of the horizon twice, as files of measured and layered materials do.
BsdfFile ExampleWithTwoHorizons() {
    std::vector<float> mu;
    for (int i = 0; i <= 10; ++i) mu.push_back(-std::cos(kPi / 2 * float(i) / 10));
    mu.back() = 0;
    for (int i = 10; i >= 0; --i) mu.push_back(-mu[size_t(i)]);
    return ExampleAt(std::move(mu));
}

FourierTable Load(const BsdfFile& file) {
    const TemporaryDirectory directory;
    return LoadFourierTable(directory.Write("a.bsdf", file.Bytes()));
}

TEST(Fourier, HasTheValuesOfItsTable) {
    const FourierTable table = Load(Example());
    const FourierLobe lobe{Rgb(1, 1, 1), &table};
    const int o = 16, i = 3;  // wo above, and so is wi: mu of i is that of -wi
    const float muO = table.mu[o], muI = table.mu[i];
    for (const float phi : {0.f, 1.f, 2.5f}) {
        const float so = std::sqrt(1 - muO * muO), si = std::sqrt(1 - muI * muI);
        const Vec3f wo(so, 0, muO), wi = -Vec3f(si * std::cos(phi), si * std::sin(phi), muI);
        const float y = 0.05f * std::abs(muI) * (2 - 0.5f * muI * muO), c = std::cos(phi);
        const Rgb f = lobe.Evaluate(wo, wi).f * std::abs(muI);
        const float red = y * (1.2f + 0.1f * c), blue = y * (0.7f + 0.3f * c);
        EXPECT_NEAR(f.x(), red, 1e-5);
        EXPECT_NEAR(f.z(), blue, 1e-5);
        EXPECT_NEAR(f.y(), 1.39829f * y * (1 + 0.5f * c) - 0.100913f * blue - 0.297375f * red,
                    1e-5);
        // Scaling is that of all channels.
        const FourierLobe half{Rgb(0.5f, 0.5f, 0.5f), &table};
        EXPECT_NEAR(half.Evaluate(wo, wi).f.x(), 0.5f * f.x() / std::abs(muI), 1e-5);
    }
}

TEST(Fourier, RefractionScalesRadiance) {
    BsdfFile file = Example();
    const FourierTable plain = Load(file);
    file.eta = 1.5f;
    const FourierTable dense = Load(file);
    const Vec3f wo = FromAngles(40, 10), up = FromAngles(30, 200), down = FromAngles(150, 200);
    const FourierLobe a{Rgb(1, 1, 1), &plain}, b{Rgb(1, 1, 1), &dense};
    EXPECT_FLOAT_EQ(b.Evaluate(wo, up).f.x(), a.Evaluate(wo, up).f.x());
    // Light from below comes out of the dense side.
    EXPECT_NEAR(b.Evaluate(wo, down).f.x(), a.Evaluate(wo, down).f.x() / 2.25f, 1e-5);
    EXPECT_NEAR(b.Evaluate(down, wo).f.x(), a.Evaluate(down, wo).f.x() * 2.25f, 1e-4);
}

void ExpectThatItFollowsItsDensity(const FourierTable& table, uint64_t seed) {
    const FourierLobe lobe{Rgb(1, 1, 1), &table};
    for (const double angle : {0.0, 25.0, 70.0, 89.0, 130.0, 180.0}) {
        const Vec3f wo = FromAngles(angle, 37);
        const Bsdf bsdf = MakeBsdf({lobe});
        double total;
        const double p = PValueOf(
            EvenGrid(24, 24), [&](const Vec3f& wi) { return double(lobe.Evaluate(wo, wi).pdf); },
            100000, ++seed,
            [&](Random& random) { return SampleSpread(bsdf, wo, random.Point(), LobeSet::All); },
            &total);
        EXPECT_NEAR(total, 1, 5e-3) << angle;
        EXPECT_GT(p, 1e-4) << angle;
    }
}

TEST(Fourier, FollowsItsDensity) { ExpectThatItFollowsItsDensity(Load(Example()), 1); }

TEST(Fourier, MayHaveTheHorizonTwice) {
    const FourierTable table = Load(ExampleWithTwoHorizons());
    ASSERT_EQ(table.mu[10], table.mu[11]);
    ExpectThatItFollowsItsDensity(table, 7);
    const FourierLobe lobe{Rgb(1, 1, 1), &table};
    for (const double angle : {89.9999, 90., 90.0001})
        for (const double other : {1., 89.9999, 90., 90.0001, 179.}) {
            const BsdfValue value = lobe.Evaluate(FromAngles(angle, 0), FromAngles(other, 50));
            EXPECT_TRUE(IsFinite(value.f) && value.pdf >= 0 && std::isfinite(value.pdf))
                << angle << " " << other;
        }
}

TEST(Fourier, RefusesBrokenFiles) {
    const auto error = [](const auto& spoil) {
        BsdfFile file = Example();
        spoil(&file);
        return lull::ErrorOf([&] { Load(file); });
    };
    EXPECT_EQ(error([](BsdfFile*) {}), "");
    const auto expect = [&](const char* part, const auto& spoil) {
        const std::string e = error(spoil);
        EXPECT_HAS(e, part);
        EXPECT_HAS(e, "a.bsdf");
    };
    expect("is not a .bsdf file", [](BsdfFile* f) { f->magic = "SCATFUN\x02"; });
    expect("not supported", [](BsdfFile* f) { f->flags = 3; });
    expect("not supported", [](BsdfFile* f) { f->channels = 2; });
    expect("not supported", [](BsdfFile* f) { f->bases = 4; });
    expect("order", [](BsdfFile* f) { f->order = 100000; });
    expect("index of refraction", [](BsdfFile* f) { f->eta = -1; });
    expect("1 nodes", [](BsdfFile* f) { f->mu.resize(1); });
    expect("do not ascend", [](BsdfFile* f) { std::swap(f->mu[3], f->mu[4]); });
    expect("do not ascend", [](BsdfFile* f) { f->mu[1] = f->mu[0]; });
    expect("do not ascend", [](BsdfFile* f) { f->mu[18] = f->mu[19]; });
    expect("not finite", [](BsdfFile* f) { f->coefficients[7] = std::nanf(""); });
    expect("cut short",
           [](BsdfFile* f) { f->cdf.resize(300), f->places.clear(), f->coefficients.clear(); });
    expect("a series of", [](BsdfFile* f) { f->places[4] = -1; });
    expect("a series of", [](BsdfFile* f) { f->places[5] = 3; });
    expect("a series of", [](BsdfFile* f) { f->places[4] = int(f->coefficients.size()) - 5; });
    const std::string whole = Example().Bytes();
    for (size_t length = 0; length < whole.size(); length += 97) {
        const TemporaryDirectory directory;
        EXPECT_NE(lull::ErrorOf([&] {
                      LoadFourierTable(directory.Write("a.bsdf", whole.substr(0, length)));
                  }),
                  "");
    }
}

}  // namespace
}  // namespace lull::test
