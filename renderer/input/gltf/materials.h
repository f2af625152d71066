// Turns glTF's materials into those of a Description.
#pragma once

#include <map>
#include <optional>

#include "renderer/input/gltf/parameters.h"
#include "renderer/input/gltf/textures.h"

namespace lull {

// Holds what a material means for a shape.
struct GltfMaterial {
    int index = -1;                  // into Description::materials
    std::optional<Entity> emission;  // an area light
    Parameters coverage;             // of the shape: its alpha mode
    int medium = -1;                 // inside the shape, into Description::media; -1: vacuum
    int tangentUvSet = -1;  // the texture coordinates that its tangents follow; -1: it needs none
};

// Adds materials to a description, each once.
class GltfMaterials {
  public:
    // `solidGlass`: see GltfOptions.
    GltfMaterials(const GltfDocument& document, bool solidGlass, Description* description)
        : document(document),
          solidGlass(solidGlass),
          description(description),
          textures(document, description) {}

    // Returns the material of that index of the file, -1 for the default one, for primitives with
    // or without vertex colours. Throws Error.
    const GltfMaterial& Get(int material, bool hasColors, Warnings& warnings);

  private:
    GltfMaterial Make(int material, bool hasColors, Warnings& warnings);
    // Adds what the extensions of a material say, to its parameters and to `result`.
    void AddExtensions(const tinygltf::Material& material, const std::string& path,
                       const ParameterWriter& write, GltfMaterial* result, Warnings& warnings);
    void AddTexture(const ParameterWriter& write, const std::string& name,
                    const GltfTextureUse& use, GltfTexels texels, Warnings& warnings);

    const GltfDocument& document;
    bool solidGlass;
    Description* description;
    GltfTextures textures;
    std::map<std::pair<int, bool>, GltfMaterial> made;
};

}  // namespace lull
