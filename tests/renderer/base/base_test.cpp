// Tests the small things everything uses: geometry, color and memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <numeric>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/base/memory.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {
namespace {

TEST(OffsetRayOrigin, LeavesTheErrorBoxOnTheRightSide) {
    test::Random random(1);
    for (int k = 0; k < 100000; ++k) {
        const float scale = std::pow(10.f, 8 * random.Float() - 4);
        const Vec3f p = scale * random.Direction(), n = random.Direction(), w = random.Direction();
        const Vec3f error = Gamma(5) * p.cwiseAbs();
        const Vec3f q = OffsetRayOrigin(p, error, n, w);
        const Eigen::Vector3d moved = q.cast<double>() - p.cast<double>();
        const double along = moved.dot(n.cast<double>()) * (w.dot(n) < 0 ? -1 : 1);
        // Anywhere in the box of errors, the surface lies at most this far along n.
        ASSERT_GE(along, n.cwiseAbs().cast<double>().dot(error.cast<double>()) * (1 - 1e-6));
        ASSERT_LT(moved.norm(), 1e-5 * scale);
    }
    const Vec3f p(1, 2, 3);
    EXPECT_EQ(OffsetRayOrigin(p, Vec3f::Zero(), Vec3f(0, 0, 1), Vec3f(0, 0, 1)), p);
}

TEST(NextFloatTowards, IsTheNextFloat) {
    test::Random random(9);
    constexpr float kMost = 0x1.fffffep127f, kLeast = 0x1p-149f, kNormal = 0x1p-126f;
    std::vector<float> values = {0,       -0.f,     1,     -1,     kLeast, -kLeast,
                                 kNormal, -kNormal, kMost, -kMost, 2,      -2};
    for (int k = 0; k < 10000; ++k)
        values.push_back(std::ldexp(random.Float() - 0.5f, int(random.Float() * 250) - 125));
    for (const float v : values) {
        EXPECT_EQ(NextFloatTowards(0.5f, v), std::nextafter(v, kInfinity)) << v;
        EXPECT_EQ(NextFloatTowards(-1e30f, v), std::nextafter(v, -kInfinity)) << v;
        EXPECT_EQ(NextFloatTowards(0, v), v);
        EXPECT_EQ(NextFloatTowards(-0.f, v), v);
    }
}

TEST(CoordinateSystem, IsOrthonormalAndRightHanded) {
    test::Random random(2);
    std::vector<Vec3f> normals = {Vec3f::UnitX(),  -Vec3f::UnitX(), Vec3f::UnitY(),
                                  -Vec3f::UnitY(), Vec3f::UnitZ(),  -Vec3f::UnitZ()};
    for (int k = 0; k < 10000; ++k) normals.push_back(random.Direction());
    for (int k = 0; k < 1000; ++k)
        normals.push_back(Vec3f(1e-4f * random.Float(), 1e-4f * random.Float(), -1).normalized());
    for (const Vec3f& n : normals) {
        Frame f{{}, {}, n};
        CoordinateSystem(n, &f.s, &f.t);
        ASSERT_NEAR(f.s.norm(), 1, 1e-5);
        ASSERT_NEAR(f.t.norm(), 1, 1e-5);
        ASSERT_NEAR(f.s.dot(f.t), 0, 1e-5);
        ASSERT_NEAR((f.s.cross(f.t) - n).norm(), 0, 1e-5);
        const Vec3f v = random.Direction();
        ASSERT_NEAR((f.FromLocal(f.ToLocal(v)) - v).norm(), 0, 1e-5);
    }
}

TEST(Transforms, KeepNormalsPerpendicular) {
    test::Random random(3);
    for (int k = 0; k < 1000; ++k) {
        Mat4d m = Mat4d::Identity();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) m(i, j) = random.Float() - 0.5 + (i == j ? 2 : 0);
        const Vec3f n = random.Direction(), p = random.Direction();
        Vec3f s, t;
        CoordinateSystem(n, &s, &t);
        EXPECT_NEAR(TransformNormal(m.inverse(), n).dot(TransformVector(m, s)), 0, 1e-5);
        EXPECT_NEAR(
            (TransformPoint(m, p + s) - TransformPoint(m, p) - TransformVector(m, s)).norm(), 0,
            1e-5);
    }
}

TEST(Bounds, StartEmptyAndGrow) {
    Bounds3f bounds;
    EXPECT_TRUE(bounds.IsEmpty());
    bounds.Extend(Vec3f(1, 2, 3));
    EXPECT_FALSE(bounds.IsEmpty());
    EXPECT_EQ(bounds.Diagonal(), Vec3f::Zero());
    bounds.Extend(Bounds3f());
    bounds.Extend(Vec3f(0, 5, 3));
    EXPECT_EQ(bounds.Diagonal(), Vec3f(1, 3, 0));
}

