// Writes binary glTF 2.0 files. Knows nothing of the reader in renderer/input/gltf, so that each
// checks the other.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Builds a file piece by piece. `root` is its JSON; Add* append to the arrays of it and return the
// place there.
class GlbFile {
  public:
    nlohmann::json root = {{"asset", {{"version", "2.0"}, {"generator", "lull's pbrt_to_gltf"}}}};

    // Appends an entry to the array root[kind].
    int Add(const char* kind, nlohmann::json entry);

    // Names an extension in extensionsUsed.
    void Use(const std::string& extension);

    int AddVectors(std::span<const Vec3f> values, bool withBounds);
    int AddVectors(std::span<const Vec2f> values);
    int AddIndices(std::span<const std::array<uint32_t, 3>> triangles);

    // Adds a texture whose image is these bytes, encoded as "image/png" or "image/jpeg".
    int AddTexture(std::span<const std::byte> bytes, const std::string& mimeType,
                   const std::string& name, bool clamp);

    // Writes the file. Throws Error.
    void Write(const std::string& path);

  private:
    int AddView(const void* bytes, size_t size);
    int AddAccessor(int view, int componentType, const char* type, size_t count);

    std::vector<std::byte> data;
};

}  // namespace lull
