#include "renderer/input/gltf/lights.h"

#include <fmt/format.h>

#include "renderer/input/gltf/parameters.h"

namespace lull {

void AddLight(const GltfDocument& document, const GltfNode& node, Description* description,
              Warnings& warnings) {
    const auto& extensions = document.model.nodes[size_t(node.index)].extensions;
    const auto extension = extensions.find("KHR_lights_punctual");
    if (extension == extensions.end()) return;
    const auto index = size_t(extension->second.Get("light").GetNumberAsInt());
    const tinygltf::Light& light = document.model.lights[index];
    const FileLoc loc =
        document.At(fmt::format("/extensions/KHR_lights_punctual/lights/{}", index));
    if (!(light.intensity >= 0)) throw Error(loc, "its intensity is negative");
    if (light.range > 0)
        warnings.Add(loc, "a light's range is ignored: it falls off with the distance squared");

    // Lights shine along -z of their node; its scale is not theirs.
    Mat4d rigid = node.worldFromNode;
    for (int i = 0; i < 3; ++i)
        if (const double length = rigid.col(i).head<3>().norm(); length > 0) rigid.col(i) /= length;
    LightEntity entity;
    entity.loc = loc;
    entity.worldFromLight = rigid;
    const ParameterWriter write(&entity.parameters, loc);
    Rgb color = Rgb::Ones();
    if (light.color.size() == 3)
        color = Eigen::Array3d(light.color[0], light.color[1], light.color[2]).cast<float>();
    const Rgb strength = color.max(0.f) * float(light.intensity / kLumensPerWatt);
    if (light.type == "directional") {
        entity.name = "distant";
        write.Spectrum("L", strength);
        write.Point("from", Vec3f(0, 0, 1));
        write.Point("to", Vec3f::Zero());
    } else {
        write.Spectrum("I", strength);
        entity.name = light.type == "spot" ? "spot-squared" : "point";
        if (light.type == "spot") {
            const double outer = light.spot.outerConeAngle, inner = light.spot.innerConeAngle;
            if (!(inner >= 0 && inner < outer && outer <= std::numbers::pi / 2))
                throw Error(loc,
                            fmt::format("the cone's angles are {} and {}; they have to be 0 <= "
                                        "inner < outer <= pi/2",
                                        inner, outer));
            write.Point("from", Vec3f::Zero());
            write.Point("to", Vec3f(0, 0, -1));
            write.Float("coneangle", outer * 180 / std::numbers::pi);
            write.Float("conedeltaangle", (outer - inner) * 180 / std::numbers::pi);
        }
    }
    description->lights.push_back(std::move(entity));
}

}  // namespace lull