TEST(Memory, IsCheckedBeforeItIsTaken) {
    EXPECT_GT(AvailableMemory(), 1 << 20);
    EXPECT_NO_THROW(CheckMemory(1000, "a thousand bytes", "take less"));
    try {
        CheckMemory(int64_t(1) << 60, "an exbibyte", "take less", {});
        ADD_FAILURE() << "no machine has that much";
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("an exbibyte needs 1152921504.6 GB"));
        EXPECT_TRUE(std::string(error.what()).ends_with("GB are available; take less"));
    }
}

TEST(Color, RoundTripsTheTransferCurve) {
    for (int i = 0; i <= 10000; ++i) {
        const float v = i / 10000.f;
        EXPECT_NEAR(LinearFromSrgb(SrgbFromLinear(v)), v, 1e-6f + 1e-5f * v);
        EXPECT_NEAR(SrgbFromLinear(LinearFromSrgb(v)), v, 1e-5);
    }
    EXPECT_EQ(SrgbFromLinear(0), 0);
    EXPECT_NEAR(SrgbFromLinear(1), 1, 1e-6);
    EXPECT_NEAR(SrgbFromLinear(0.5f), 0.735357, 1e-5);
    EXPECT_NEAR(LinearFromSrgb(0.5f), 0.214041, 1e-5);
    // The two pieces of the curve meet.
    EXPECT_NEAR(SrgbFromLinear(0.0031308f), SrgbFromLinear(0.0031309f), 2e-6);
}

TEST(Color, WhiteHasLuminanceOne) {
    EXPECT_NEAR(Luminance(Rgb::Ones()), 1, 1e-6);
    EXPECT_FLOAT_EQ(Luminance(Rgb(0, 1, 0)), 0.715160f);
}

TEST(LengthOf, IsRightAlsoWhereSquaresAreNot) {
    for (const float scale : {1e-30f, 1e-20f, 1.f, 1e20f, 1e30f}) {
        const Vec3f v = scale * Vec3f(2, -3, 6);
        EXPECT_NEAR(LengthOf(v) / scale, 7, 1e-5);
        EXPECT_NEAR((UnitOf(v) - Vec3f(2, -3, 6) / 7).norm(), 0, 1e-6);
    }
    EXPECT_EQ(LengthOf(Vec3f::Zero()), 0);
    EXPECT_EQ(UnitOf(Vec3f::Zero()), Vec3f::Zero());
}

using Zeros = std::vector<float, ZeroAllocator<float>>;

TEST(ZeroAllocator, BeginsWithZerosAndCopiesValues) {
    const auto isZero = [](float v) { return v == 0; };
    for (const size_t count : {size_t(7), size_t(10'000'000)}) {
        Zeros dirty(count);
        EXPECT_TRUE(std::ranges::all_of(dirty, isZero));
        std::ranges::fill(dirty, 3.f);
        const Zeros copy = dirty;
        dirty = {};
        EXPECT_TRUE(std::ranges::all_of(Zeros(count), isZero));
        EXPECT_EQ(copy, Zeros(count, 3.f));
    }
}

TEST(ForgetValues, LeavesWhatIsBeside) {
    Zeros values(1 << 16, 5.f);
    ForgetValues({});
    ForgetValues(std::as_bytes(std::span(values).subspan(10, 3)));
    EXPECT_EQ(values[11], 5);  // less than a page
    ForgetValues(std::as_bytes(std::span(values).subspan(100, 50'000)));
    EXPECT_TRUE(std::all_of(values.begin(), values.begin() + 100, [](float v) { return v == 5; }));
    EXPECT_TRUE(std::all_of(values.begin() + 50'100, values.end(), [](float v) { return v == 5; }));
    std::ranges::fill(values, 7.f);
    EXPECT_EQ(values[20'000], 7);
}

TEST(LazyZeros, AreZerosThatCanBeWritten) {
    for (const size_t bytes : {size_t(4), size_t(100), size_t(5) << 20}) {
        const LazyZeros memory(bytes);
        auto* const data = static_cast<unsigned char*>(memory.Data());
        EXPECT_EQ(reinterpret_cast<uintptr_t>(data) % 4096, 0u);
        for (size_t i = 0; i < bytes; i += 97) {
            ASSERT_EQ(data[i], 0);
            data[i] = 1;
        }
        ASSERT_EQ(data[bytes - 1] & ~1, 0);
    }
    EXPECT_EQ(LazyZeros().Data(), nullptr);
    EXPECT_THROW(LazyZeros(size_t(1) << 60), std::bad_alloc);
}

TEST(LargePages, ChangeNothingInMemory) {
    std::vector<uint32_t> numbers(size_t(3) << 20);
    std::iota(numbers.begin(), numbers.end(), 7u);
    MoveIntoLargePages();
    for (size_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], uint32_t(i) + 7);
}

}  // namespace
}  // namespace lull
