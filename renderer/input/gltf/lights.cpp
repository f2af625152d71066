#include "renderer/input/gltf/lights.h"

#include <fmt/format.h>

#include <numbers>

#include "renderer/base/math.h"
#include "renderer/input/gltf/materials.h"
#include "renderer/input/gltf/nodes.h"

namespace lull {
namespace {

void WriteCone(const tinygltf::SpotLight& spot, const FileLoc& loc, const ParameterWriter& write) {
    constexpr double kWidest = std::numbers::pi / 2;
    const auto outerAngle = InRange(spot.outerConeAngle, 0, kWidest);
    const auto innerAngle = InRange(spot.innerConeAngle, 0, kWidest);
    if (!outerAngle || !innerAngle || !(*outerAngle > 0) || IsAbove(*innerAngle, *outerAngle))
        throw Error(loc, fmt::format("the cone's angles are {} and {}; they have to be 0 <= inner "
                                     "<= outer <= pi/2, and outer above 0",
                                     spot.innerConeAngle, spot.outerConeAngle));
    const double outer = *outerAngle, inner = std::min(*innerAngle, outer);
    write.Point("from", Vec3f::Zero());
    write.Point("to", Vec3f(0, 0, -1));
    write.Float("coneangle", outer * 180 / std::numbers::pi);
    write.Float("conedeltaangle", (outer - inner) * 180 / std::numbers::pi);
}

// Adds a point or spot light that `extras` give a radius: a sphere that emits evenly, or as the
// spot, and is no obstacle to other light, being a sheet of air.
void AddSphere(const tinygltf::Light& source, const Rgb& intensity, double radius,
               const LightEntity& light, Description* description) {
    const FileLoc& loc = light.loc;
    MaterialEntity air;
    air.name = "metallicroughness";
    air.loc = loc;
    const ParameterWriter write(&air.parameters, loc);
    write.Float("metallicfactor", 0);
    write.Float("roughnessfactor", 0);
    write.Float("transmissionfactor", 1);
    write.Float("specularfactor", 0);
    ShapeEntity sphere;
    sphere.name = "sphere";
    sphere.loc = loc;
    sphere.worldFromObject = light.worldFromLight;
    // Mirrored about the light's axis it is the same, and pbrt's spheres shine inwards if mirrored.
    if (sphere.worldFromObject.topLeftCorner<3, 3>().determinant() < 0)
        sphere.worldFromObject.col(0) *= -1;
    sphere.label = light.label;
    sphere.material = int(description->materials.size());
    ParameterWriter(&sphere.parameters, loc).Float("radius", radius);
    const bool isSpot = source.type == "spot";
    sphere.areaLight = Entity{isSpot ? "spot-squared" : "diffuse", {}, loc};
    const ParameterWriter emission(&sphere.areaLight->parameters, loc);
    emission.Spectrum("L", intensity / float(std::numbers::pi * radius * radius));
    if (isSpot) WriteCone(source.spot, loc, emission);
    description->materials.push_back(std::move(air));
    description->shapes.push_back(std::move(sphere));
}

// Returns a number of our own, 0 for none.
double OwnNumber(const tinygltf::Light& light, const std::string& name) {
    const tinygltf::Value* value = OwnValue(light.extras, name);
    return value ? value->GetNumberAsDouble() : 0;
}

double RadiusOf(const tinygltf::Light& light, const FileLoc& loc) {
    const auto radius = NotNegative(OwnNumber(light, "radius"));
    if (!radius) throw Error(loc, "its radius is negative");
    return *radius;
}

// Returns the name of an image of the light's directions; empty: it shines evenly.
std::string ProfileOf(const tinygltf::Light& light, const FileLoc& loc) {
    const tinygltf::Value* profile = OwnValue(light.extras, "profile");
    if (!profile) return "";
    if (!profile->IsString() || profile->Get<std::string>().empty())
        throw Error(loc, "its profile has to be the name of an image file");
    if (light.type != "point" || RadiusOf(light, loc) > 0)
        throw Error(loc, "it has a profile; only point lights without a radius can");
    return profile->Get<std::string>();
}

// Makes a goniometric light of the image: its first row is the -z axis of the node, where spots
// shine to, and its columns begin at the x axis, in the direction of y.
void AddProfile(const std::string& profile, LightEntity* light) {
    Mat4d nodeFromLight = Mat4d::Zero();
    nodeFromLight(0, 0) = nodeFromLight(1, 2) = nodeFromLight(3, 3) = 1;
    nodeFromLight(2, 1) = -1;
    light->name = "goniometric";
    light->worldFromLight = light->worldFromLight * nodeFromLight;
    ParameterWriter(&light->parameters, light->loc).String("mapname", profile);
}

// Returns the angle across a directional light, degrees.
double AngleOf(const tinygltf::Light& light, const FileLoc& loc) {
    const double angle = OwnNumber(light, "angle");
    const auto across = InRange(angle, 0, std::numbers::pi);
    if (!across)
        throw Error(loc, fmt::format("its angle is {:g}; it has to be from 0 to pi", angle));
    return *across * 180 / std::numbers::pi;
}

// Returns the node's transform without its scale, which is not that of lights.
Mat4d WithoutScale(const Mat4d& m) {
    Mat4d rigid = m;
    for (int i = 0; i < 3; ++i)
        if (const double length = rigid.col(i).head<3>().norm(); length > 0) rigid.col(i) /= length;
    return rigid;
}

}  // namespace

void AddLight(const GltfDocument& document, const GltfNode& node, Description* description,
              Warnings& warnings) {
    const tinygltf::Node& source = document.model.nodes[size_t(node.index)];
    const auto extension = source.extensions.find("KHR_lights_punctual");
    if (extension == source.extensions.end()) return;
    const auto index = size_t(extension->second.Get("light").GetNumberAsInt());
    const tinygltf::Light& light = document.model.lights[index];
    const FileLoc loc =
        document.At(fmt::format("/extensions/KHR_lights_punctual/lights/{}", index));
    const auto intensity = NotNegative(light.intensity);
    if (!intensity) throw Error(loc, "its intensity is negative");
    if (node.atClose) warnings.Add(loc, "lights are not blurred by their motion");
    if (light.range > 0)
        warnings.Add(loc, "a light's range is ignored: it falls off with the distance squared");

    const Mat4d rigid = WithoutScale(node.worldFromNode);  // lights shine along its -z
    LightEntity entity;
    entity.loc = loc;
    entity.worldFromLight = rigid;
    entity.label = source.name.empty() ? light.name : source.name;
    const ParameterWriter write(&entity.parameters, loc);
    Rgb color = Rgb::Ones();
    if (light.color.size() == 3)
        color = Eigen::Array3d(light.color[0], light.color[1], light.color[2]).cast<float>();
    const Rgb strength = color.max(0.f) * float(*intensity / kLumensPerWatt);
    const std::string profile = ProfileOf(light, loc);
    if (const double radius = RadiusOf(light, loc); radius > 0 && light.type != "directional") {
        AddSphere(light, strength, radius, entity, description);
        return Hide(VisibilityOf(document, node.index), &description->shapes.back().parameters);
    }
    if (light.type == "directional") {
        entity.name = "distant";
        write.Spectrum("L", strength);
        write.Point("from", Vec3f(0, 0, 1));
        write.Point("to", Vec3f::Zero());
        if (const double angle = AngleOf(light, loc); angle > 0) write.Float("angle", angle);
    } else {
        write.Spectrum("I", strength);
        entity.name = light.type == "spot" ? "spot-squared" : "point";
        if (light.type == "spot") WriteCone(light.spot, loc, write);
        if (!profile.empty()) AddProfile(profile, &entity);
    }
    description->lights.push_back(std::move(entity));
}

}  // namespace lull
