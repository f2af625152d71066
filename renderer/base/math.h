// Defines the vector types and the basic geometry that everything uses.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec2i = Eigen::Vector2i;
using Vec3i = Eigen::Vector3i;
using Mat3f = Eigen::Matrix3f;
// Composed in double, so that long chains of directives lose nothing, and applied in float.
using Mat4d = Eigen::Matrix4d;
// Represents linear RGB (sRGB primaries); Array, so that products and quotients are per channel.
using Rgb = Eigen::Array3f;

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

template <typename T>
constexpr T Sqr(T x) {
    return x * x;
}

// Returns the square root of x, 0 for the small negative values that rounding leaves.
inline float SafeSqrt(float x) { return std::sqrt(std::max(0.f, x)); }

// Return the length of v and the vector of length 1 in its direction. Products of two lengths, as
// of which normals are made, have squares beyond floats where scenes are very large or small. The
// unit vector of none is none.
inline float LengthOf(const Vec3f& v) {
    const float square = v.squaredNorm();
    const bool isExact = square >= std::numeric_limits<float>::min() && square < kInfinity;
    return isExact ? std::sqrt(square) : float(v.cast<double>().norm());
}
inline Vec3f UnitOf(const Vec3f& v) {
    const float square = v.squaredNorm();
    if (square >= std::numeric_limits<float>::min() && square < kInfinity) [[likely]]
        return v / std::sqrt(square);
    return v.cast<double>().normalized().cast<float>();
}

inline float Lerp(float t, float a, float b) { return (1 - t) * a + t * b; }

// Bounds the relative error of n float operations: (1 + e)^n - 1 (Higham 2002, section 3.1).
constexpr float Gamma(int n) {
    constexpr float e = std::numeric_limits<float>::epsilon() * 0.5f;
    return (n * e) / (1 - n * e);
}

// Returns the float next to v on the side that `step` points to, v itself where step is 0. As
// std::nextafter for finite v, but without a call or a branch.
inline float NextFloatTowards(float step, float v) {
    const auto bits = std::bit_cast<int32_t>(v + 0.f);  // of -0: those of 0
    const int32_t away = (step > 0) - (step < 0);       // in value
    // The bits of negative floats count down. Below 0 lies the least negative one.
    constexpr int32_t kLeastNegative = std::numeric_limits<int32_t>::min() + 1;
    const int32_t next = bits + (bits < 0 ? -away : away);
    return std::bit_cast<float>(bits == 0 && away < 0 ? kLeastNegative : next);
}

inline bool IsBlack(const Rgb& c) { return c.x() == 0 && c.y() == 0 && c.z() == 0; }
inline bool IsFinite(const Rgb& c) {
    return std::isfinite(c.x()) && std::isfinite(c.y()) && std::isfinite(c.z());
}

inline Vec3f FaceForward(const Vec3f& v, const Vec3f& reference) {
    return v.dot(reference) < 0 ? Vec3f(-v) : v;
}

// Completes the unit vector n to an orthonormal basis (s, t, n) (Duff et al. 2017, JCGT 6(1)).
inline void CoordinateSystem(const Vec3f& n, Vec3f* s, Vec3f* t) {
    const float sign = std::copysign(1.f, n.z());
    const float a = -1 / (sign + n.z());
    const float b = n.x() * n.y() * a;
    *s = Vec3f(1 + sign * Sqr(n.x()) * a, sign * b, -sign * n.x());
    *t = Vec3f(b, sign + Sqr(n.y()) * a, -n.y());
}

// An orthonormal frame; "local" has n along +z, as all BSDFs here expect.
struct Frame {
    Vec3f s, t, n;

    Vec3f ToLocal(const Vec3f& v) const { return {v.dot(s), v.dot(t), v.dot(n)}; }
    Vec3f FromLocal(const Vec3f& v) const { return s * v.x() + t * v.y() + n * v.z(); }
};

