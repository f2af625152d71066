// Reads glTF files (.gltf, .glb) and checks their structure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/input/gltf/library.h"

namespace lull {

// A glTF file whose JSON has been checked: all indices between its top-level arrays are in
// range, all its numbers fit into a float. The contents of its buffers are not checked yet.
struct GltfDocument {
    std::string file;
    tinygltf::Model model;
    std::vector<std::string> bufferFiles;  // that buffers lie in

    // Names a place in the file by its JSON pointer, such as "/meshes/0/primitives/1".
    FileLoc At(const std::string& path) const;
};

// Returns a property of our own in `extras`; null: there is none.
const tinygltf::Value* OwnValue(const tinygltf::Value& extras, const std::string& name);

// Returns whether one is true, in the object at the JSON pointer `path`. Throws Error.
bool OwnFlag(const GltfDocument&, const tinygltf::Value& extras, const std::string& name,
             const std::string& path);

// Reads a file and the buffers it names; images stay encoded, those in files of their own unread.
// Unsupported extensions lead to warnings, or to an error if the file requires them. Throws Error
// with the file and, if there is one, the JSON pointer of the mistake.
GltfDocument ReadGltf(const std::string& file, Warnings& warnings);

// Returns the index of the first of `names` equal to `wanted`, or the index that `wanted` is, from
// 0. Throws Error with a list of them where there is none; `what` is their noun: "camera".
size_t ChooseByName(const GltfDocument&, const std::string& what,
                    const std::vector<std::string>& names, const std::string& wanted);

// URIs of buffers and images.

// A data URI of a byte of 0, for buffers that nothing reads.
inline constexpr const char* kOneByteUri = "data:application/octet-stream;base64,AA==";

// Undoes the percent-encoding of a URI.
std::string DecodeUri(std::string_view uri);

// Returns whether the URI is data itself (RFC 2397).
bool IsDataUri(std::string_view uri);
// Returns the base64 of such a URI, without percent-encoding and white space; nothing where it is
// encoded otherwise.
std::optional<std::string> Base64Of(std::string_view dataUri);

}  // namespace lull
