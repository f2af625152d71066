#include "tests/side_by_side/world.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "renderer/image/image_io.h"
#include "renderer/input/scene_edits.h"

namespace lull {
namespace {

using nlohmann::json;

constexpr double kLumensPerWatt = 683;

Rgb StrengthOf(const LightEntity& light, const char* name) {
    return light.parameters.GetSpectrum(name, Rgb::Ones()) *
           light.parameters.GetSpectrum("scale", Rgb::Ones());
}

// Adds a node that looks from `from` along `direction`, which is glTF's -z.
void AddNode(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, json node,
             GlbFile* file) {
    const auto turn =
        Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitZ(), direction.normalized());
    node["translation"] = {from.x(), from.y(), from.z()};
    node["rotation"] = {turn.x(), turn.y(), turn.z(), turn.w()};
    file->root["scenes"][0]["nodes"].push_back(file->Add("nodes", std::move(node)));
}

// One infinite light: an image, or a constant, by directions of its own space.
struct Sky {
    Image image;
    Rgb L;
    Eigen::Matrix3d lightFromWorld;

    Rgb Texel(int x, int y) const {
        const int column = (x + image.width) % image.width;
        const int row = std::clamp(y, 0, image.height - 1);
        const size_t at =
            (size_t(row) * size_t(image.width) + size_t(column)) * size_t(image.channels);
        return std::visit(
            [&](const auto& t) {
                const size_t step = image.channels < 3 ? 0 : 1;
                return Rgb(float(t[at]), float(t[at + step]), float(t[at + 2 * step]));
            },
            image.texels);
    }

    Rgb Radiance(const Eigen::Vector3d& world) const {
        const Eigen::Vector3d w = (lightFromWorld * world).normalized();
        double phi = std::atan2(w.y(), w.x());
        if (phi < 0) phi += 2 * std::numbers::pi;
        const double theta = std::acos(std::clamp(w.z(), -1., 1.));
        const double x = phi / (2 * std::numbers::pi) * image.width - 0.5;
        const double y = theta / std::numbers::pi * image.height - 0.5;
        const int column = int(std::floor(x)), row = int(std::floor(y));
        const auto u = float(x - column), v = float(y - row);
        return L * ((1 - v) * ((1 - u) * Texel(column, row) + u * Texel(column + 1, row)) +
                    v * ((1 - u) * Texel(column, row + 1) + u * Texel(column + 1, row + 1)));
    }
};

std::vector<Sky> ReadSkies(const Description& description) {
    std::vector<Sky> skies;
    for (const LightEntity& light : description.lights) {
        if (light.name != "infinite" && light.name != "exinfinite") continue;
        const std::string map = light.parameters.GetString("mapname", "");
        Image image{8, 4, 3, std::vector<float>(8 * 4 * 3, 1)};
        if (!map.empty()) image = ReadImage(ResolvePath(description, map));
        if (std::holds_alternative<std::vector<uint8_t>>(image.texels))
            throw Error(light.loc, "an environment of 8-bit texels is not exported");
        skies.push_back({std::move(image), StrengthOf(light, "L"),
                         light.worldFromLight.topLeftCorner<3, 3>().inverse()});
    }
    return skies;
}

// Returns where `lull render --environment` has the directions of a file's image, in glTF's world.
Eigen::Matrix3d GltfFromEnvironment() {
    Description upright;
    // The handedness of the camera of a glTF file.
    upright.cameraFromWorld = Eigen::Vector4d(1, 1, -1, 1).asDiagonal();
    SetEnvironment("any.exr", 0, &upright);
    return upright.lights.back().worldFromLight.topLeftCorner<3, 3>();
}

}  // namespace

Mat4d GltfFromWorld(const Description& description) {
    const Eigen::Matrix3d m = description.cameraFromWorld.topLeftCorner<3, 3>();
    int axis;
    m.row(1).cwiseAbs().maxCoeff(&axis);
    const Eigen::Vector3d up = (m(1, axis) < 0 ? -1. : 1.) * Eigen::Vector3d::Unit(axis);
    Eigen::Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitY()).toRotationMatrix();
    if (m.determinant() > 0) turn = Eigen::Vector3d(1, 1, -1).asDiagonal() * turn;
    Mat4d result = Mat4d::Identity();
    result.topLeftCorner<3, 3>() = turn;
    return result;
}

