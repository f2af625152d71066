#include "tests/side_by_side/glb_file.h"

#include <algorithm>
#include <cstring>

#include "renderer/files/file_io.h"

namespace lull {
namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125, kClampToEdge = 33071, kRepeat = 10497;

// Appends values in this machine's order of bytes, which has to be glTF's: little-endian.
void Append(std::vector<std::byte>* bytes, const void* from, size_t size) {
    static_assert(std::endian::native == std::endian::little);
    const auto* begin = static_cast<const std::byte*>(from);
    bytes->insert(bytes->end(), begin, begin + size);
}

void AppendNumber(std::vector<std::byte>* bytes, size_t number) {
    const auto value = uint32_t(number);
    Append(bytes, &value, sizeof value);
}

void Pad(std::vector<std::byte>* bytes, char filler) {
    while (bytes->size() % 4 != 0) bytes->push_back(std::byte(filler));
}

}  // namespace

int GlbFile::Add(const char* kind, nlohmann::json entry) {
    root[kind].push_back(std::move(entry));
    return int(root[kind].size()) - 1;
}

void GlbFile::Use(const std::string& extension) {
    auto& used = root["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
}

int GlbFile::AddView(const void* bytes, size_t size) {
    Pad(&data, 0);
    const int view =
        Add("bufferViews", {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", size}});
    Append(&data, bytes, size);
    return view;
}

int GlbFile::AddAccessor(int view, int componentType, const char* type, size_t count) {
    return Add(
        "accessors",
        {{"bufferView", view}, {"componentType", componentType}, {"type", type}, {"count", count}});
}

int GlbFile::AddVectors(std::span<const Vec3f> values, bool withBounds) {
    const int accessor =
        AddAccessor(AddView(values.data(), values.size_bytes()), kFloat, "VEC3", values.size());
    if (!withBounds) return accessor;
    Vec3f lower = values[0], upper = values[0];
    for (const Vec3f& v : values) {
        lower = lower.cwiseMin(v);
        upper = upper.cwiseMax(v);
    }
    auto& entry = root["accessors"].back();
    entry["min"] = {lower.x(), lower.y(), lower.z()};
    entry["max"] = {upper.x(), upper.y(), upper.z()};
    return accessor;
}

int GlbFile::AddVectors(std::span<const Vec2f> values) {
    return AddAccessor(AddView(values.data(), values.size_bytes()), kFloat, "VEC2", values.size());
}

int GlbFile::AddIndices(std::span<const std::array<uint32_t, 3>> triangles) {
    return AddAccessor(AddView(triangles.data(), triangles.size_bytes()), kUnsignedInt, "SCALAR",
                       3 * triangles.size());
}

int GlbFile::AddTexture(std::span<const std::byte> bytes, const std::string& mimeType,
                        const std::string& name, bool clamp) {
    const int wrap = clamp ? kClampToEdge : kRepeat;
    const int view = AddView(bytes.data(), bytes.size());
    const int image = Add("images", {{"bufferView", view}, {"mimeType", mimeType}, {"name", name}});
    const int sampler = Add("samplers", {{"wrapS", wrap}, {"wrapT", wrap}});
    return Add("textures", {{"source", image}, {"sampler", sampler}});
}

void GlbFile::Write(const std::string& path) {
    Pad(&data, 0);
    root["buffers"] = nlohmann::json::array({{{"byteLength", data.size()}}});
    const std::string text = root.dump();
    std::vector<std::byte> json;
    Append(&json, text.data(), text.size());
    Pad(&json, ' ');

    std::vector<std::byte> file;
    Append(&file, "glTF", 4);
    AppendNumber(&file, 2);
    AppendNumber(&file, 12 + 8 + json.size() + 8 + data.size());
    AppendNumber(&file, json.size());
    Append(&file, "JSON", 4);
    Append(&file, json.data(), json.size());
    AppendNumber(&file, data.size());
    Append(&file, "BIN\0", 4);
    Append(&file, data.data(), data.size());
    WriteFileAtomically(path, file);
}

}  // namespace lull
