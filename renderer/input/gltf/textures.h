// Converts glTF's textures to textures of a Description.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"

namespace lull {

// Names a texture as a material uses it.
struct GltfTextureUse {
    int index = -1;  // into the file's textures; -1: none
    int uvSet = 0;
    // KHR_texture_transform, in texture coordinates whose v grows upwards: two rows of three.
    std::optional<std::array<float, 6>> transform;
    std::string path;  // the JSON pointer of the use
};

// Read a use, from the core specification's texture slots or from an extension's: `owner` is the
// object that may have a member `name`.
GltfTextureUse ReadTextureUse(const tinygltf::TextureInfo&, const std::string& path);
GltfTextureUse ReadTextureUse(const tinygltf::NormalTextureInfo&, const std::string& path);
GltfTextureUse ReadTextureUse(const tinygltf::Value& owner, const std::string& name,
                              const std::string& path);

// The part of an image that a texture reads: its colours, sRGB-encoded or not, or one channel as it
// is.
enum class GltfTexels { EncodedColor, LinearColor, Red, Green, Alpha };

// Adds textures and embedded images to a description, each once.
class GltfTextures {
  public:
    GltfTextures(const GltfDocument& document, Description* description)
        : document(document), description(description) {}

    // Returns the texture; nothing if the use names none, or, with a counted warning, one without
    // an image.
    std::optional<TextureRef> Add(const GltfTextureUse& use, GltfTexels texels, Warnings& warnings);
    // Returns which of TEXCOORD_0 and 1 the textures use that were added since the last call.
    std::array<bool, 2> TakeUvSets() { return std::exchange(uvSets, {}); }

  private:
    int Embed(int image, const FileLoc& loc);
    TextureEntity MakeEntity(const GltfTextureUse& use, GltfTexels texels, const FileLoc& loc,
                             Warnings& warnings);

    const GltfDocument& document;
    Description* description;
    std::array<bool, 2> uvSets = {};
    std::map<int, int> embedded;  // image of the file to Description::images
    std::map<std::tuple<int, GltfTexels, std::optional<std::array<float, 6>>>, TextureRef> made;
};

}  // namespace lull