void AddCamera(const Description& description, const Mat4d& gltfFromWorld, GlbFile* file,
               Warnings& warnings) {
    const Entity& camera = description.camera;
    if (camera.name != "perspective")
        throw Error(camera.loc, "only perspective cameras are exported");
    if (camera.parameters.GetFloat("lensradius", 0) > 0)
        warnings.Add(camera.loc, "the camera's lens is left out");
    const Parameters& film = description.film.parameters;
    const double aspect =
        double(film.GetInt("xresolution", 1280)) / film.GetInt("yresolution", 720);
    // pbrt's field of view is that of the shorter side.
    const double half = camera.parameters.GetFloat("fov", 90) * std::numbers::pi / 360;
    const double vertical = 2 * std::atan(std::tan(half) / std::min(aspect, 1.));
    const int index = file->Add(
        "cameras",
        {{"type", "perspective"},
         {"perspective", {{"yfov", vertical}, {"aspectRatio", aspect}, {"znear", 1e-4}}}});
    Mat4d m = gltfFromWorld * description.cameraFromWorld.inverse();
    m.col(2) *= -1;
    Eigen::Matrix3d linear = m.topLeftCorner<3, 3>();
    linear.colwise().normalize();
    const Eigen::Quaterniond turn(linear);
    const int node = file->Add("nodes", {{"camera", index},
                                         {"translation", {m(0, 3), m(1, 3), m(2, 3)}},
                                         {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}});
    file->root["scenes"][0]["nodes"].push_back(node);
}

void AddLights(const Description& description, const Mat4d& gltfFromWorld, GlbFile* file,
               Warnings& warnings) {
    json& lights = file->root["extensions"]["KHR_lights_punctual"]["lights"];
    for (const LightEntity& light : description.lights) {
        const Mat4d m = gltfFromWorld * light.worldFromLight;
        const auto at = [&](const char* name, const Vec3f& otherwise) {
            const Vec3f p = light.parameters.GetPoint3(name, otherwise);
            return Eigen::Vector3d((m * p.cast<double>().homogeneous()).hnormalized());
        };
        const bool isDistant = light.name == "distant", isSpot = light.name == "spot";
        if (light.name == "infinite" || light.name == "exinfinite") continue;
        if (!isDistant && !isSpot && light.name != "point") {
            warnings.Add(light.loc, "a light is left out", ": \"" + light.name + "\"");
            continue;
        }
        const Rgb strength = StrengthOf(light, isDistant ? "L" : "I");
        const float most = strength.maxCoeff();
        if (!(most > 0)) continue;
        json made = {{"type", isDistant ? "directional" : light.name},
                     {"intensity", most * kLumensPerWatt},
                     {"color", {strength.x() / most, strength.y() / most, strength.z() / most}}};
        const Eigen::Vector3d from = at("from", Vec3f::Zero()), to = at("to", Vec3f::UnitZ());
        if (isSpot) {
            const float cone = light.parameters.GetFloat("coneangle", 30) * kPi / 180;
            const float delta = light.parameters.GetFloat("conedeltaangle", 5) * kPi / 180;
            made["spot"] = {{"outerConeAngle", cone},
                            {"innerConeAngle", std::clamp(cone - delta, 0.f, 0.999f * cone)}};
        }
        lights.push_back(std::move(made));
        file->Use("KHR_lights_punctual");
        const json use = {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}};
        AddNode(from, to - from, {{"extensions", use}}, file);
    }
    if (lights.empty()) file->root.erase("extensions");
}

bool WriteEnvironment(const Description& description, const Mat4d& gltfFromWorld,
                      const std::string& path) {
    const std::vector<Sky> skies = ReadSkies(description);
    if (skies.empty()) return false;
    ExrImage exr;
    for (const Sky& sky : skies) {
        exr.width = std::max(exr.width, sky.image.width);
        exr.height = std::max(exr.height, sky.image.height);
    }
    exr.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
    const Eigen::Matrix3d worldFromEnvironment =
        gltfFromWorld.topLeftCorner<3, 3>().transpose() * GltfFromEnvironment();
    for (int row = 0; row < exr.height; ++row)
        for (int column = 0; column < exr.width; ++column) {
            const double phi = 2 * std::numbers::pi * (column + 0.5) / exr.width;
            const double theta = std::numbers::pi * (row + 0.5) / exr.height;
            const Eigen::Vector3d d(std::sin(theta) * std::cos(phi),
                                    std::sin(theta) * std::sin(phi), std::cos(theta));
            Rgb sum = Rgb::Zero();
            for (const Sky& sky : skies) sum += sky.Radiance(worldFromEnvironment * d);
            for (int c = 0; c < 3; ++c) exr.channels[size_t(c)].values.push_back(sum[c]);
        }
    WriteExr(path, exr);
    return true;
}

}  // namespace lull
