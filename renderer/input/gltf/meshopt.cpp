#include <fmt/format.h>
#include <meshoptimizer.h>

#include <nlohmann/json.hpp>

#include <algorithm>

#include "renderer/base/memory.h"
#include "renderer/input/gltf/decompression.h"

namespace lull {
namespace {

constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";
// Sixteen bytes take at least two bits.
constexpr size_t kMaxCompression = 100;

// Decodes `count` elements of `stride` bytes. Returns 0 if it can.
int Decode(const std::string& mode, unsigned char* out, size_t count, size_t stride,
           const unsigned char* bytes, size_t size) {
    if (mode == "ATTRIBUTES") return meshopt_decodeVertexBuffer(out, count, stride, bytes, size);
    if (mode == "TRIANGLES") return meshopt_decodeIndexBuffer(out, count, stride, bytes, size);
    return meshopt_decodeIndexSequence(out, count, stride, bytes, size);
}

void CheckLayout(const FileLoc& loc, const std::string& mode, const std::string& filter,
                 size_t count, size_t stride) {
    const bool isAttributes = mode == "ATTRIBUTES";
    const bool fits = isAttributes ? stride % 4 == 0 && stride >= 4 && stride <= 256
                                   : (stride == 2 || stride == 4);
    const bool filterFits = filter == "NONE" ||
                            (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                            (filter == "QUATERNION" && stride == 8) || filter == "EXPONENTIAL";
    if (!fits || !filterFits || (mode == "TRIANGLES" && count % 3 != 0) ||
        (!isAttributes && filter != "NONE"))
        throw Error(loc,
                    fmt::format("mode {2} with filter {3} does not support {0} elements of {1} "
                                "bytes",
                                count, stride, mode, filter));
}

// Decodes a view of `byteLength` bytes. Returns the stride of its attributes, 0 for indices.
size_t DecodeView(const tinygltf::Model& model, const tinygltf::Value& e, const FileLoc& loc,
                  size_t byteLength, std::vector<unsigned char>* decoded) {
    const auto whole = [&](const char* name) {
        return size_t(std::max(0., e.Get(name).GetNumberAsDouble()));
    };
    const auto text = [&](const char* name) {
        return e.Has(name) ? e.Get(name).Get<std::string>() : std::string("NONE");
    };
    const size_t count = whole("count"), stride = whole("byteStride");
    const size_t offset = whole("byteOffset"), size = whole("byteLength");
    const std::string mode = text("mode"), filter = text("filter");
    CheckLayout(loc, mode, filter, count, stride);
    const std::vector<unsigned char>& data = model.buffers[whole("buffer")].data;
    if (offset > data.size() || size > data.size() - offset)
        throw Error(loc, fmt::format("goes beyond its buffer of {} bytes", data.size()));
    if (count * stride != byteLength || byteLength / kMaxCompression > size)
        throw Error(loc, fmt::format("{} bytes cannot hold {} elements of {} bytes in a view of "
                                     "{} bytes",
                                     size, count, stride, byteLength));
    CheckMemory(int64_t(byteLength), loc.Prefix() + "the mesh", "use a smaller mesh");

    decoded->resize(byteLength);
    if (Decode(mode, decoded->data(), count, stride, data.data() + offset, size) != 0)
        throw Error(loc, "its data are broken");
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded->data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(decoded->data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded->data(), count, stride);
    return mode == "ATTRIBUTES" ? stride : 0;
}

}  // namespace

void DecodeMeshopt(GltfDocument* document) {
    tinygltf::Model& model = document->model;
    for (size_t i = 0; i < model.bufferViews.size(); ++i) {
        tinygltf::BufferView& view = model.bufferViews[i];
        const auto found = view.extensions.find(kMeshoptExtension);
        if (found == view.extensions.end()) continue;
        const FileLoc loc =
            document->At(fmt::format("/bufferViews/{}/extensions/{}", i, kMeshoptExtension));
        tinygltf::Buffer decoded;
        const size_t stride = DecodeView(model, found->second, loc, view.byteLength, &decoded.data);
        view.buffer = int(model.buffers.size());
        view.byteOffset = 0;
        view.byteStride = stride;
        model.buffers.push_back(std::move(decoded));
    }
}

bool HideCompressed(nlohmann::json* root) {
    bool hasChanged = false;
    const auto has = [](const nlohmann::json& o, const char* extension) {
        return o.contains("extensions") && o.at("extensions").contains(extension);
    };
    const auto each = [](nlohmann::json* owner, const char* name, const auto& f) {
        if (owner->contains(name))
            for (nlohmann::json& one : owner->at(name)) f(one);
    };
    each(root, "buffers", [&](nlohmann::json& buffer) {
        if (buffer.contains("uri") || !has(buffer, kMeshoptExtension)) return;
        buffer["uri"] = "data:application/octet-stream;base64,AA==";
        buffer["byteLength"] = 1;
        hasChanged = true;
    });
    each(root, "meshes", [&](nlohmann::json& mesh) {
        each(&mesh, "primitives", [&](nlohmann::json& primitive) {
            if (has(primitive, "KHR_draco_mesh_compression"))
                hasChanged |= primitive.erase("indices") > 0;
        });
    });
    return hasChanged;
}

}  // namespace lull
