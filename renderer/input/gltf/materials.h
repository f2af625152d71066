// Converts glTF's materials to materials of a Description.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/input/description.h"
#include "renderer/input/gltf/textures.h"

namespace lull {

// Makes parameters of a Description.

// Adds parameters to an entity, all of which have the same place in a file.
class ParameterWriter {
  public:
    ParameterWriter(Parameters* parameters, FileLoc loc)
        : parameters(parameters), loc(std::move(loc)) {}

    void Floats(ParameterType type, const std::string& name, std::vector<float> values) const {
        parameters->Add({type, name, loc, std::move(values)});
    }
    void Ints(const std::string& name, std::vector<int> values) const {
        parameters->Add({ParameterType::Integer, name, loc, std::move(values)});
    }
    void Float(const std::string& name, double value) const {
        Floats(ParameterType::Float, name, {float(value)});
    }
    void Spectrum(const std::string& name, const Rgb& c) const {
        Floats(ParameterType::Spectrum, name, {c.x(), c.y(), c.z()});
    }
    void Point(const std::string& name, const Vec3f& p) const {
        Floats(ParameterType::Point3, name, {p.x(), p.y(), p.z()});
    }
    void Int(const std::string& name, int value) const { Ints(name, {value}); }
    void Bool(const std::string& name, bool value) const {
        parameters->Add({ParameterType::Bool, name, loc, std::vector<int>{value}});
    }
    void String(const std::string& name, const std::string& value) const {
        parameters->Add({ParameterType::String, name, loc, std::vector<std::string>{value}});
    }
    void Texture(const std::string& name, const TextureRef& texture) const {
        parameters->Add({ParameterType::Texture, name, loc, std::vector<TextureRef>{texture}});
    }

  private:
    Parameters* parameters;
    FileLoc loc;
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
