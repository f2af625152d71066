#include "renderer/input/pbrt/pbrt_state.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "renderer/base/math.h"

namespace lull {
namespace {

// Bounds how flat a matrix may be: its determinant over the product of its columns' lengths, which
// is 1 for any scale along the axes. Double rounding leaves 1e-16 in place of 0.
constexpr double kFlattest = 1e-13;

}  // namespace

Mat4d TranslateMatrix(double x, double y, double z) {
    Mat4d m = Mat4d::Identity();
    m.topRightCorner<3, 1>() = Eigen::Vector3d(x, y, z);
    return m;
}

Mat4d ScaleMatrix(double x, double y, double z, const FileLoc& loc) {
    if (x == 0 || y == 0 || z == 0)
        throw Error(loc,
                    "Scale by 0 makes the transform singular; scale by a small number instead");
    return Eigen::Vector4d(x, y, z, 1).asDiagonal();
}

Mat4d RotateMatrix(double degrees, const Eigen::Vector3d& axis, const FileLoc& loc) {
    if (degrees == 0) return Mat4d::Identity();  // about whatever axis
    // stableNormalized leaves a zero vector as it is.
    const Eigen::Vector3d unit = axis.stableNormalized();
    if (!(unit.norm() > 0.5))
        throw Error(loc, "Rotate about an axis of length 0; give a direction");
    Mat4d m = Mat4d::Identity();
    const double radians = degrees * (std::numbers::pi / 180);
    m.topLeftCorner<3, 3>() = Eigen::AngleAxisd(radians, unit).toRotationMatrix();
    return m;
}

Mat4d LookAtMatrix(const Eigen::Vector3d& eye, const Eigen::Vector3d& at, const Eigen::Vector3d& up,
                   const FileLoc& loc) {
    const Eigen::Vector3d forward = (at - eye).stableNormalized();
    const Eigen::Vector3d right = up.stableNormalized().cross(forward).stableNormalized();
    if (!(forward.norm() > 0.5))
        throw Error(loc, "LookAt: the eye and the point looked at are the same");
    if (!(right.norm() > 0.5))
        throw Error(loc, "LookAt: the up vector is 0 or points along the view; choose another");
    Mat4d worldFromCamera = Mat4d::Identity();
    worldFromCamera.topLeftCorner<3, 3>() << right, forward.cross(right), forward;
    worldFromCamera.topRightCorner<3, 1>() = eye;
    return worldFromCamera.inverse();
}

Mat4d ColumnsMatrix(std::span<const double, 16> numbers, const FileLoc& loc) {
    Mat4d m = Eigen::Map<const Mat4d>(numbers.data());
    const Eigen::RowVector4d affine(0, 0, 0, 1);
    if (!((m.row(3) - affine).cwiseAbs().maxCoeff() <= kRounding))
        throw Error(loc,
                    "the matrix is a projection, which is not supported: its 4th, 8th, 12th and "
                    "16th numbers must be 0 0 0 1");
    m.row(3) = affine;
    const Eigen::Matrix3d linear = m.topLeftCorner<3, 3>();
    const double lengths =
        linear.col(0).stableNorm() * linear.col(1).stableNorm() * linear.col(2).stableNorm();
    if (!(std::abs(linear.determinant()) > kFlattest * lengths))
        throw Error(loc, "the matrix is singular: it maps space onto a plane, a line or a point");
    return m;
}

void CheckInvertible(const Mat4d& m, const FileLoc& loc) {
    if (!m.cast<float>().allFinite() || !m.inverse().cast<float>().allFinite())
        throw Error(loc, "the transform is singular or beyond the range of numbers from here on");
}

namespace {

// Those of pbrt-v3's materials; no shape has one of these names.
// clang-format off
constexpr std::string_view kParameters[] = {
    "Kd", "Ks", "Kr", "Kt", "amount", "anisotropic", "beta_m", "beta_n", "bsdffile", "bumpmap",
    "clearcoat", "clearcoatgloss", "color", "difftrans", "eta", "eumelanin", "flatness", "index",
    "k", "metallic", "mfp", "opacity", "pheomelanin", "reflect", "remaproughness", "roughness",
    "scatterdistance", "sheen", "sheentint", "sigma", "sigma_a", "sigma_s", "spectrans",
    "speculartint", "thin", "transmit", "uroughness", "vroughness"};
// clang-format on

bool IsOfMaterial(const Parameter& parameter) {
    return std::ranges::find(kParameters, parameter.name) != std::end(kParameters);
}

}  // namespace

std::optional<MaterialEntity> MaterialOfShape(const MaterialEntity& material,
                                              const ShapeEntity& shape) {
    const std::vector<Parameter>& own = shape.parameters.All();
    if (std::ranges::none_of(own, IsOfMaterial)) return {};
    MaterialEntity result = material;
    result.parameters = {};
    for (const Parameter& parameter : material.parameters.All())
        if (std::ranges::find(own, parameter.name, &Parameter::name) == own.end())
            result.parameters.Add(parameter);
    for (const Parameter& parameter : own) {
        if (!IsOfMaterial(parameter)) continue;
        result.parameters.Add(parameter);
        parameter.lookedUp = true;  // not unused as one of the shape
    }
    return result;
}

}  // namespace lull
