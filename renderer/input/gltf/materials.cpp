#include "renderer/input/gltf/materials.h"

#include <fmt/format.h>

namespace lull {
namespace {

Rgb ColorOf(const std::vector<double>& values, const Rgb& otherwise) {
    if (values.size() < 3) return otherwise;
    return Eigen::Array3d(values[0], values[1], values[2]).cast<float>();
}

// Returns an extension of a material, an empty object where it has none.
const tinygltf::Value& Extension(const tinygltf::Material& material, const std::string& name) {
    static const tinygltf::Value none{tinygltf::Value::Object()};
    const auto found = material.extensions.find(name);
    return found != material.extensions.end() && found->second.IsObject() ? found->second : none;
}

bool HasExtension(const tinygltf::Material& material, const std::string& name) {
    return material.extensions.count(name) > 0;
}

double Number(const tinygltf::Value& owner, const std::string& name, double otherwise) {
    const tinygltf::Value& value = owner.Get(name);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

Rgb Color(const tinygltf::Value& owner, const std::string& name, const Rgb& otherwise) {
    if (!owner.Has(name)) return otherwise;
    const tinygltf::Value& c = owner.Get(name);
    return {float(c.Get(0).GetNumberAsDouble()), float(c.Get(1).GetNumberAsDouble()),
            float(c.Get(2).GetNumberAsDouble())};
}

// Adds the medium of a volume, of whose light the share attenuationColor is left after
// attenuationDistance. Returns its index; -1 where it absorbs nothing.
int AddMedium(const tinygltf::Value& volume, const FileLoc& loc, Description* description) {
    constexpr float kMost = 1e30f;  // nothing gets through: where the colour is 0
    const double distance = Number(volume, "attenuationDistance", 0);
    const Rgb color = Color(volume, "attenuationColor", Rgb::Ones());
    if (distance == 0 || (color == 1).all()) return -1;
    const Rgb absorption =
        (color.cast<double>().log() / -distance).cast<float>().min(kMost).max(0.f);
    MediumEntity medium;
    medium.name = "homogeneous";
    medium.mediumName = *loc.file;
    medium.loc = loc;
    const ParameterWriter write(&medium.parameters, loc);
    write.Spectrum("sigma_a", absorption);
    write.Spectrum("sigma_s", Rgb::Zero());
    description->media.push_back(std::move(medium));
    return int(description->media.size()) - 1;
}

// Makes the area light of a material that emits L.
Entity EmissionOf(const Rgb& L, bool twoSided, const std::optional<TextureRef>& texture, int uvSet,
                  const FileLoc& loc) {
    Entity light{"diffuse", {}, loc};
    const ParameterWriter write(&light.parameters, loc);
    write.Spectrum("L", L);
    write.Bool("twosided", twoSided);
    if (texture) {
        write.Texture("emission", *texture);
        write.Int("emissionuv", uvSet);
    }
    return light;
}

}  // namespace

void GltfMaterials::AddTexture(const ParameterWriter& write, const std::string& name,
                               const GltfTextureUse& use, GltfTexels texels, Warnings& warnings) {
    const std::optional<TextureRef> texture = textures.Add(use, texels, warnings);
    if (!texture) return;
    write.Texture(name, *texture);
    write.Int(name + "uv", use.uvSet);
}

void GltfMaterials::AddExtensions(const tinygltf::Material& material, const std::string& path,
                                  const ParameterWriter& write, GltfMaterial* result,
                                  Warnings& warnings) {
    const auto add = [&](const tinygltf::Value& owner, const std::string& extension,
                         const std::string& name, const std::string& as, GltfTexels texels) {
        AddTexture(write, as, ReadTextureUse(owner, name, path + "/extensions/" + extension),
                   texels, warnings);
    };
    write.Float("ior", Number(Extension(material, "KHR_materials_ior"), "ior", 1.5));

    const tinygltf::Value& specular = Extension(material, "KHR_materials_specular");
    write.Float("specularfactor", Number(specular, "specularFactor", 1));
    add(specular, "KHR_materials_specular", "specularTexture", "specular", GltfTexels::Alpha);
    if (specular.Has("specularColorFactor"))
        write.Spectrum("specularcolorfactor", Color(specular, "specularColorFactor", Rgb::Ones()));
    add(specular, "KHR_materials_specular", "specularColorTexture", "specularcolor",
        GltfTexels::EncodedColor);

    const tinygltf::Value& transmission = Extension(material, "KHR_materials_transmission");
    write.Float("transmissionfactor", Number(transmission, "transmissionFactor", 0));
    add(transmission, "KHR_materials_transmission", "transmissionTexture", "transmission",
        GltfTexels::Red);

    const tinygltf::Value& coat = Extension(material, "KHR_materials_clearcoat");
    write.Float("clearcoatfactor", Number(coat, "clearcoatFactor", 0));
    write.Float("clearcoatroughnessfactor", Number(coat, "clearcoatRoughnessFactor", 0));
    add(coat, "KHR_materials_clearcoat", "clearcoatTexture", "clearcoat", GltfTexels::Red);
    add(coat, "KHR_materials_clearcoat", "clearcoatRoughnessTexture", "clearcoatroughness",
        GltfTexels::Green);
    if (coat.Has("clearcoatNormalTexture"))
        warnings.Add(document.At(path), "a clear coat's own normal map is left out");

    const tinygltf::Value& volume = Extension(material, "KHR_materials_volume");
    const bool isSolid = solidGlass || Number(volume, "thicknessFactor", 0) > 0;
    write.Bool("solid", isSolid);
    if (!isSolid && Number(transmission, "transmissionFactor", 0) > 0)
        warnings.Add(document.At(path),
                     "transmission without a volume's thickness is that of a thin sheet, which "
                     "bends no light; --solid-glass makes all such materials solid");
    const FileLoc loc = document.At(path + "/extensions/KHR_materials_volume");
    if (isSolid && Number(transmission, "transmissionFactor", 0) > 0)
        result->medium = AddMedium(volume, loc, description);

    const tinygltf::Value& sheen = Extension(material, "KHR_materials_sheen");
    if (sheen.Has("sheenColorFactor")) {
        write.Spectrum("sheencolorfactor", Color(sheen, "sheenColorFactor", Rgb::Zero()));
        write.Float("sheenroughnessfactor", Number(sheen, "sheenRoughnessFactor", 0));
        add(sheen, "KHR_materials_sheen", "sheenColorTexture", "sheencolor",
            GltfTexels::EncodedColor);
        add(sheen, "KHR_materials_sheen", "sheenRoughnessTexture", "sheenroughness",
            GltfTexels::Alpha);
    }

    const tinygltf::Value& anisotropy = Extension(material, "KHR_materials_anisotropy");
    if (const double strength = Number(anisotropy, "anisotropyStrength", 0); strength > 0) {
        write.Float("anisotropyfactor", strength);
        write.Float("anisotropyrotation", Number(anisotropy, "anisotropyRotation", 0));
        const GltfTextureUse use = ReadTextureUse(anisotropy, "anisotropyTexture",
                                                  path + "/extensions/KHR_materials_anisotropy");
        AddTexture(write, "anisotropy", use, GltfTexels::LinearColor, warnings);
        result->tangentUvSet = use.uvSet;
    }
}

GltfMaterial GltfMaterials::Make(int index, bool hasColors, Warnings& warnings) {
    static const tinygltf::Material standard;
    const tinygltf::Material& material =
        index < 0 ? standard : document.model.materials[size_t(index)];
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const std::string path = index < 0 ? "/materials" : fmt::format("/materials/{}", index);
    const FileLoc loc = document.At(path);
    const bool isUnlit = HasExtension(material, "KHR_materials_unlit");
    const GltfTextureUse color =
        ReadTextureUse(pbr.baseColorTexture, path + "/pbrMetallicRoughness/baseColorTexture");
    const Rgb colorFactor = ColorOf(pbr.baseColorFactor, Rgb::Ones());

    GltfMaterial result;
    MaterialEntity entity;
    entity.loc = loc;
    entity.materialName = material.name;
    entity.name = isUnlit ? "matte" : "metallicroughness";
    const ParameterWriter write(&entity.parameters, loc);
    if (isUnlit) {
        // It shows its colour whatever the light: it emits that, and reflects nothing.
        write.Spectrum("Kd", Rgb::Zero());
        result.emission =
            EmissionOf(colorFactor, true, textures.Add(color, GltfTexels::EncodedColor, warnings),
                       color.uvSet, loc);
        if (hasColors) warnings.Add(loc, "vertex colours of unlit materials are left out");
    } else {
        write.Spectrum("basecolorfactor", colorFactor);
        AddTexture(write, "basecolor", color, GltfTexels::EncodedColor, warnings);
        write.Float("metallicfactor", pbr.metallicFactor);
        write.Float("roughnessfactor", pbr.roughnessFactor);
        AddTexture(write, "metallicroughness",
                   ReadTextureUse(pbr.metallicRoughnessTexture,
                                  path + "/pbrMetallicRoughness/metallicRoughnessTexture"),
                   GltfTexels::LinearColor, warnings);
        write.Bool("vertexcolors", hasColors);
        AddExtensions(material, path, write, &result, warnings);

        const GltfTextureUse normal =
            ReadTextureUse(material.normalTexture, path + "/normalTexture");
        if (const auto texture = textures.Add(normal, GltfTexels::LinearColor, warnings)) {
            write.Texture("normalmap", *texture);
            write.Int("normaluv", normal.uvSet);
            write.Float("normalscale", material.normalTexture.scale);
            result.tangentUvSet = normal.uvSet;
        }
        const Rgb emissive = ColorOf(material.emissiveFactor, Rgb::Zero()) *
                             float(Number(Extension(material, "KHR_materials_emissive_strength"),
                                          "emissiveStrength", 1));
        if (emissive.maxCoeff() > 0) {
            const GltfTextureUse use =
                ReadTextureUse(material.emissiveTexture, path + "/emissiveTexture");
            result.emission =
                EmissionOf(emissive.max(0.f), material.doubleSided,
                           textures.Add(use, GltfTexels::EncodedColor, warnings), use.uvSet, loc);
        }
    }

    if (material.alphaMode != "OPAQUE") {
        const ParameterWriter cover(&result.coverage, loc);
        AddTexture(cover, "coverage", color, GltfTexels::Alpha, warnings);
        cover.Float("coveragefactor", pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[3] : 1);
        cover.Bool("coveragecolors", hasColors);
        if (material.alphaMode == "MASK") cover.Float("alphacutoff", material.alphaCutoff);
    }
    result.index = int(description->materials.size());
    description->materials.push_back(std::move(entity));
    return result;
}

const GltfMaterial& GltfMaterials::Get(int material, bool hasColors, Warnings& warnings) {
    const std::pair key(material, hasColors);
    auto found = made.find(key);
    if (found == made.end()) found = made.emplace(key, Make(material, hasColors, warnings)).first;
    return found->second;
}

}  // namespace lull
