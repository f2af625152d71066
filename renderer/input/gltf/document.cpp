#include "renderer/input/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "renderer/files/file_io.h"
#include "renderer/input/gltf/decompression.h"
#include "renderer/input/gltf/json_at.h"
#include "renderer/input/gltf/repair.h"
#include "renderer/input/gltf/uri.h"
#include "renderer/input/gltf/validation.h"

namespace lull {
namespace {

constexpr const char* kModelled[] = {"EXT_mesh_gpu_instancing",
                                     "EXT_meshopt_compression",
                                     "EXT_texture_webp",
                                     "KHR_draco_mesh_compression",
                                     "KHR_lights_punctual",
                                     "KHR_materials_anisotropy",
                                     "KHR_materials_clearcoat",
                                     "KHR_materials_diffuse_transmission",
                                     "KHR_materials_emissive_strength",
                                     "KHR_materials_ior",
                                     "KHR_materials_sheen",
                                     "KHR_materials_specular",
                                     "KHR_materials_transmission",
                                     "KHR_materials_unlit",
                                     "KHR_materials_variants",
                                     "KHR_materials_volume",
                                     "KHR_mesh_quantization",
                                     "KHR_node_visibility",
                                     "KHR_texture_transform"};

bool IsModelled(const std::string& extension) {
    return std::any_of(std::begin(kModelled), std::end(kModelled),
                       [&](const char* name) { return extension == name; });
}

constexpr size_t kGlbHeader = 12, kChunkHeader = 8;

uint32_t LittleEndian(const char* bytes) {
    const auto* b = reinterpret_cast<const unsigned char*>(bytes);
    return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
}

bool IsBinary(std::string_view bytes) { return bytes.starts_with("glTF"); }

// Returns the JSON of a file; of a .glb that is its first chunk.
std::string_view JsonOf(const std::string& file, std::string_view bytes) {
    if (!IsBinary(bytes)) return bytes;
    if (bytes.size() < kGlbHeader + kChunkHeader)
        throw Error(fmt::format("{}: is truncated: it has {} bytes", file, bytes.size()));
    const uint32_t version = LittleEndian(bytes.data() + 4), size = LittleEndian(bytes.data() + 8);
    if (version != 2)
        throw Error(fmt::format("{}: is of GLB version {}; 2 is modelled", file, version));
    if (size > bytes.size())
        throw Error(
            fmt::format("{}: is truncated: it has {} of its {} bytes", file, bytes.size(), size));
    const size_t length = LittleEndian(bytes.data() + 12);
    if (std::memcmp(bytes.data() + 16, "JSON", 4) != 0)
        throw Error(file + ": its first chunk is not JSON");
    if (length > bytes.size() - kGlbHeader - kChunkHeader)
        throw Error(fmt::format("{}: its JSON of {} bytes goes beyond its end", file, length));
    if (size < kGlbHeader + kChunkHeader + length)
        throw Error(fmt::format("{}: its length of {} bytes is less than that of its JSON, {}",
                                file, size, length));
    return bytes.substr(kGlbHeader + kChunkHeader, length);
}

// Returns whether the second chunk of a .glb, the first of its `rest`, is empty, or not padded to
// the alignment of 4 bytes.
bool HasOddChunk(std::string_view rest) {
    if (rest.size() < kChunkHeader) return false;
    const uint32_t length = LittleEndian(rest.data());
    return length == 0 || (length % 4 != 0 && length <= rest.size() - kChunkHeader);
}

// Returns the file with other JSON in it. That of a .glb is padded with spaces to its alignment, as
// is its second chunk by NULs, which is left out where it is empty.
std::string WithJson(std::string_view bytes, std::string json) {
    if (!IsBinary(bytes)) return json;
    const auto number = [](size_t n) {
        std::string b;
        for (int i = 0; i < 4; ++i) b += char(n >> (8 * i) & 255);
        return b;
    };
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const size_t start = kGlbHeader + kChunkHeader;
    std::string rest(bytes.substr(start + LittleEndian(bytes.data() + 12)));
    if (HasOddChunk(rest)) {
        const size_t length = LittleEndian(rest.data()), padded = (length + 3) / 4 * 4;
        if (length == 0) {
            rest.erase(0, kChunkHeader);
        } else {
            rest.resize(kChunkHeader + length);
            rest.resize(kChunkHeader + padded, '\0');
            rest.replace(0, 4, number(padded));
        }
    }
    return "glTF" + number(2) + number(start + json.size() + rest.size()) + number(json.size()) +
           "JSON" + json + rest;
}

std::string ProblemOf(const std::string& extension) {
    return "extension \"" + Printable(extension) + "\" is not supported and left out";
}

// Warns of extensions that objects have and `listed` lacks: some exporters do not list all that
// they write. Throws Error where one that counts is no object, which the library drops. The depth
// of the value has been bounded.
void CheckUnlisted(const std::string& file, const std::string& path, const nlohmann::json& value,
                   const std::vector<std::string>& listed, Warnings& warnings) {
    if (value.is_object() && value.contains("extensions") && value.at("extensions").is_object())
        for (const auto& [name, extension] : value.at("extensions").items()) {
            if (IsModelled(name) && !extension.is_object())
                throw Error(PlaceIn(file, path + "/extensions/" + name), "has to be an object");
            if (!IsModelled(name) && std::find(listed.begin(), listed.end(), name) == listed.end())
                warnings.Add(PlaceIn(file, path), ProblemOf(name));
        }
    for (const auto& [key, member] : value.items())
        if (member.is_structured() && key != "extras")
            CheckUnlisted(file, path + "/" + Printable(key), member, listed, warnings);
}

void CheckExtensions(const std::string& file, const nlohmann::json& root, Warnings& warnings) {
    const auto place = [&](const char* list, size_t i) {
        return PlaceIn(file, fmt::format("/{}/{}", list, i));
    };
    std::vector<std::string> required;
    if (root.contains("extensionsRequired"))
        required = root.at("extensionsRequired").get<std::vector<std::string>>();
    for (size_t i = 0; i < required.size(); ++i)
        if (!IsModelled(required[i]))
            throw Error(place("extensionsRequired", i), "extension \"" + Printable(required[i]) +
                                                            "\" is required, but not supported");
    std::vector<std::string> used;
    if (root.contains("extensionsUsed"))
        used = root.at("extensionsUsed").get<std::vector<std::string>>();
    for (size_t i = 0; i < used.size(); ++i)
        if (!IsModelled(used[i])) warnings.Add(place("extensionsUsed", i), ProblemOf(used[i]));
    CheckUnlisted(file, "", root, used, warnings);
}

// Gives buffers the length of their data where that is greater, as it may be (3.6.1.1): the library
// refuses it. Returns whether any has changed.
bool LengthenBuffers(const std::string& folder, nlohmann::json* root) {
    if (!root->contains("buffers")) return false;
    bool hasChanged = false;
    for (nlohmann::json& buffer : root->at("buffers")) {
        if (!buffer.contains("uri")) continue;
        const auto& uri = buffer.at("uri").get_ref<const std::string&>();
        uintmax_t size = 0;
        if (const auto data = IsDataUri(uri) ? Base64Of(uri) : std::nullopt) {
            size = data->find_last_not_of('=') + 1;
            size = size * 3 / 4;
        } else {
            std::error_code error;
            size =
                std::filesystem::file_size(std::filesystem::path(folder) / DecodeUri(uri), error);
            if (error) continue;
        }
        if (size <= buffer.at("byteLength").get<uintmax_t>()) continue;
        buffer.at("byteLength") = size;
        hasChanged = true;
    }
    return hasChanged;
}

// Reads the files that buffers lie in.
bool FileExists(const std::string& path, void*) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

bool ReadWhole(std::vector<unsigned char>* out, std::string* error, const std::string& path,
               void*) try {
    const FileContents contents = ReadFile(path);
    out->assign(contents.bytes.get(), contents.bytes.get() + contents.size);
    return true;
} catch (const Error& e) {
    *error += e.what();
    return false;
}

// Returns the functions above as the library takes them: from 2.9 on it refuses fewer than all.
template <typename Callbacks = tinygltf::FsCallbacks>
Callbacks FileCallbacks() {
    Callbacks callbacks{};
    callbacks.FileExists = FileExists;
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = ReadWhole;
    callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
    // The library compares the size with a limit of its own; ReadWhole has none.
    if constexpr (requires { callbacks.GetFileSizeInBytes; })
        callbacks.GetFileSizeInBytes = [](size_t* size, std::string*, const std::string&, void*) {
            *size = 0;
            return true;
        };
    return callbacks;
}

// Keeps images as they are encoded.
bool KeepImage(tinygltf::Image* image, int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

}  // namespace

const tinygltf::Value* OwnValue(const tinygltf::Value& extras, const std::string& name) {
    if (!extras.Has("lull") || !extras.Get("lull").Has(name)) return nullptr;
    return &extras.Get("lull").Get(name);
}

bool OwnFlag(const GltfDocument& document, const tinygltf::Value& extras, const std::string& name,
             const std::string& path) {
    const tinygltf::Value* value = OwnValue(extras, name);
    if (!value) return false;
    if (!value->IsBool())
        throw Error(document.At(path + "/extras/lull/" + name), "has to be true or false");
    return value->Get<bool>();
}

FileLoc GltfDocument::At(const std::string& path) const { return PlaceIn(file, path); }

GltfDocument ReadGltf(const std::string& file, Warnings& warnings) {
    const FileContents contents = ReadFile(file);
    std::string_view bytes = contents.View();
    std::string rewritten;
    const std::string folder = std::filesystem::path(file).parent_path().string();
    if (bytes.size() > std::numeric_limits<uint32_t>::max())
        throw Error(file + ": is larger than 4 GB, which glTF files cannot be");
    {
        // Padding by NULs instead of spaces is usual, but none to the library.
        const std::string_view raw = JsonOf(file, bytes);
        const std::string_view text =
            CleanText(raw, {std::make_shared<const std::string>(file), 0});
        nlohmann::json root = ParseGltfJson(file, text);
        bool hasChanged = RepairGltfJson(file, &root, warnings);
        hasChanged |=
            IsBinary(bytes) && HasOddChunk(bytes.substr(kGlbHeader + kChunkHeader + raw.size()));
        hasChanged |= CheckGltfJson(file, &root, warnings);
        CheckExtensions(file, root, warnings);
        hasChanged |= UnifyDataUris(&root);
        hasChanged |= LengthenBuffers(folder, &root);
        hasChanged |= HideCompressed(&root);
        if (hasChanged)
            rewritten = WithJson(bytes, root.dump());
        else if (text.size() != raw.size())
            rewritten = WithJson(bytes, std::string(text));
        if (!rewritten.empty()) bytes = rewritten;
    }

    GltfDocument document{file, {}};
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(FileCallbacks());
    reader.SetImageLoader(KeepImage, nullptr);
    std::string error, warning;
    bool isRead = false;
    try {
        const auto size = unsigned(bytes.size());
        isRead = IsBinary(bytes)
                     ? reader.LoadBinaryFromMemory(
                           &document.model, &error, &warning,
                           reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                     : reader.LoadASCIIFromString(&document.model, &error, &warning, bytes.data(),
                                                  size, folder);
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!isRead) throw Error(file + ": " + Printable(error.substr(0, error.find('\n')), 200));
    DecodeMeshopt(&document);
    DecodeDraco(&document);
    return document;
}

}  // namespace lull
