// Reads arrays out of a glTF file's buffers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/input/gltf/document.h"

namespace lull {

// Returns whether integers of an attribute are normalised whatever their accessors say, as others
// are no valid ones (3.7.2.1): some exporters leave the property out.
bool Normalizes(const tinygltf::Model&, const std::string& attribute);

struct GltfArray {
    int components = 0;
    std::vector<float> values;

    size_t Count() const { return components > 0 ? values.size() / size_t(components) : 0; }
};

// Reads an accessor of any type of component, with its sparse values in place; integers that are
// normalised, or all with `normalizes`, become 0 to 1 or -1 to 1. Throws Error where it has fewer
// than `least` or more than `most` components, or reaches beyond its buffer.
GltfArray ReadNumbers(const GltfDocument&, int accessor, int least, int most,
                      bool normalizes = false);
// Reads the same. Throws Error where a number is not finite, too.
GltfArray ReadFloats(const GltfDocument&, int accessor, int least, int most);

// Reads an accessor of indices. Throws Error unless they are unsigned integers below `bound`.
std::vector<uint32_t> ReadIndices(const GltfDocument&, int accessor, size_t bound);

// Undoes the compression of meshes.

// Decodes views compressed by EXT_meshopt_compression and primitives compressed by
// KHR_draco_mesh_compression into buffers of their own, so that nothing else needs to know about
// them. Throw Error.
void DecodeMeshopt(GltfDocument*);
void DecodeDraco(GltfDocument*);

}  // namespace lull
