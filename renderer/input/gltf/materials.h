// Converts glTF's materials and textures to those of a Description.
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

// Read a use, from the core specification's slots or an extension's: `owner` may have a `name`.
GltfTextureUse ReadTextureUse(const tinygltf::TextureInfo&, const std::string& path);
GltfTextureUse ReadTextureUse(const tinygltf::NormalTextureInfo&, const std::string& path);
GltfTextureUse ReadTextureUse(const tinygltf::Value& owner, const std::string& name,
                              const std::string& path);

// The content of a texture: colours of an image, sRGB-encoded or not, or one channel as it is.
enum class GltfTexels { EncodedColor, LinearColor, Red, Green, Alpha };

// Adds textures and embedded images to a description, each once.
class GltfTextures {
  public:
    GltfTextures(const GltfDocument& document, Description* description)
        : document(document), description(description) {}

    // Returns the texture; nothing if the use names none, or, with a warning, one without image.
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

// Properties of a shape that its material defines.
struct GltfMaterial {
    int index = -1;                   // into Description::materials
    std::optional<Entity> emission;   // an area light
    Parameters coverage;              // of the shape: its alpha mode, and rays that pass it
    int medium = -1;                  // inside the shape, into Description::media; -1: vacuum
    bool isVolume = false;            // light goes into the shape
    std::array<bool, 2> uvSets = {};  // TEXCOORD_0 and 1: those that its textures use
    int tangentUvSet = -1;  // the texture coordinates that its tangents follow; -1: it needs none
};

// Adds materials to a description, each once.
class GltfMaterials {
  public:
    GltfMaterials(const GltfDocument& document, bool solidGlass, Description* description)
        : document(document),
          solidGlass(solidGlass),
          description(description),
          textures(document, description) {}

    // Returns the material of that index of the file, -1 for the default one, for primitives with
    // or without vertex colours. Throws Error.
    const GltfMaterial& Get(int material, bool hasColors, Warnings& warnings);

  private:
    // A material of the file, its JSON pointer, and where its parameters go.
    struct MaterialUse {
        const tinygltf::Material& material;
        const std::string& path;
        ParameterWriter write;
    };

    GltfMaterial Make(int material, bool hasColors, Warnings& warnings);
    // Properties beyond the material's own parameters go to `result`.
    void AddSurface(const MaterialUse&, const GltfTextureUse& color, bool hasColors,
                    GltfMaterial* result, Warnings&);
    void AddSpecular(const MaterialUse&, Warnings&);
    void AddTransmission(const MaterialUse&, Warnings&);
    void AddClearcoat(const MaterialUse&, Warnings&);
    void AddVolume(const MaterialUse&, GltfMaterial* result, Warnings&);
    void AddSheen(const MaterialUse&, Warnings&);
    void AddDiffuseTransmission(const MaterialUse&, Warnings&);
    void AddAnisotropy(const MaterialUse&, GltfMaterial* result, Warnings&);
    void AddNormalMap(const MaterialUse&, GltfMaterial* result, Warnings&);
    std::optional<Entity> EmissionOfSurface(const MaterialUse&, Warnings&);
    void AddExtensionTexture(const MaterialUse&, const std::string& extension,
                             const std::string& name, const std::string& as, GltfTexels, Warnings&);
    void AddTexture(const ParameterWriter& write, const std::string& name,
                    const GltfTextureUse& use, GltfTexels texels, Warnings& warnings);

    const GltfDocument& document;
    bool solidGlass;
    Description* description;
    GltfTextures textures;
    std::map<std::pair<int, bool>, GltfMaterial> made;
};

}  // namespace lull
