#include "renderer/input/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "renderer/files/file_io.h"
#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/json_at.h"
#include "renderer/input/gltf/validation.h"

namespace lull {
namespace {

constexpr std::string_view kScheme = "data:", kEncoding = "base64";
const std::string kData = "data:application/octet-stream;base64,";

bool EqualsInLowerCase(std::string_view text, std::string_view lower) {
    return std::ranges::equal(text, lower, {},
                              [](char c) { return std::tolower(static_cast<unsigned char>(c)); });
}

bool IsHexDigit(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

// clang-format off
constexpr const char* kModelled[] = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp",
    "KHR_draco_mesh_compression", "KHR_lights_punctual", "KHR_materials_anisotropy",
    "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_sheen",
    "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_variants", "KHR_materials_volume", "KHR_mesh_quantization",
    "KHR_node_visibility", "KHR_texture_transform"};
// clang-format on

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

std::string_view JsonOf(const std::string& file, std::string_view bytes) {
    if (!IsBinary(bytes)) return bytes;
    if (bytes.size() < kGlbHeader + kChunkHeader)
        throw Error("{}: is truncated: it has {} bytes", file, bytes.size());
    const uint32_t version = LittleEndian(bytes.data() + 4), size = LittleEndian(bytes.data() + 8);
    if (version != 2) throw Error("{}: is of GLB version {}; 2 is modelled", file, version);
    if (size > bytes.size())
        throw Error("{}: is truncated: it has {} of its {} bytes", file, bytes.size(), size);
    const size_t length = LittleEndian(bytes.data() + 12);
    if (std::memcmp(bytes.data() + 16, "JSON", 4) != 0)
        throw Error(file + ": its first chunk is not JSON");
    if (length > bytes.size() - kGlbHeader - kChunkHeader)
        throw Error("{}: its JSON of {} bytes goes beyond its end", file, length);
    if (size < kGlbHeader + kChunkHeader + length)
        throw Error("{}: its length of {} bytes is less than that of its JSON, {}", file, size,
                    length);
    return bytes.substr(kGlbHeader + kChunkHeader, length);
}

std::string_view DataOf(const std::string& file, std::string_view bytes, size_t jsonBytes) {
    if (!IsBinary(bytes)) return {};
    const std::string_view rest = bytes.substr(kGlbHeader + kChunkHeader + jsonBytes);
    if (rest.size() < kChunkHeader || rest.substr(4, 4) != std::string_view("BIN\0", 4)) return {};
    const size_t length = LittleEndian(rest.data());
    if (length > rest.size() - kChunkHeader)
        throw Error("{}: its data of {} bytes go beyond its end", file, length);
    return rest.substr(kChunkHeader, length);
}

std::string ProblemOf(const std::string& extension) {
    return "extension \"" + Printable(extension) + "\" is not supported and left out";
}

// Warns of extensions that objects have and `listed` lacks: some exporters do not list all that
// they write. Throws Error where one that counts is no object, which the library drops.
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

using Bytes = std::vector<unsigned char>;

// Reads the buffers, of which the first without a URI is `data`, and tells the library their
// numbers in place of names of files. They may be longer than they say (3.6.1.1).
std::vector<Bytes> TakeBuffers(const std::filesystem::path& folder, std::string_view data,
                               nlohmann::json* root, GltfDocument* document) {
    std::vector<Bytes> buffers;
    if (!root->contains("buffers")) return buffers;
    for (nlohmann::json& buffer : root->at("buffers")) {
        const FileLoc loc = document->At(fmt::format("/buffers/{}", buffers.size()));
        Bytes& bytes = buffers.emplace_back();
        const std::string uri = buffer.value("uri", "");
        if (!buffer.contains("uri")) {
            bytes.assign(data.begin(), data.end());
            data = {};  // a file with many of them would take its size as often
        } else if (IsDataUri(uri)) {
            std::string type;
            tinygltf::DecodeDataURI(&bytes, type, kData + Base64Of(uri).value_or(""), 0, false);
        } else {
            document->bufferFiles.push_back((folder / DecodeUri(uri)).string());
            const FileContents contents = ReadFile(document->bufferFiles.back(), loc);
            bytes.assign(contents.View().begin(), contents.View().end());
        }
        const auto length = buffer.at("byteLength").get<size_t>();
        if (bytes.size() < length) throw Error(loc, "has {} of its {} bytes", bytes.size(), length);
        buffer["uri"] = std::to_string(buffers.size() - 1);
        buffer["byteLength"] = bytes.size();
    }
    return buffers;
}

// Gives data URIs of images a media type that the library knows: it misreads or loses others.
void UnifyImages(nlohmann::json* root) {
    if (!root->contains("images")) return;
    for (nlohmann::json& image : root->at("images")) {
        const std::string uri = image.value("uri", ""), jpeg = "data:image/jpeg;base64,";
        if (IsDataUri(uri))
            image["uri"] = (uri.starts_with(jpeg) ? jpeg : kData) + Base64Of(uri).value_or("");
    }
}

bool TakeBuffer(Bytes* out, std::string*, const std::string& number, void* buffers) {
    *out = std::move(static_cast<std::vector<Bytes>*>(buffers)->at(std::stoul(number)));
    return true;
}

// Returns the functions by which the library reads files: from 2.9 on it refuses fewer than all.
template <typename Callbacks = tinygltf::FsCallbacks>
Callbacks FileCallbacks(std::vector<Bytes>* buffers) {
    Callbacks callbacks{};
    callbacks.user_data = buffers;
    callbacks.FileExists = [](const std::string&, void*) { return true; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = TakeBuffer;
    callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
    // The library compares the size with a limit of its own.
    if constexpr (requires { callbacks.GetFileSizeInBytes; })
        callbacks.GetFileSizeInBytes = [](size_t* size, std::string*, const std::string&, void*) {
            *size = 0;
            return true;
        };
    return callbacks;
}

bool KeepImage(tinygltf::Image* image, int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

std::string NumberedNames(const std::vector<std::string>& names) {
    std::string list;
    for (size_t i = 0; i < names.size(); ++i)
        list += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i, Printable(names[i]));
    return list.empty() ? "none" : list;
}

}  // namespace

std::string DecodeUri(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0'
                                    : std::tolower(static_cast<unsigned char>(c)) - 'a' + 10;
    };
    std::string decoded;
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool isCode =
            uri[i] == '%' && i + 2 < uri.size() && IsHexDigit(uri[i + 1]) && IsHexDigit(uri[i + 2]);
        decoded += isCode ? char(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
        if (isCode) i += 2;
    }
    return decoded;
}

bool IsDataUri(std::string_view uri) {
    return EqualsInLowerCase(uri.substr(0, kScheme.size()), kScheme);
}

std::optional<std::string> Base64Of(std::string_view dataUri) {
    const size_t comma = dataUri.find(',');
    if (comma == dataUri.npos || comma < kScheme.size()) return {};
    // Some leave out the semicolon along with the type.
    std::string_view type = dataUri.substr(kScheme.size(), comma - kScheme.size());
    if (const size_t start = type.rfind(';'); start != type.npos) type = type.substr(start + 1);
    if (!EqualsInLowerCase(type, kEncoding)) return {};
    std::string data(dataUri.substr(comma + 1));
    if (data.find('%') != data.npos) data = DecodeUri(data);
    std::erase_if(data, [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); });
    return data;
}

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

