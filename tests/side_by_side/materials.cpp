#include "tests/side_by_side/materials.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "renderer/base/color.h"
#include "renderer/bsdf/microfacet.h"
#include "renderer/files/file_contents.h"
#include "renderer/image/image_io.h"
#include "renderer/input/spectrum.h"

namespace lull {
namespace {

using nlohmann::json;

json Triple(const Rgb& c) { return {c.x(), c.y(), c.z()}; }

// Returns glTF's roughness, the square root of alpha, of "roughness" or its two axes' mean.
float RoughnessOf(const Parameters& p, float otherwise) {
    const float both = p.GetFloat("roughness", otherwise);
    const bool remap = p.GetBool("remaproughness", true);
    const auto alpha = [&](const char* name) {
        const float roughness = p.GetFloat(name, both);
        return remap && roughness > 0 ? RoughnessToAlpha(roughness) : roughness;
    };
    const float mean = std::sqrt(alpha("uroughness") * alpha("vroughness"));
    return std::sqrt(std::clamp(mean, 0.f, 1.f));
}

float IorOf(const Parameters& p) { return p.GetFloat("eta", p.GetFloat("index", 1.5f)); }

void SetSurface(float metallic, float roughness, json* made) {
    (*made)["pbrMetallicRoughness"]["metallicFactor"] = metallic;
    (*made)["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
}

// Sets the reflectance at normal incidence of dielectrics: by the strength of an interface of index
// 1.5, or by a higher index.
void SetReflectance(float f0, json* made) {
    constexpr float kUsual = 0.04f;
    if (f0 < kUsual)
        (*made)["extensions"]["KHR_materials_specular"]["specularFactor"] = f0 / kUsual;
    if (f0 <= kUsual) return;
    const float root = std::sqrt(std::min(f0, 0.9f));
    (*made)["extensions"]["KHR_materials_ior"]["ior"] = (1 + root) / (1 - root);
}

// Returns the reflectance of a smooth conductor at normal incidence.
Rgb ConductorReflectance(const Rgb& eta, const Rgb& k) {
    return ((eta - 1).square() + k.square()) / ((eta + 1).square() + k.square());
}

// Returns the extension's kind where glTF knows it, else "".
std::string MimeTypeOf(const std::string& path) {
    const std::string_view bytes = "\x89PNG";
    const FileContents file = ReadFile(path);
    if (file.View().starts_with(bytes)) return "image/png";
    return file.View().starts_with("\xff\xd8") ? "image/jpeg" : "";
}

float TexelOf(const Image& image, int x, int y, int channel) {
    const size_t at = (size_t(y) * size_t(image.width) + size_t(x)) * size_t(image.channels) +
                      size_t(std::min(channel, image.channels - 1));
    return std::visit(
        [&](const auto& texels) {
            if constexpr (std::is_same_v<std::decay_t<decltype(texels[0])>, uint8_t>)
                return float(texels[at]) / 255;
            else
                return SrgbFromLinear(std::clamp(float(texels[at]), 0.f, 1.f));
        },
        image.texels);
}

std::vector<std::byte> EncodeRgba(const std::vector<uint8_t>& rgba, int width, int height) {
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput into(encoded);
    const auto output = OIIO::ImageOutput::create("image.png", &into);
    OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (!output || !output->open("image.png", spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, rgba.data()) || !output->close())
        throw Error("an image could not be encoded as PNG");
    const auto* bytes = reinterpret_cast<const std::byte*>(encoded.data());
    return {bytes, bytes + encoded.size()};
}

// Joins the colours of one image and the alpha of another, of whatever sizes; "" stands for white
// and for all there.
std::vector<std::byte> Join(const std::string& color, const std::string& alpha) {
    Image white{1, 1, 1, std::vector<uint8_t>{255}};
    const Image c = color.empty() ? white : ReadImage(color);
    const Image a = alpha.empty() ? white : ReadImage(alpha);
    const int width = std::max(c.width, a.width), height = std::max(c.height, a.height);
    std::vector<uint8_t> rgba;
    rgba.reserve(size_t(width) * size_t(height) * 4);
    const auto add = [&](const Image& image, int x, int y, int channel) {
        const float v = TexelOf(image, x * image.width / width, y * image.height / height, channel);
        rgba.push_back(uint8_t(v * 255 + 0.5f));
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            for (int channel = 0; channel < 3; ++channel)
                add(c, x, y, c.channels < 3 ? 0 : channel);
            add(a, x, y, 0);
        }
    return EncodeRgba(rgba, width, height);
}

// Returns KHR_texture_transform for pbrt's scale and offset of texture coordinates; glTF's v runs
// the other way. Null where they change nothing.
json TransformOf(const Parameters& p) {
    const float su = p.GetFloat("uscale", 1), sv = p.GetFloat("vscale", 1);
    const float du = p.GetFloat("udelta", 0), dv = p.GetFloat("vdelta", 0);
    if (su == 1 && sv == 1 && du == 0 && dv == 0) return nullptr;
    return {{"scale", {su, sv}}, {"offset", {du, 1 - sv - dv}}};
}

}  // namespace

std::string MaterialWriter::ImageOf(const TextureRef* texture, bool isSpectrum) {
    if (!texture) return "";
    const int index = isSpectrum ? texture->spectrumIndex : texture->floatIndex;
    if (index < 0) return "";
    const TextureEntity& entity = description.textures[size_t(index)];
    if (entity.name != "imagemap") {
        warnings->Add(entity.loc, "a texture that is no image is left out",
                      ": \"" + entity.name + "\"");
        return "";
    }
    return ResolvePath(description, entity.parameters.GetString("filename", ""));
}

int MaterialWriter::AddImage(const std::string& color, const std::string& alpha,
                             const TextureEntity* entity) {
    const auto [found, isNew] = images.try_emplace({color, alpha}, -1);
    if (!isNew) return found->second;
    const bool clamp = entity && entity->parameters.GetString("wrap", "repeat") != "repeat";
    const std::string mimeType = color.empty() ? "" : MimeTypeOf(color);
    if (alpha.empty() && !mimeType.empty()) {
        const FileContents bytes = ReadFile(color);
        found->second = file->AddTexture(std::as_bytes(std::span(bytes.View())), mimeType,
                                         color.substr(color.find_last_of('/') + 1), clamp);
    } else {
        found->second = file->AddTexture(Join(color, alpha), "image/png", "joined", clamp);
    }
    return found->second;
}

void MaterialWriter::SetColor(const MaterialEntity& material, const char* name,
                              const Rgb& otherwise, const TextureRef* alpha, json* made) {
    const TextureRef* texture = material.parameters.GetTexture(name);
    const std::string image = ImageOf(texture, true), mask = ImageOf(alpha, false);
    Rgb color = material.parameters.GetSpectrum(name, otherwise);
    if (texture) color = image.empty() ? Rgb::Constant(0.5f) : Rgb::Ones();
    json& pbr = (*made)["pbrMetallicRoughness"];
    color = color.max(0.f).min(1.f);
    pbr["baseColorFactor"] = {color.x(), color.y(), color.z(), 1};
    if (!mask.empty()) (*made)["alphaMode"] = "BLEND";
    if (image.empty() && mask.empty()) return;
    const int index = image.empty() ? alpha->floatIndex : texture->spectrumIndex;
    const TextureEntity& entity = description.textures[size_t(index)];
    pbr["baseColorTexture"]["index"] = AddImage(image, mask, &entity);
    const json transform = TransformOf(entity.parameters);
    if (transform.is_null()) return;
    file->Use("KHR_texture_transform");
    pbr["baseColorTexture"]["extensions"]["KHR_texture_transform"] = transform;
}

json MaterialWriter::Make(const MaterialEntity& material, const TextureRef* alpha) {
    const Parameters& p = material.parameters;
    const auto mean = [&](const char* name, float otherwise) {
        return p.GetSpectrum(name, Rgb::Constant(otherwise)).mean();
    };
    const auto color = [&](const Rgb& c, json* made) {
        (*made)["pbrMetallicRoughness"]["baseColorFactor"] = {c.x(), c.y(), c.z(), 1};
    };
    json made;
    made["doubleSided"] = true;
    if (!material.materialName.empty()) made["name"] = material.materialName;
    const std::string& kind = material.name;
    if (kind == "plastic" || kind == "uber" || kind == "substrate") {
        const bool isSubstrate = kind == "substrate";
        SetColor(material, "Kd", Rgb::Constant(isSubstrate ? 0.5f : 0.25f), alpha, &made);
        SetSurface(0, RoughnessOf(p, 0.1f), &made);
        // A substrate's Ks is the reflectance itself, the others' the share of an interface's.
        SetReflectance(isSubstrate ? mean("Ks", 0.5f) : 0.04f * std::min(1.f, mean("Ks", 0.25f)),
                       &made);
    } else if (kind == "metal") {
        const Rgb f0 =
            ConductorReflectance(p.GetSpectrum("eta", CopperEta()), p.GetSpectrum("k", CopperK()));
        color(f0.max(0.f).min(1.f), &made);
        SetSurface(1, RoughnessOf(p, 0.01f), &made);
    } else if (kind == "mirror") {
        color(p.GetSpectrum("Kr", Rgb::Constant(0.9f)).max(0.f).min(1.f), &made);
        SetSurface(1, 0, &made);
    } else if (kind == "glass") {
        color(p.GetSpectrum("Kt", Rgb::Ones()).max(0.f).min(1.f), &made);
        SetSurface(0, RoughnessOf(p, 0), &made);
        made["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                              {"KHR_materials_ior", {{"ior", IorOf(p)}}}};
    } else if (kind == "disney") {
        SetColor(material, "color", Rgb::Constant(0.5f), alpha, &made);
        SetSurface(p.GetFloat("metallic", 0), p.GetFloat("roughness", 0.5f), &made);
        made["extensions"]["KHR_materials_ior"]["ior"] = IorOf(p);
        if (const float t = p.GetFloat("spectrans", 0); t > 0) {
            made["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = t;
            made["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
        }
    } else {
        if (kind != "matte" && kind != "translucent")
            warnings->Add(material.loc, "a material is made a matte grey", ": \"" + kind + "\"");
        SetColor(material, "Kd", Rgb::Constant(0.5f), alpha, &made);
        SetSurface(0, 1, &made);
        SetReflectance(0, &made);
        if (p.GetFloat("sigma", 0) != 0)
            warnings->Add(material.loc, "a rough matte surface is made a smooth one");
    }
    return made;
}

int MaterialWriter::Of(const ShapeEntity& shape) {
    const MaterialEntity& material = description.materials[size_t(shape.material)];
    if (material.name == "none" || material.name.empty()) return -1;
    Rgb L = Rgb::Zero();
    if (shape.areaLight)
        L = shape.areaLight->parameters.GetSpectrum("L", Rgb::Ones()) *
            shape.areaLight->parameters.GetSpectrum("scale", Rgb::Ones());
    const TextureRef* alpha = shape.parameters.GetTexture("alpha");
    const std::tuple key(shape.material, std::array{L.x(), L.y(), L.z()},
                         alpha ? alpha->floatIndex : -1);
    const auto [found, isNew] = made.try_emplace(key, -1);
    if (!isNew) return found->second;
    json entry = Make(material, alpha);
    if (const float strength = L.maxCoeff(); strength > 0) {
        entry["doubleSided"] = shape.areaLight->parameters.GetBool("twosided", false);
        entry["emissiveFactor"] = Triple(L / strength);
        entry["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    }
    if (entry.contains("extensions"))
        for (const auto& item : entry["extensions"].items()) file->Use(item.key());
    return found->second = file->Add("materials", std::move(entry));
}

}  // namespace lull
