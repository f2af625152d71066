#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstring>

#include "renderer/input/gltf/decompression.h"

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

// Adds an accessor with a buffer of its own, packed. Returns its index.
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

// Returns an attribute as floats; integers that the file calls normalised become 0 to 1 or -1 to 1.
std::vector<float> ValuesOf(const FileLoc& loc, const draco::Mesh& mesh,
                            const draco::PointAttribute& attribute,
                            const tinygltf::Accessor& accessor) {
    const int components = attribute.num_components();
    if (components != tinygltf::GetNumComponentsInType(uint32_t(accessor.type)))
        throw Error(loc, "an attribute has another number of components than its accessor");
    float scale = 1;
    if (accessor.normalized && !attribute.normalized()) switch (attribute.data_type()) {
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
        throw Error(loc, fmt::format("/bufferViews/{} goes beyond its buffer", index));
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
            AddAccessor(ValuesOf(loc, *mesh, *attribute, accessor), TINYGLTF_COMPONENT_TYPE_FLOAT,
                        accessor.type, mesh->num_points(), model);
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

}  // namespace lull
