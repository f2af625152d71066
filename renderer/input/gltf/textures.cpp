// Converts glTF's textures to textures of a Description.
#include <fmt/format.h>

#include <cmath>

#include "renderer/files/file_io.h"
#include "renderer/input/gltf/materials.h"

namespace lull {
namespace {

std::array<double, 2> Pair(const tinygltf::Value& owner, const char* name, double otherwise) {
    const tinygltf::Value& pair = owner.Get(name);
    if (pair.ArrayLen() != 2) return {otherwise, otherwise};
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

// Reads KHR_texture_transform: translation * rotation * scale, where v grows downwards. Both v, the
// one that goes in and the one that comes out, are turned round.
void ReadTransform(const tinygltf::Value& e, GltfTextureUse* use) {
    if (!e.IsObject()) return;
    if (e.Has("texCoord")) use->uvSet = e.Get("texCoord").GetNumberAsInt();
    const auto [x, y] = Pair(e, "offset", 0);
    const auto [sx, sy] = Pair(e, "scale", 1);
    const double angle = e.Get("rotation").GetNumberAsDouble();
    const double c = std::cos(angle), s = std::sin(angle);
    use->transform = {float(c * sx), float(-s * sy), float(s * sy + x),
                      float(s * sx), float(c * sy),  float(1 - c * sy - y)};
}

template <typename Info>
GltfTextureUse UseOf(const Info& info, const std::string& path) {
    GltfTextureUse use{info.index, info.texCoord, {}, path};
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found != info.extensions.end()) ReadTransform(found->second, &use);
    return use;
}

// Returns the extension of such a file, by its first bytes or by its declared type.
std::string TypeOf(const tinygltf::Image& image) {
    const auto startsWith = [&](std::string_view bytes) {
        return std::string_view(reinterpret_cast<const char*>(image.image.data()),
                                image.image.size())
            .starts_with(bytes);
    };
    if (startsWith("\x89PNG")) return "png";
    if (startsWith("\xff\xd8")) return "jpg";
    if (startsWith("RIFF")) return "webp";
    return image.mimeType == "image/jpeg" ? "jpg" : "png";
}

// Returns the image of a texture, as WebP where there is one (EXT_texture_webp): what stands in for
// it may be missing. -1: none.
int ImageOf(const tinygltf::Texture& texture) {
    const auto webp = texture.extensions.find("EXT_texture_webp");
    if (webp == texture.extensions.end() || !webp->second.Has("source")) return texture.source;
    return webp->second.Get("source").GetNumberAsInt();
}

const char* WrapName(int wrap) {
    if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return "clamp";
    return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? "mirrored" : "repeat";
}

}  // namespace

GltfTextureUse ReadTextureUse(const tinygltf::TextureInfo& info, const std::string& path) {
    return UseOf(info, path);
}

GltfTextureUse ReadTextureUse(const tinygltf::NormalTextureInfo& info, const std::string& path) {
    return UseOf(info, path);
}

GltfTextureUse ReadTextureUse(const tinygltf::Value& owner, const std::string& name,
                              const std::string& path) {
    GltfTextureUse use;
    use.path = path + "/" + name;
    if (!owner.Has(name)) return use;
    const tinygltf::Value& info = owner.Get(name);
    use.index = info.Get("index").GetNumberAsInt();
    use.uvSet = info.Has("texCoord") ? info.Get("texCoord").GetNumberAsInt() : 0;
    if (info.Has("extensions"))
        ReadTransform(info.Get("extensions").Get("KHR_texture_transform"), &use);
    return use;
}

int GltfTextures::Embed(int index, const FileLoc& loc) {
    const auto [found, isNew] = embedded.try_emplace(index, int(description->images.size()));
    if (!isNew) return found->second;
    const tinygltf::Image& image = document.model.images[size_t(index)];
    if (image.image.empty()) throw Error(loc, "/images/{} is empty", index);
    const auto* bytes = reinterpret_cast<const std::byte*>(image.image.data());
    description->images.push_back({fmt::format("{}: /images/{}", document.file, index),
                                   TypeOf(image),
                                   {bytes, bytes + image.image.size()}});
    return found->second;
}

TextureEntity GltfTextures::MakeEntity(const GltfTextureUse& use, GltfTexels texels,
                                       const FileLoc& loc, Warnings& warnings) {
    const tinygltf::Texture& texture = document.model.textures[size_t(use.index)];
    TextureEntity entity;
    entity.name = "imagemap";
    entity.loc = loc;
    entity.textureName = fmt::format("/textures/{}", use.index);
    entity.isSpectrum = texels == GltfTexels::EncodedColor || texels == GltfTexels::LinearColor;
    const ParameterWriter write(&entity.parameters, loc);
    const int source = ImageOf(texture);
    const tinygltf::Image& image = document.model.images[size_t(source)];
    if (image.uri.empty() || IsDataUri(image.uri))
        write.Int("embeddedimage", Embed(source, loc));
    else
        write.String("filename", DecodeUri(image.uri));
    write.Bool("gamma", texels == GltfTexels::EncodedColor);
    if (!entity.isSpectrum)
        write.String("channel", texels == GltfTexels::Red     ? "red"
                                : texels == GltfTexels::Green ? "green"
                                                              : "alpha");
    if (texture.sampler >= 0) {
        const tinygltf::Sampler& sampler = document.model.samplers[size_t(texture.sampler)];
        write.String("wrap", WrapName(sampler.wrapS));
        write.String("wrapt", WrapName(sampler.wrapT));
        if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST)
            warnings.Add(loc, "magFilter NEAREST is left out; images are filtered bilinearly");
    }
    if (use.transform) {
        write.String("mapping", "uvaffine");
        write.Floats(ParameterType::Float, "uvtransform",
                     {use.transform->begin(), use.transform->end()});
    }
    return entity;
}

std::optional<TextureRef> GltfTextures::Add(const GltfTextureUse& use, GltfTexels texels,
                                            Warnings& warnings) {
    if (use.index < 0) return {};
    const FileLoc loc = document.At(use.path);
    if (use.uvSet > 1) throw Error(loc, "uses TEXCOORD_{}; only 0 and 1 are modelled", use.uvSet);
    const tinygltf::Texture& texture = document.model.textures[size_t(use.index)];
    if (ImageOf(texture) < 0) {
        warnings.Add(loc, "texture without an image that is modelled is left out");
        return {};
    }
    uvSets[size_t(use.uvSet)] = true;
    const auto [found, isNew] = made.try_emplace({use.index, texels, use.transform}, TextureRef());
    if (!isNew) return found->second;

    TextureEntity entity = MakeEntity(use, texels, loc, warnings);
    TextureRef& ref = found->second;
    ref.name = entity.textureName;
    (entity.isSpectrum ? ref.spectrumIndex : ref.floatIndex) = int(description->textures.size());
    description->textures.push_back(std::move(entity));
    return ref;
}

}  // namespace lull
