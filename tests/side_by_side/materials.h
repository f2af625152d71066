// Turns pbrt-v3's materials into glTF's metallic-roughness material, as closely as possible.
#pragma once

#include <map>
#include <tuple>

#include "renderer/base/error.h"
#include "renderer/input/description.h"
#include "tests/side_by_side/glb_file.h"

namespace lull {

// Adds materials and the images they use to a file, each once. Materials that glTF cannot express
// become matte grey, with a warning.
class MaterialWriter {
  public:
    MaterialWriter(const Description& description, GlbFile* file, Warnings* warnings)
        : description(description), file(file), warnings(warnings) {}

    // Returns the material of a shape, with its emission and its cutout; -1 if it is "none", which
    // is no surface.
    int Of(const ShapeEntity& shape);

  private:
    nlohmann::json Make(const MaterialEntity& material, const TextureRef* alpha);
    // Sets a material's base colour from the parameter of that name: a texture or a constant.
    void SetColor(const MaterialEntity& material, const char* name, const Rgb& otherwise,
                  const TextureRef* alpha, nlohmann::json* made);
    // Returns the image file of a texture, "" where it is none.
    std::string ImageOf(const TextureRef* texture, bool isSpectrum);
    int AddImage(const std::string& color, const std::string& alpha, const TextureEntity* entity);

    const Description& description;
    GlbFile* file;
    Warnings* warnings;
    std::map<std::tuple<int, std::array<float, 3>, int>, int> made;
    std::map<std::pair<std::string, std::string>, int> images;
};

}  // namespace lull