size_t ChooseByName(const GltfDocument& document, const std::string& what,
                    const std::vector<std::string>& names, const std::string& wanted) {
    const auto named = std::find(names.begin(), names.end(), wanted);
    if (named != names.end()) return size_t(named - names.begin());
    size_t number = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [at, error] = std::from_chars(wanted.data(), end, number);
    if (error == std::errc() && at == end && number < names.size()) return number;
    throw Error("{}: has no {} \"{}\"; it has {}", document.file, what, wanted,
                NumberedNames(names));
}

GltfDocument ReadGltf(const std::string& file, Warnings& warnings) {
    const FileContents contents = ReadFile(file);
    const std::string_view bytes = contents.View();
    if (bytes.size() > std::numeric_limits<uint32_t>::max())
        throw Error(file + ": is larger than 4 GB, which glTF files cannot be");
    // Padding by NULs instead of spaces is usual.
    const std::string_view text = JsonOf(file, bytes);
    nlohmann::json root =
        ParseGltfJson(file, CleanText(text, {std::make_shared<const std::string>(file), 0}));
    RepairGltfJson(file, &root, warnings);
    CheckGltfJson(file, &root, warnings);
    CheckExtensions(file, root, warnings);
    UnifyImages(&root);
    GltfDocument document{file, {}, {}};
    std::vector<Bytes> buffers = TakeBuffers(std::filesystem::path(file).parent_path(),
                                             DataOf(file, bytes, text.size()), &root, &document);

    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(FileCallbacks(&buffers));
    reader.SetImageLoader(KeepImage, nullptr);
    std::string error, warning;
    bool isRead = false;
    try {
        const std::string checked = root.dump();
        isRead = reader.LoadASCIIFromString(&document.model, &error, &warning, checked.data(),
                                            unsigned(checked.size()), "");
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!isRead) throw Error(file + ": " + Printable(error.substr(0, error.find('\n')), 200));
    DecodeMeshopt(&document);
    DecodeDraco(&document);
    return document;
}

}  // namespace lull
