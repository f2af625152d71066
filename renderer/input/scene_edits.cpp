#include "renderer/input/scene_edits.h"

#include <Eigen/LU>
#include <algorithm>
#include <filesystem>
#include <numbers>

namespace lull {
namespace {

// Returns the axis that is up, or where it is not known that which is nearest to the camera's up.
Eigen::Vector3d UpOf(const Eigen::Matrix3d& cameraFromWorld, std::optional<int> upAxis) {
    if (upAxis) return Eigen::Vector3d::Unit(*upAxis);
    int axis;
    cameraFromWorld.row(1).cwiseAbs().maxCoeff(&axis);
    return (cameraFromWorld(1, axis) < 0 ? -1. : 1.) * Eigen::Vector3d::Unit(axis);
}

Mat4d FromAxes(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
    Mat4d m = Mat4d::Identity();
    m.topLeftCorner<3, 3>() << x, y, z;
    return m;
}

// Returns a studio's light space in the world: +z is up, +x at the camera, +y to its right.
Mat4d WorldFromStudio(const Mat4d& cameraFromWorld) {
    const Eigen::Matrix3d m = cameraFromWorld.topLeftCorner<3, 3>();
    const Eigen::Vector3d up = UpOf(m, {});
    Eigen::Vector3d right = m.row(0).transpose();
    right = (right - right.dot(up) * up).normalized();
    Eigen::Vector3d back = up.cross(right);
    if (back.dot(m.row(2).transpose()) > 0) back = -back;
    return FromAxes(back, right, up);
}

// Returns the transform of light space, whose +z is the top of an environment map, to the world.
Mat4d WorldFromEnvironment(const Mat4d& cameraFromWorld, std::optional<int> upAxis,
                           double degrees) {
    const Eigen::Matrix3d m = cameraFromWorld.topLeftCorner<3, 3>();
    const Eigen::Vector3d up = UpOf(m, upAxis);
    int axis;
    up.cwiseAbs().maxCoeff(&axis);
    // Camera space is left-handed, as pbrt's light space is. A world of the other hand sees the
    // image mirrored unless light space is mirrored as well; it is turned to where Blender has it.
    const bool isRightHanded = m.determinant() < 0;
    const Eigen::Vector3d x = (isRightHanded ? -1. : 1.) * Eigen::Vector3d::Unit(axis == 0 ? 1 : 0);
    const Eigen::Vector3d y = (isRightHanded ? -1. : 1.) * up.cross(x);
    const double angle = degrees * std::numbers::pi / 180;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, up).toRotationMatrix();
    return FromAxes(turn * x, turn * y, up);
}

bool IsEnvironment(const LightEntity& light) {
    return light.name == "infinite" || light.name == "exinfinite";
}

}  // namespace

void SetIntegrator(const std::string& name, Description* description) {
    std::string& own = description->integrator.name;
    own = name == "path" && IntegratorSeesMedia(own) ? "volpath" : name;
}

void SetExposure(double stops, Description* description) {
    ParameterWriter(&description->film.parameters, description->film.loc).Float("exposure", stops);
}

void SetStereo(const std::vector<float>& numbers, const std::string& eye, Description* d) {
    const ParameterWriter camera(&d->camera.parameters, {});
    camera.Float("eyedistance", numbers.at(0));
    camera.Float("convergence", numbers.at(1));
    camera.String("eye", eye);
}

void SetEnvironment(const std::string& file, double rotation, Description* description) {
    std::erase_if(description->lights, IsEnvironment);
    LightEntity light;
    light.name = "infinite";
    ParameterWriter(&light.parameters, {})
        .String("mapname", std::filesystem::absolute(file).string());
    light.worldFromLight =
        WorldFromEnvironment(description->cameraFromWorld, description->upAxis, rotation);
    description->lights.push_back(std::move(light));
}

void LightIfDark(Description* description, Warnings& warnings) {
    const auto emits = [](const ShapeEntity& shape) { return shape.areaLight.has_value(); };
    if (!description->lights.empty() ||
        std::any_of(description->shapes.begin(), description->shapes.end(), emits))
        return;
    warnings.Add({}, "the scene has no lights: a studio's light it, --environment gives others");
    LightEntity light;
    light.name = "infinite";
    ParameterWriter(&light.parameters, {}).Bool("studio", true);
    light.worldFromLight = WorldFromStudio(description->cameraFromWorld);
    description->lights.push_back(std::move(light));
}

}  // namespace lull
