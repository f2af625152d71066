#include "renderer/input/gltf/nodes.h"

#include <fmt/format.h>

#include <numbers>

#include "renderer/base/math.h"
#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/materials.h"

namespace lull {
namespace {

std::string PathOf(int node) { return fmt::format("/nodes/{}", node); }

Mat4d LocalMatrix(const GltfDocument& document, int index) {
    const tinygltf::Node& node = document.model.nodes[size_t(index)];
    Mat4d m;
    if (node.matrix.size() == 16) {
        m = Eigen::Map<const Mat4d>(node.matrix.data());  // columns first, both
        const Eigen::RowVector4d affine(0, 0, 0, 1);
        if (!((m.row(3) - affine).cwiseAbs().maxCoeff() <= kRounding))
            throw Error(document.At(PathOf(index) + "/matrix"), "is not affine");
        m.row(3) = affine;
    } else {
        const auto three = [](const std::vector<double>& v, double otherwise) {
            return v.size() == 3 ? Eigen::Vector3d(v[0], v[1], v[2])
                                 : Eigen::Vector3d(otherwise, otherwise, otherwise);
        };
        const Eigen::Vector4d rotation = node.rotation.size() == 4
                                             ? Eigen::Vector4d(node.rotation[0], node.rotation[1],
                                                               node.rotation[2], node.rotation[3])
                                             : Eigen::Vector4d(0, 0, 0, 1);
        m = MatrixOf(three(node.translation, 0), rotation, three(node.scale, 1));
    }
    return m;
}

bool SaysVisible(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    if (found == node.extensions.end() || !found->second.Has("visible")) return true;
    return found->second.Get("visible").Get<bool>();
}

std::vector<int> Roots(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const int scene = std::max(model.defaultScene, 0);
        return model.scenes[size_t(scene)].nodes;
    }
    std::vector<bool> isChild(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) isChild[size_t(child)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < isChild.size(); ++i)
        if (!isChild[i]) roots.push_back(int(i));
    return roots;
}

}  // namespace

Mat4d MatrixOf(const Eigen::Vector3d& translation, const Eigen::Vector4d& rotation,
               const Eigen::Vector3d& scale) {
    Mat4d m = Mat4d::Identity();
    const double length = rotation.norm();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (length > 0) {
        const Eigen::Vector4d q = rotation / length;
        turn = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    }
    m.topLeftCorner<3, 3>() = turn * scale.asDiagonal();
    m.topRightCorner<3, 1>() = translation;
    return m;
}

std::vector<GltfNode> ListNodes(const GltfDocument& document) {
    std::vector<GltfNode> nodes;
    std::vector<bool> isListed(document.model.nodes.size());
    const auto add = [&](int index, const GltfNode& parent) {
        if (isListed[size_t(index)])
            throw Error(document.At(PathOf(index)), "has two parents, or is its own ancestor");
        isListed[size_t(index)] = true;
        const bool isVisible = parent.isVisible && SaysVisible(document.model.nodes[size_t(index)]);
        nodes.push_back(
            {index, parent.worldFromNode * LocalMatrix(document, index), {}, isVisible});
        if (!(nodes.back().worldFromNode.cwiseAbs().maxCoeff() < 1e30))
            throw Error(document.At(PathOf(index)), "its transform is too large");
    };
    for (const int root : Roots(document.model)) add(root, GltfNode());
    // The list grows as it is walked; its present nodes do not move, as copies are taken.
    for (size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode node = nodes[i];
        for (const int child : document.model.nodes[size_t(node.index)].children) add(child, node);
    }
    return nodes;
}

std::vector<Mat4d> ReadCopies(const GltfDocument& document, int index) {
    const tinygltf::Node& node = document.model.nodes[size_t(index)];
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end()) return {Mat4d::Identity()};
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    const FileLoc loc = document.At(PathOf(index) + "/extensions/EXT_mesh_gpu_instancing");
    size_t count = 0;
    const auto read = [&](const std::string& name, int least, int most) {
        GltfArray array;
        if (!attributes.Has(name)) return array;
        array = ReadFloats(document, attributes.Get(name).GetNumberAsInt(), least, most);
        if (count > 0 && array.Count() != count)
            throw Error(loc, "its attributes have different counts");
        count = array.Count();
        return array;
    };
    const GltfArray translations = read("TRANSLATION", 3, 3), rotations = read("ROTATION", 4, 4),
                    scales = read("SCALE", 3, 3);
    // Those of other names count the copies as well.
    for (const std::string& name : attributes.Keys())
        if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE") read(name, 1, 16);
    std::vector<Mat4d> copies;
    for (size_t i = 0; i < count; ++i) {
        const auto three = [&](const GltfArray& a, double otherwise) -> Eigen::Vector3d {
            if (a.values.empty()) return Eigen::Vector3d::Constant(otherwise);
            return Eigen::Map<const Vec3f>(&a.values[3 * i]).cast<double>();
        };
        Eigen::Vector4d rotation(0, 0, 0, 1);
        if (!rotations.values.empty())
            for (size_t c = 0; c < 4; ++c) rotation[long(c)] = rotations.values[4 * i + c];
        copies.push_back(MatrixOf(three(translations, 0), rotation, three(scales, 1)));
    }
    return copies;
}

