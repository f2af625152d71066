#include "renderer/scene/geometry/animated_transform.h"

#include <Eigen/LU>

namespace lull {
namespace {

// The steps of time that a turning thing is bounded in.
constexpr int kSteps = 16;

// Interpolates like pbrt-v3's Slerp: linearly where the angle is small.
Eigen::Quaterniond Interpolate(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b,
                               double cosHalfAngle, double t) {
    if (cosHalfAngle > 0.9995)
        return Eigen::Quaterniond((1 - t) * a.coeffs() + t * b.coeffs()).normalized();
    const double angle = std::acos(std::clamp(cosHalfAngle, -1., 1.)) * t;
    const Eigen::Vector4d across = (b.coeffs() - cosHalfAngle * a.coeffs()).normalized();
    return Eigen::Quaterniond(a.coeffs() * std::cos(angle) + across * std::sin(angle)).normalized();
}

Vec3f CornerOf(const Bounds3f& box, int corner) {
    return {corner & 1 ? box.lower.x() : box.upper.x(), corner & 2 ? box.lower.y() : box.upper.y(),
            corner & 4 ? box.lower.z() : box.upper.z()};
}

}  // namespace

Bounds3f TransformBox(const Mat4d& m, const Bounds3f& box) {
    Bounds3f result;
    for (int i = 0; i < 8; ++i) result.Extend(TransformPoint(m, CornerOf(box, i)));
    return result;
}

Shutter ReadShutter(const Entity& camera) {
    Shutter shutter{camera.parameters.GetFloat("shutteropen", 0),
                    camera.parameters.GetFloat("shutterclose", 1)};
    if (!std::isfinite(shutter.open) || !std::isfinite(shutter.close))
        throw Error(camera.loc, "\"shutteropen\" and \"shutterclose\" have to be finite");
    if (shutter.close < shutter.open) std::swap(shutter.open, shutter.close);
    return shutter;
}

AnimatedTransform::Parts AnimatedTransform::Decompose(const Mat4d& m) {
    const Eigen::Matrix3d linear = m.topLeftCorner<3, 3>();
    Eigen::Matrix3d r = linear;
    for (int i = 0; i < 100; ++i) {
        const Eigen::Matrix3d next = 0.5 * (r + r.inverse().transpose());
        const double change = (next - r).cwiseAbs().maxCoeff();
        r = next;
        if (change < 1e-14) break;
    }
    // A mirror is no rotation; pbrt-v3 leaves it there, and shows no motion between the ends then.
    if (r.determinant() < 0) r = -r;
    return {m.topRightCorner<3, 1>(), Eigen::Quaterniond(r).normalized(), r.transpose() * linear};
}

AnimatedTransform::AnimatedTransform(const Mat4d& start, const Mat4d& end, double startTime,
                                     double endTime, const Shutter& shutter)
    : start(start), end(end), parts{Decompose(start), Decompose(end)} {
    Eigen::Quaterniond& rotation = parts[1].rotation;
    cosHalfAngle = parts[0].rotation.dot(rotation);
    // Half a turn has two shorter arcs. pbrt-v3 takes the one against the sense of Rotate, as its
    // pi is a little too large in float.
    const bool isHalfTurn = std::abs(cosHalfAngle) < 1e-7;
    if (isHalfTurn ? cosHalfAngle > 0 : cosHalfAngle < 0) {
        rotation.coeffs() *= -1;
        cosHalfAngle *= -1;
    }
    if (parts[0].rotation.coeffs() == rotation.coeffs()) cosHalfAngle = 1;

    const double open = shutter.close - shutter.open;
    if (!(open > 0)) {
        this->startTime = startTime, this->endTime = endTime;
        this->start = this->end = At(shutter.open);
        this->startTime = kInfinity;  // so that it is so at all times
        return;
    }
    this->startTime = (startTime - shutter.open) / open;
    this->endTime = (endTime - shutter.open) / open;
    isConstant = At(0) == At(1) && (start == end || this->startTime >= 1 || this->endTime <= 0);
}

Mat4d AnimatedTransform::At(double time) const {
    if (time <= startTime) return start;
    if (time >= endTime) return end;
    const double t = (time - startTime) / (endTime - startTime);
    const auto& [a, b] = parts;
    Mat4d m = Mat4d::Identity();
    m.topLeftCorner<3, 3>() =
        Interpolate(a.rotation, b.rotation, cosHalfAngle, t).toRotationMatrix() *
        ((1 - t) * a.scale + t * b.scale);
    m.topRightCorner<3, 1>() = (1 - t) * a.translation + t * b.translation;
    return m;
}

double AnimatedTransform::Sagitta(const Bounds3f& box, double step) const {
    if (cosHalfAngle >= 1 || isConstant) return 0;
    // p(t) = T + R S x, T and S linear in t: |p''| <= w^2 |S x| + 2 w |S' x| with w the speed of
    // the turn, which is not quite even where it is interpolated linearly.
    const double length = std::max(endTime - startTime, 1e-30);
    const double turn = 1.01 * 2 * std::acos(std::clamp(cosHalfAngle, -1., 1.)) / length;
    double reach = 0, change = 0;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d x = CornerOf(box, i).cast<double>();
        for (const Parts& part : parts) reach = std::max(reach, (part.scale * x).norm());
        change = std::max(change, ((parts[1].scale - parts[0].scale) * x).norm() / length);
    }
    const double within = std::min(step, length);
    return Sqr(within) / 8 * (Sqr(turn) * reach + 2 * turn * change);
}

Mat4d ProductAt(std::span<const AnimatedTransform> transforms, double time) {
    Mat4d product = transforms[0].At(time);
    for (const AnimatedTransform& transform : transforms.subspan(1)) product *= transform.At(time);
    return product;
}

std::vector<Bounds3f> BoundMotion(std::span<const AnimatedTransform> transforms, Bounds3f box) {
    // A moving object within a moving one is bounded by all its positions.
    if (transforms.size() > 1) {
        const std::vector<Bounds3f> inner = BoundMotion(transforms.subspan(1), box);
        box = {};
        for (const Bounds3f& b : inner) box.Extend(b);
        transforms = transforms.first(1);
    }
    const AnimatedTransform& transform = transforms[0];
    if (transform.IsLinear())
        return {TransformBox(transform.At(0), box), TransformBox(transform.At(1), box)};
    // Each box holds all from one time before to one time after.
    std::array<Bounds3f, kSteps + 1> at;
    const Vec3f pad = Vec3f::Constant(float(transform.Sagitta(box, 1. / kSteps)));
    for (int i = 0; i <= kSteps; ++i) {
        at[i] = TransformBox(transform.At(double(i) / kSteps), box);
        at[i].lower -= pad;
        at[i].upper += pad;
    }
    std::vector<Bounds3f> bounds(at.begin(), at.end());
    for (int i = 0; i <= kSteps; ++i) {
        if (i > 0) bounds[i].Extend(at[i - 1]);
        if (i < kSteps) bounds[i].Extend(at[i + 1]);
    }
    return bounds;
}

}  // namespace lull
