// Reads glTF files (.gltf, .glb) and checks their structure.
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/input/gltf/library.h"

namespace lull {

// A glTF file whose JSON has been checked: all indices between its top-level arrays are in
// range, all its numbers fit into a float. The contents of its buffers are not checked yet.
struct GltfDocument {
    std::string file;
    tinygltf::Model model;

    // Names a place in the file by its JSON pointer, such as "/meshes/0/primitives/1".
    FileLoc At(const std::string& path) const;
};

// Returns a property of our own in the `extras` of a camera, a light, a material or a node; null:
// there is none.
const tinygltf::Value* OwnValue(const tinygltf::Value& extras, const std::string& name);

// Returns whether a property of our own is true, in the `extras` of the object at the JSON pointer
// `path`. Throws Error.
bool OwnFlag(const GltfDocument&, const tinygltf::Value& extras, const std::string& name,
             const std::string& path);

// Reads a file and the buffers it names; images stay encoded, those in files of their own unread.
// Unsupported extensions lead to warnings, or to an error if the file requires them. Throws Error
// with the file and, if there is one, the JSON pointer of the mistake.
GltfDocument ReadGltf(const std::string& file, Warnings& warnings);

}  // namespace lull