inline Vec3f TransformPoint(const Mat4d& m, const Vec3f& p) {
    const Eigen::Vector4d q = m * p.cast<double>().homogeneous();
    return q.hnormalized().cast<float>();
}
inline Vec3f TransformVector(const Mat4d& m, const Vec3f& v) {
    return (m.topLeftCorner<3, 3>() * v.cast<double>()).cast<float>();
}
// Normals transform by the inverse transpose; `inverse` is the inverse of the point transform.
inline Vec3f TransformNormal(const Mat4d& inverse, const Vec3f& n) {
    return (inverse.topLeftCorner<3, 3>().transpose() * n.cast<double>()).cast<float>();
}

struct Bounds3f {
    Vec3f lower = Vec3f::Constant(kInfinity), upper = Vec3f::Constant(-kInfinity);

    void Extend(const Vec3f& p) {
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
    }
    void Extend(const Bounds3f& b) {
        lower = lower.cwiseMin(b.lower);
        upper = upper.cwiseMax(b.upper);
    }
    bool IsEmpty() const { return !(lower.array() <= upper.array()).all(); }
    Vec3f Diagonal() const { return upper - lower; }
};

struct Ray {
    Vec3f o, d;
    float tMax = kInfinity;
};

// Moves p off the surface with normal n to the side of w, past the error bounds of its
// coordinates, so that a ray from there cannot meet the same surface again (pbrt 3rd ed., 3.9.5).
inline Vec3f OffsetRayOrigin(const Vec3f& p, const Vec3f& error, const Vec3f& n, const Vec3f& w) {
    const float d = n.cwiseAbs().dot(error);
    const Vec3f offset = w.dot(n) < 0 ? Vec3f(-d * n) : Vec3f(d * n);
    const Vec3f q = p + offset;
    return {NextFloatTowards(offset.x(), q.x()), NextFloatTowards(offset.y(), q.y()),
            NextFloatTowards(offset.z(), q.z())};
}

// Compares numbers of files, which exporters have rounded, with limits.

// Relative error of a number that was rounded to float, or printed with six digits.
inline constexpr double kRounding = 1e-5;

// Returns whether `a` is above `b` by more than rounding.
inline bool IsAbove(double a, double b) {
    return a - b > kRounding * std::max(std::abs(a), std::abs(b));
}

// Returns x, clamped to the finite range, if it lies there or just as far outside as rounding the
// range's ends could take it; nothing for all else and NaN.
inline std::optional<double> InRange(double x, double least, double most) {
    const double slack = kRounding * std::max(std::abs(least), std::abs(most));
    if (!(x >= least - slack && x <= most + slack)) return {};
    return std::clamp(x, least, most);
}

// Returns degrees in (0, 180]; for 180, an infinite image plane, 179.94. Nothing for other numbers.
inline std::optional<double> FieldOfView(double degrees) {
    constexpr double kWidest = 179.94;
    const auto inRange = InRange(degrees, 0, 180);
    if (!inRange || !(*inRange > 0)) return {};
    return *inRange < 180 ? *inRange : kWidest;
}

// Returns x, 0 for what rounding a 0 could leave below it; nothing for negative numbers, NaN.
inline std::optional<double> NotNegative(double x) {
    if (!(x >= -kRounding)) return {};
    return std::max(x, 0.0);
}

// A rectangle of pixels.

// The pixels [min, max).
struct PixelRect {
    Vec2i min = {0, 0}, max = {0, 0};

    int Width() const { return max.x() - min.x(); }
    int Height() const { return max.y() - min.y(); }
    int64_t Area() const { return int64_t(Width()) * Height(); }
    bool operator==(const PixelRect& r) const { return min == r.min && max == r.max; }
};

// A rendered image: linear RGB, row-major triples.
struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> values;
};

// Converts between linear RGB, luminance and display values.

inline float Luminance(const Rgb& c) { return Luminance(c.x(), c.y(), c.z()); }

// Maps linear [0, 1] to the sRGB transfer curve (IEC 61966-2-1).
inline float SrgbFromLinear(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

inline float LinearFromSrgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace lull
