// Undoes the compression of meshes.
#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "renderer/base/memory.h"
#include "renderer/input/gltf/accessors.h"

namespace lull {
namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

std::unique_ptr<draco::Mesh> DecodeMesh(const FileLoc& loc, const unsigned char* bytes,
                                        size_t size) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes), size);
    draco::Decoder decoder;
    try {
        auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
        if (!mesh.ok())
            throw Error(loc, "its data are broken: " + mesh.status().error_msg_string());
        return std::move(mesh).value();
    } catch (const std::bad_alloc&) {
        throw Error(loc, "its data are broken: they ask for more memory than there is");
    }
}

template <typename T>
int AddAccessor(const std::vector<T>& values, int componentType, int type, size_t count,
                tinygltf::Model* model) {
    tinygltf::Buffer buffer;
    buffer.data.resize(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(buffer.data.data(), values.data(), buffer.data.size());
    tinygltf::BufferView view;
    view.buffer = int(model->buffers.size());
    view.byteLength = buffer.data.size();
    tinygltf::Accessor accessor;
    accessor.bufferView = int(model->bufferViews.size());
    accessor.componentType = componentType;
    accessor.type = type;
    accessor.count = count;
    model->buffers.push_back(std::move(buffer));
    model->bufferViews.push_back(std::move(view));
    model->accessors.push_back(std::move(accessor));
    return int(model->accessors.size()) - 1;
}

std::vector<float> ValuesOf(const FileLoc& loc, const draco::Mesh& mesh,
                            const draco::PointAttribute& attribute,
                            const tinygltf::Accessor& accessor, bool normalizes) {
    const int components = attribute.num_components();
    if (components != tinygltf::GetNumComponentsInType(uint32_t(accessor.type)))
        throw Error(loc, "an attribute has another number of components than its accessor");
    float scale = 1;
    if ((accessor.normalized || normalizes) && !attribute.normalized())
        switch (attribute.data_type()) {
            // clang-format off
            case draco::DT_INT8: scale = 1 / 127.f; break;
            case draco::DT_UINT8: scale = 1 / 255.f; break;
            case draco::DT_INT16: scale = 1 / 32767.f; break;
            case draco::DT_UINT16: scale = 1 / 65535.f; break;
            default: break;
                // clang-format on
        }
    std::vector<float> values(size_t(mesh.num_points()) * size_t(components));
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        float* out = &values[size_t(i) * size_t(components)];
        const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
        if (at.value() >= attribute.size() ||
            !attribute.ConvertValue<float>(at, int8_t(components), out))
            throw Error(loc, "its data are broken: an attribute has too few values");
        for (int c = 0; c < components; ++c) out[c] *= scale;
    }
    return values;
}

void DecodePrimitive(const FileLoc& loc, const tinygltf::Value& extension,
                     tinygltf::Primitive* primitive, tinygltf::Model* model) {
    const auto index = size_t(extension.Get("bufferView").GetNumberAsInt());
    const tinygltf::BufferView& view = model->bufferViews[index];
    const std::vector<unsigned char>& data = model->buffers[size_t(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        throw Error(loc, "/bufferViews/{} goes beyond its buffer", index);
    const std::unique_ptr<draco::Mesh> mesh =
        DecodeMesh(loc, data.data() + view.byteOffset, view.byteLength);
    if (mesh->num_points() == 0 || mesh->num_faces() == 0)
        throw Error(loc, "its data hold no triangles");

    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < mesh->num_faces(); ++i)
        for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(i)))
            indices.push_back(point.value());
    primitive->indices = AddAccessor(indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                     TINYGLTF_TYPE_SCALAR, indices.size(), model);
    primitive->mode = TINYGLTF_MODE_TRIANGLES;
    const tinygltf::Value& attributes = extension.Get("attributes");
    for (const std::string& name : attributes.Keys()) {
        const auto found = primitive->attributes.find(name);
        const auto* attribute =
            mesh->GetAttributeByUniqueId(uint32_t(attributes.Get(name).GetNumberAsInt()));
        if (found == primitive->attributes.end() || !attribute)
            throw Error(loc, "its data have no attribute for one that it names");
        const tinygltf::Accessor accessor = model->accessors[size_t(found->second)];
        found->second =
            AddAccessor(ValuesOf(loc, *mesh, *attribute, accessor, Normalizes(*model, name)),
                        TINYGLTF_COMPONENT_TYPE_FLOAT, accessor.type, mesh->num_points(), model);
    }
}

}  // namespace

void DecodeDraco(GltfDocument* document) {
    tinygltf::Model& model = document->model;
    for (size_t m = 0; m < model.meshes.size(); ++m)
        for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
            tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
            const auto found = primitive.extensions.find(kDracoExtension);
            if (found == primitive.extensions.end()) continue;
            DecodePrimitive(document->At(fmt::format("/meshes/{}/primitives/{}/extensions/{}", m, p,
                                                     kDracoExtension)),
                            found->second, &primitive, &model);
        }
}

namespace {

constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";
// Sixteen bytes take at least two bits.
constexpr size_t kMaxCompression = 100;

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
        throw Error(loc, "mode {2} with filter {3} does not support {0} elements of {1} bytes",
                    count, stride, mode, filter);
}

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
        throw Error(loc, "goes beyond its buffer of {} bytes", data.size());
    if (count * stride != byteLength || byteLength / kMaxCompression > size)
        throw Error(loc, "{} bytes cannot hold {} elements of {} bytes in a view of {} bytes", size,
                    count, stride, byteLength);
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

}  // namespace lull
