#include "renderer/input/gltf/materials.h"

#include <fmt/format.h>

#include <numbers>

#include "renderer/base/math.h"
#include "renderer/input/gltf/nodes.h"

namespace lull {
namespace {

Rgb ColorOf(const std::vector<double>& values, const Rgb& otherwise) {
    if (values.size() < 3) return otherwise;
    return Eigen::Array3d(values[0], values[1], values[2]).cast<float>();
}

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

// Returns our own "spread", the angle across the cone about each normal that emission
// leaves into, degrees; 180: to all sides. Throws Error.
double SpreadOf(const tinygltf::Material& material, const GltfDocument& document,
                const std::string& path) {
    const tinygltf::Value* value = OwnValue(material.extras, "spread");
    if (!value) return 180;
    const auto spread =
        InRange(value->IsNumber() ? value->GetNumberAsDouble() : 0, 0, std::numbers::pi);
    if (!spread || !(*spread > 0))
        throw Error(document.At(path + "/extras/lull/spread"),
                    "has to be a number above 0 and at most pi");
    return *spread * 180 / std::numbers::pi;
}

double TransmissionFactor(const tinygltf::Material& material) {
    return Number(Extension(material, "KHR_materials_transmission"), "transmissionFactor", 0);
}

// Adds the medium of a volume, of whose light the share attenuationColor is left after
// attenuationDistance. Returns its index; -1 where it absorbs nothing.
int AddMedium(const tinygltf::Value& volume, const FileLoc& loc, Description* description) {
    constexpr float kMost = 1e30f;  // nothing gets through: where the colour is 0
    const double distance = Number(volume, "attenuationDistance", 0);
    const Rgb color = Color(volume, "attenuationColor", Rgb::Ones());
    if (distance == 0 || (color == 1).all()) return -1;
    const Rgb absorption =
        (color.max(0.f).cast<double>().log() / -distance).cast<float>().min(kMost).max(0.f);
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

void GltfMaterials::AddExtensionTexture(const MaterialUse& use, const std::string& extension,
                                        const std::string& name, const std::string& as,
                                        GltfTexels texels, Warnings& warnings) {
    const GltfTextureUse texture = ReadTextureUse(Extension(use.material, extension), name,
                                                  use.path + "/extensions/" + extension);
    AddTexture(use.write, as, texture, texels, warnings);
}

void GltfMaterials::AddSpecular(const MaterialUse& use, Warnings& warnings) {
    const char* kSpecular = "KHR_materials_specular";
    const tinygltf::Value& specular = Extension(use.material, kSpecular);
    use.write.Float("ior", Number(Extension(use.material, "KHR_materials_ior"), "ior", 1.5));
    use.write.Float("specularfactor", Number(specular, "specularFactor", 1));
    AddExtensionTexture(use, kSpecular, "specularTexture", "specular", GltfTexels::Alpha, warnings);
    if (specular.Has("specularColorFactor"))
        use.write.Spectrum("specularcolorfactor",
                           Color(specular, "specularColorFactor", Rgb::Ones()));
    AddExtensionTexture(use, kSpecular, "specularColorTexture", "specularcolor",
                        GltfTexels::EncodedColor, warnings);
}

void GltfMaterials::AddTransmission(const MaterialUse& use, Warnings& warnings) {
    const char* kTransmission = "KHR_materials_transmission";
    use.write.Float("transmissionfactor", TransmissionFactor(use.material));
    AddExtensionTexture(use, kTransmission, "transmissionTexture", "transmission", GltfTexels::Red,
                        warnings);
}

void GltfMaterials::AddClearcoat(const MaterialUse& use, Warnings& warnings) {
    const char* kClearcoat = "KHR_materials_clearcoat";
    const tinygltf::Value& coat = Extension(use.material, kClearcoat);
    use.write.Float("clearcoatfactor", Number(coat, "clearcoatFactor", 0));
    use.write.Float("clearcoatroughnessfactor", Number(coat, "clearcoatRoughnessFactor", 0));
    AddExtensionTexture(use, kClearcoat, "clearcoatTexture", "clearcoat", GltfTexels::Red,
                        warnings);
    AddExtensionTexture(use, kClearcoat, "clearcoatRoughnessTexture", "clearcoatroughness",
                        GltfTexels::Green, warnings);
    if (coat.Has("clearcoatNormalTexture"))
        warnings.Add(document.At(use.path), "a clear coat's own normal map is left out");
}

void GltfMaterials::AddVolume(const MaterialUse& use, GltfMaterial* result, Warnings& warnings) {
    const tinygltf::Value& volume = Extension(use.material, "KHR_materials_volume");
    const bool isSolid = solidGlass || Number(volume, "thicknessFactor", 0) > 0;
    use.write.Bool("solid", isSolid);
    if (TransmissionFactor(use.material) <= 0) return;
    result->isVolume = isSolid;
    if (isSolid)
        result->medium = AddMedium(
            volume, document.At(use.path + "/extensions/KHR_materials_volume"), description);
    else if (Number(Extension(use.material, "KHR_materials_ior"), "ior", 1.5) != 1)
        warnings.Add(document.At(use.path),
                     "transmission without a volume's thickness is that of a thin sheet, which "
                     "bends no light; --solid-glass makes all such materials solid");
}

void GltfMaterials::AddSheen(const MaterialUse& use, Warnings& warnings) {
    const char* kSheen = "KHR_materials_sheen";
    const tinygltf::Value& sheen = Extension(use.material, kSheen);
    if (!sheen.Has("sheenColorFactor")) return;
    use.write.Spectrum("sheencolorfactor", Color(sheen, "sheenColorFactor", Rgb::Zero()));
    use.write.Float("sheenroughnessfactor", Number(sheen, "sheenRoughnessFactor", 0));
    AddExtensionTexture(use, kSheen, "sheenColorTexture", "sheencolor", GltfTexels::EncodedColor,
                        warnings);
    AddExtensionTexture(use, kSheen, "sheenRoughnessTexture", "sheenroughness", GltfTexels::Alpha,
                        warnings);
}

void GltfMaterials::AddDiffuseTransmission(const MaterialUse& use, Warnings& warnings) {
    const char* kName = "KHR_materials_diffuse_transmission";
    const tinygltf::Value& values = Extension(use.material, kName);
    const double factor = Number(values, "diffuseTransmissionFactor", 0);
    if (factor <= 0) return;
    use.write.Float("diffusetransmissionfactor", factor);
    use.write.Spectrum("diffusetransmissioncolorfactor",
                       Color(values, "diffuseTransmissionColorFactor", Rgb::Ones()));
    AddExtensionTexture(use, kName, "diffuseTransmissionTexture", "diffusetransmission",
                        GltfTexels::Alpha, warnings);
    AddExtensionTexture(use, kName, "diffuseTransmissionColorTexture", "diffusetransmissioncolor",
                        GltfTexels::EncodedColor, warnings);
}

void GltfMaterials::AddAnisotropy(const MaterialUse& use, GltfMaterial* result,
                                  Warnings& warnings) {
    const char* kAnisotropy = "KHR_materials_anisotropy";
    const tinygltf::Value& anisotropy = Extension(use.material, kAnisotropy);
    const double strength = Number(anisotropy, "anisotropyStrength", 0);
    if (strength <= 0) return;
    use.write.Float("anisotropyfactor", strength);
    use.write.Float("anisotropyrotation", Number(anisotropy, "anisotropyRotation", 0));
    const GltfTextureUse texture =
        ReadTextureUse(anisotropy, "anisotropyTexture", use.path + "/extensions/" + kAnisotropy);
    AddTexture(use.write, "anisotropy", texture, GltfTexels::LinearColor, warnings);
    result->tangentUvSet = texture.uvSet;
}

void GltfMaterials::AddNormalMap(const MaterialUse& use, GltfMaterial* result, Warnings& warnings) {
    const tinygltf::NormalTextureInfo& info = use.material.normalTexture;
    const GltfTextureUse normal = ReadTextureUse(info, use.path + "/normalTexture");
    const auto texture = textures.Add(normal, GltfTexels::LinearColor, warnings);
    if (!texture) return;
    use.write.Texture("normalmap", *texture);
    use.write.Int("normaluv", normal.uvSet);
    use.write.Float("normalscale", info.scale);
    result->tangentUvSet = normal.uvSet;
}

std::optional<Entity> GltfMaterials::EmissionOfSurface(const MaterialUse& use, Warnings& warnings) {
    const tinygltf::Material& material = use.material;
    const Rgb emissive = ColorOf(material.emissiveFactor, Rgb::Zero()) *
                         float(Number(Extension(material, "KHR_materials_emissive_strength"),
                                      "emissiveStrength", 1));
    if (emissive.maxCoeff() <= 0) return {};
    const GltfTextureUse texture =
        ReadTextureUse(material.emissiveTexture, use.path + "/emissiveTexture");
    const FileLoc loc = document.At(use.path);
    Entity light =
        EmissionOf(emissive.max(0.f), material.doubleSided,
                   textures.Add(texture, GltfTexels::EncodedColor, warnings), texture.uvSet, loc);
    if (const double spread = SpreadOf(material, document, use.path); spread < 180)
        ParameterWriter(&light.parameters, loc).Float("spread", spread);
    const tinygltf::Value& coat = Extension(material, "KHR_materials_clearcoat");
    if (!coat.Has("clearcoatTexture") &&
        !OwnFlag(document, material.extras, "addedInterface", use.path))
        ParameterWriter(&light.parameters, loc)
            .Float("clearcoat", Number(coat, "clearcoatFactor", 0));
    return light;
}

void GltfMaterials::AddSurface(const MaterialUse& use, const GltfTextureUse& color, bool hasColors,
                               GltfMaterial* result, Warnings& warnings) {
    const tinygltf::PbrMetallicRoughness& pbr = use.material.pbrMetallicRoughness;
    use.write.Spectrum("basecolorfactor", ColorOf(pbr.baseColorFactor, Rgb::Ones()));
    AddTexture(use.write, "basecolor", color, GltfTexels::EncodedColor, warnings);
    use.write.Float("metallicfactor", pbr.metallicFactor);
    use.write.Float("roughnessfactor", pbr.roughnessFactor);
    AddTexture(use.write, "metallicroughness",
               ReadTextureUse(pbr.metallicRoughnessTexture,
                              use.path + "/pbrMetallicRoughness/metallicRoughnessTexture"),
               GltfTexels::LinearColor, warnings);
    use.write.Bool("vertexcolors", hasColors);
    for (const auto& [name, key] : {std::pair{"addedinterface", "addedInterface"},
                                    {"eveninterface", "evenInterface"},
                                    {"keepsradiance", "keepsRadiance"}})
        use.write.Bool(name, OwnFlag(document, use.material.extras, key, use.path));
    AddSpecular(use, warnings);
    AddTransmission(use, warnings);
    AddClearcoat(use, warnings);
    AddVolume(use, result, warnings);
    AddSheen(use, warnings);
    AddDiffuseTransmission(use, warnings);
    AddAnisotropy(use, result, warnings);
    AddNormalMap(use, result, warnings);
    result->emission = EmissionOfSurface(use, warnings);
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

    GltfMaterial result;
    MaterialEntity entity;
    entity.loc = loc;
    entity.materialName = material.name;
    entity.name = isUnlit ? "matte" : "metallicroughness";
    const MaterialUse use{material, path, ParameterWriter(&entity.parameters, loc)};
    if (isUnlit) {
        // It shows its colour whatever the light: it emits that, and reflects nothing.
        use.write.Spectrum("Kd", Rgb::Zero());
        result.emission =
            EmissionOf(ColorOf(pbr.baseColorFactor, Rgb::Ones()), true,
                       textures.Add(color, GltfTexels::EncodedColor, warnings), color.uvSet, loc);
        ParameterWriter(&result.emission->parameters, loc).Bool("emissioncolors", hasColors);
    } else {
        AddSurface(use, color, hasColors, &result, warnings);
    }

    const ParameterWriter cover(&result.coverage, loc);
    if (OwnFlag(document, material.extras, "openBehind", path)) cover.Bool("openbehind", true);
    // The back of what light passes is seen through its front (3.9.6, KHR_materials_transmission).
    const bool transmits = TransmissionFactor(material) > 0 ||
                           Number(Extension(material, "KHR_materials_diffuse_transmission"),
                                  "diffuseTransmissionFactor", 0) > 0;
    if (!material.doubleSided && !transmits) cover.Bool("singlesided", true);
    Hide(VisibilityOf(document, material.extras, path), &result.coverage);
    if (material.alphaMode != "OPAQUE") {
        AddTexture(cover, "coverage", color, GltfTexels::Alpha, warnings);
        cover.Float("coveragefactor", pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[3] : 1);
        cover.Bool("coveragecolors", hasColors);
        if (material.alphaMode == "MASK") cover.Float("alphacutoff", material.alphaCutoff);
    }
    result.uvSets = textures.TakeUvSets();
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