namespace {

constexpr const char* kExtension = "KHR_materials_variants";

}  // namespace

std::vector<std::string> VariantNames(const GltfDocument& document) {
    std::vector<std::string> names;
    const auto extension = document.model.extensions.find(kExtension);
    if (extension == document.model.extensions.end()) return names;
    const tinygltf::Value& variants = extension->second.Get("variants");
    for (size_t i = 0; i < variants.ArrayLen(); ++i)
        names.push_back(variants.Get(i).Get("name").Get<std::string>());
    return names;
}

void UseVariant(const std::string& wanted, GltfDocument* document) {
    const auto variant = int(ChooseByName(*document, "variant", VariantNames(*document), wanted));
    const auto isMeant = [&](const tinygltf::Value& mapping) {
        const tinygltf::Value& variants = mapping.Get("variants");
        for (size_t i = 0; i < variants.ArrayLen(); ++i)
            if (variants.Get(i).GetNumberAsInt() == variant) return true;
        return false;
    };
    for (tinygltf::Mesh& mesh : document->model.meshes)
        for (tinygltf::Primitive& primitive : mesh.primitives) {
            const auto extension = primitive.extensions.find(kExtension);
            if (extension == primitive.extensions.end()) continue;
            const tinygltf::Value& mappings = extension->second.Get("mappings");
            for (size_t i = 0; i < mappings.ArrayLen(); ++i)
                if (isMeant(mappings.Get(i)))
                    primitive.material = mappings.Get(i).Get("material").GetNumberAsInt();
        }
}

GltfVisibility VisibilityOf(const GltfDocument& document, const tinygltf::Value& extras,
                            const std::string& path) {
    return {OwnFlag(document, extras, "hiddenFromCamera", path),
            OwnFlag(document, extras, "castsNoShadow", path)};
}

GltfVisibility VisibilityOf(const GltfDocument& document, int node) {
    return VisibilityOf(document, document.model.nodes[size_t(node)].extras,
                        fmt::format("/nodes/{}", node));
}

void Hide(const GltfVisibility& visibility, Parameters* parameters) {
    const ParameterWriter write(parameters, {});
    if (visibility.hiddenFromCamera) write.Bool("hiddenfromcamera", true);
    if (visibility.castsNoShadow) write.Bool("castsnoshadow", true);
}

// Lights.

namespace {

void WriteCone(const tinygltf::SpotLight& spot, const FileLoc& loc, const ParameterWriter& write) {
    constexpr double kWidest = std::numbers::pi / 2;
    const auto outerAngle = InRange(spot.outerConeAngle, 0, kWidest);
    const auto innerAngle = InRange(spot.innerConeAngle, 0, kWidest);
    if (!outerAngle || !innerAngle || !(*outerAngle > 0) || IsAbove(*innerAngle, *outerAngle))
        throw Error(loc,
                    "the cone's angles are {} and {}; they have to be 0 <= inner <= outer <= pi/2, "
                    "and outer above 0",
                    spot.innerConeAngle, spot.outerConeAngle);
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

double OwnNumber(const tinygltf::Light& light, const std::string& name) {
    const tinygltf::Value* value = OwnValue(light.extras, name);
    return value ? value->GetNumberAsDouble() : 0;
}

double RadiusOf(const tinygltf::Light& light, const FileLoc& loc) {
    const auto radius = NotNegative(OwnNumber(light, "radius"));
    if (!radius) throw Error(loc, "its radius is negative");
    return *radius;
}

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

double AngleOf(const tinygltf::Light& light, const FileLoc& loc) {
    const double angle = OwnNumber(light, "angle");
    const auto across = InRange(angle, 0, std::numbers::pi);
    if (!across) throw Error(loc, "its angle is {:g}; it has to be from 0 to pi", angle);
    return *across * 180 / std::numbers::pi;
}

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
