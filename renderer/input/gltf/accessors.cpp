#include "renderer/input/gltf/accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "renderer/base/memory.h"

namespace lull {
namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125;  // 5126 is float

struct Elements {
    const unsigned char* bytes = nullptr;
    size_t stride = 0;
};

// Finds `count` elements of `size` bytes from `offset` on in a view, all of them inside it.
Elements Find(const GltfDocument& document, const FileLoc& loc, int view, size_t offset,
              size_t size, size_t count, bool mayBeStrided) {
    const tinygltf::BufferView& v = document.model.bufferViews[size_t(view)];
    const std::vector<unsigned char>& data = document.model.buffers[size_t(v.buffer)].data;
    const size_t stride = mayBeStrided && v.byteStride > 0 ? v.byteStride : size;
    if (stride < size)
        throw Error(loc,
                    "its elements of {} bytes overlap: the byteStride of /bufferViews/{} is {}",
                    size, view, stride);
    // All of these have been bounded far below overflow, but for the count.
    const size_t room = v.byteLength >= offset + size ? v.byteLength - offset - size : 0;
    if (v.byteLength < offset + size || (count - 1) > room / stride)
        throw Error(loc, "its {} elements go beyond the {} bytes of /bufferViews/{}", count,
                    v.byteLength, view);
    if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
        throw Error(loc, "/bufferViews/{} goes beyond its buffer of {} bytes", view, data.size());
    return {data.data() + v.byteOffset + offset, stride};
}

template <typename T>
T Load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

float Component(const unsigned char* bytes, int type, bool normalized) {
    const auto scaled = [normalized](auto v) {
        constexpr auto kMost = float(std::numeric_limits<decltype(v)>::max());
        return normalized ? std::max(float(v) / kMost, -1.f) : float(v);
    };
    switch (type) {
        case kByte:
            return scaled(Load<int8_t>(bytes));
        case kUnsignedByte:
            return scaled(Load<uint8_t>(bytes));
        case kShort:
            return scaled(Load<int16_t>(bytes));
        case kUnsignedShort:
            return scaled(Load<uint16_t>(bytes));
        case kUnsignedInt:
            return float(Load<uint32_t>(bytes));
        default:
            return Load<float>(bytes);
    }
}

uint32_t Index(const unsigned char* bytes, int type) {
    if (type == kUnsignedByte) return Load<uint8_t>(bytes);
    if (type == kUnsignedShort) return Load<uint16_t>(bytes);
    return Load<uint32_t>(bytes);
}

size_t SizeOf(int type) { return size_t(tinygltf::GetComponentSizeInBytes(uint32_t(type))); }

// Calls put(element, bytes) for the sparse values of an accessor, of `size` bytes each.
template <typename Put>
void ForEachSparse(const GltfDocument& document, const FileLoc& loc,
                   const tinygltf::Accessor& accessor, size_t size, const Put& put) {
    if (!accessor.sparse.isSparse) return;
    const auto& sparse = accessor.sparse;
    const auto count = size_t(sparse.count);
    if (count > accessor.count)
        throw Error(loc, "has {} sparse values for {} elements", count, accessor.count);
    const Elements indices =
        Find(document, loc, sparse.indices.bufferView, size_t(sparse.indices.byteOffset),
             SizeOf(sparse.indices.componentType), count, false);
    const Elements values = Find(document, loc, sparse.values.bufferView,
                                 size_t(sparse.values.byteOffset), size, count, false);
    for (size_t i = 0; i < count; ++i) {
        const size_t at = Index(indices.bytes + i * indices.stride, sparse.indices.componentType);
        if (at >= accessor.count)
            throw Error(loc, "sparse index {} is out of range: there are {} elements", at,
                        accessor.count);
        put(at, values.bytes + i * values.stride);
    }
}

}  // namespace

bool Normalizes(const tinygltf::Model& model, const std::string& attribute) {
    if (attribute.starts_with("COLOR_")) return true;
    const std::vector<std::string>& used = model.extensionsUsed;
    return attribute.starts_with("TEXCOORD_") &&
           std::find(used.begin(), used.end(), "KHR_mesh_quantization") == used.end();
}

GltfArray ReadNumbers(const GltfDocument& document, int index, int least, int most,
                      bool normalizes) {
    const tinygltf::Accessor& accessor = document.model.accessors[size_t(index)];
    const FileLoc loc = document.At(fmt::format("/accessors/{}", index));
    GltfArray array;
    array.components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    if (array.components < least || array.components > most || accessor.type == TINYGLTF_TYPE_MAT2)
        throw Error(loc, least == most ? fmt::format("has to have {} components for its use", least)
                                       : fmt::format("has to have {} to {} components for its use",
                                                     least, most));
    const size_t size = SizeOf(accessor.componentType);
    const auto components = size_t(array.components);
    const bool isNormalized = accessor.normalized || normalizes;
    Elements elements;
    if (accessor.bufferView >= 0)
        elements = Find(document, loc, accessor.bufferView, accessor.byteOffset, size * components,
                        accessor.count, true);
    const size_t bytes = accessor.count * components * sizeof(float);
    CheckMemory(int64_t(bytes), loc.Prefix() + fmt::format("{} elements", accessor.count),
                "use a smaller mesh");
    array.values.resize(accessor.count * components);
    const auto put = [&](size_t at, const unsigned char* bytes) {
        for (size_t c = 0; c < components; ++c)
            array.values[at * components + c] =
                Component(bytes + c * size, accessor.componentType, isNormalized);
    };
    for (size_t i = 0; elements.bytes && i < accessor.count; ++i)
        put(i, elements.bytes + i * elements.stride);
    ForEachSparse(document, loc, accessor, size * components, put);
    return array;
}

GltfArray ReadFloats(const GltfDocument& document, int index, int least, int most) {
    GltfArray array = ReadNumbers(document, index, least, most);
    for (size_t i = 0; i < array.values.size(); ++i)
        if (!std::isfinite(array.values[i]))
            throw Error(document.At(fmt::format("/accessors/{}", index)),
                        "element {} is not finite", i / size_t(array.components));
    return array;
}

std::vector<uint32_t> ReadIndices(const GltfDocument& document, int index, size_t bound) {
    const tinygltf::Accessor& accessor = document.model.accessors[size_t(index)];
    const FileLoc loc = document.At(fmt::format("/accessors/{}", index));
    const int type = accessor.componentType;
    if (accessor.type != TINYGLTF_TYPE_SCALAR ||
        (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt))
        throw Error(loc, "has to hold unsigned integers, as indices do");
    if (accessor.bufferView < 0)
        throw Error(loc, "holds indices without a bufferView: not supported");
    const Elements elements = Find(document, loc, accessor.bufferView, accessor.byteOffset,
                                   SizeOf(type), accessor.count, false);
    std::vector<uint32_t> indices(accessor.count);
    const auto put = [&](size_t at, const unsigned char* bytes) {
        indices[at] = Index(bytes, type);
    };
    for (size_t i = 0; i < accessor.count; ++i) put(i, elements.bytes + i * elements.stride);
    ForEachSparse(document, loc, accessor, SizeOf(type), put);
    for (const uint32_t i : indices)
        if (i >= bound)
            throw Error(loc, "index {} is out of range: there are {} vertices", i, bound);
    return indices;
}

}  // namespace lull
