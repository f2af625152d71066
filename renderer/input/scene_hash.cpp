#include "renderer/input/scene_hash.h"

#include <fmt/format.h>
#include <zlib.h>

#include <filesystem>

#include "renderer/files/file_io.h"

namespace lull {

namespace {

class Hasher {
  public:
    explicit Hasher(const Description& description) : description(description) {}

    void Bytes(const void* data, size_t size) {
        crc = crc32_z(crc, static_cast<const Bytef*>(data), size);
    }
    template <typename T>
    void Number(const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        Bytes(&value, sizeof value);
    }
    // The length keeps "ab", "c" and "a", "bc" apart.
    void Text(std::string_view text) {
        Number(uint64_t(text.size()));
        Bytes(text.data(), text.size());
    }
    void Of(const TransformPair& pair) {
        for (const Mat4d& m : pair.at) Matrix(m);
    }
    void Matrix(const Mat4d& m) { Bytes(m.data(), sizeof(double) * size_t(m.size())); }

    void Value(const Parameter& parameter) {
        Number(int(parameter.type));
        Text(parameter.name);
        std::visit([&](const auto& values) { Values(values); }, parameter.values);
    }
    void Of(const Entity& entity) {
        Text(entity.name);
        for (const Parameter& parameter : entity.parameters.All()) Value(parameter);
    }
    void Of(const ShapeEntity& shape) {
        Of(static_cast<const Entity&>(shape));
        Matrix(shape.worldFromObject);
        Number(shape.reverseOrientation);
        Number(shape.material);
        if (shape.areaLight) Of(*shape.areaLight);
        for (const Entity& strand : shape.strands) Of(strand);
        if (description.media.empty()) return;
        Number(shape.insideMedium);
        Number(shape.outsideMedium);
    }

    uint32_t Result() const { return uint32_t(crc); }

  private:
    template <typename T>
    void Values(const std::vector<T>& values) {
        Number(uint64_t(values.size()));
        Bytes(values.data(), values.size() * sizeof(T));
    }
    void Values(const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            const std::string path = ResolvePath(description, text);
            std::error_code error;
            if (text.empty() || !std::filesystem::is_regular_file(path, error)) {
                Text(text);
                continue;
            }
            Text(std::filesystem::path(text).filename().string());
            const FileContents file = ReadFile(path);
            Text(file.View());
        }
    }
    void Values(const std::vector<TextureRef>& textures) {
        for (const TextureRef& texture : textures) {
            Number(texture.floatIndex);
            Number(texture.spectrumIndex);
        }
    }

    const Description& description;
    uLong crc = crc32_z(0, nullptr, 0);
};

void HashShapes(const Description& d, Hasher* hash) {
    for (const ShapeEntity& shape : d.shapes) hash->Of(shape);
    for (const ObjectEntity& object : d.objects) {
        hash->Text(object.name);
        for (const ShapeEntity& shape : object.shapes) hash->Of(shape);
    }
    for (const InstanceEntity& instance : d.instances) {
        hash->Number(instance.object);
        hash->Matrix(instance.worldFromInstance);
        if (instance.motion >= 0)
            for (const TransformPair& pair : d.motions[instance.motion]) hash->Of(pair);
    }
}

}  // namespace

std::string SceneHash(const Description& d) {
    Hasher hash(d);
    // Not the film's name for its file, but the whole rest of it.
    for (const Entity* entity : {&d.camera, &d.film, &d.filter, &d.sampler, &d.integrator}) {
        hash.Text(entity->name);
        for (const Parameter& parameter : entity->parameters.All())
            if (entity != &d.film || parameter.name != "filename") hash.Value(parameter);
    }
    hash.Matrix(d.cameraFromWorld);
    if (d.movingCameraFromWorld) hash.Of(*d.movingCameraFromWorld);
    if (d.movingCameraFromWorld || !d.motions.empty())
        for (const double time : d.transformTimes) hash.Number(time);
    for (const TextureEntity& texture : d.textures) {
        hash.Of(texture);
        hash.Number(texture.isSpectrum);
        hash.Matrix(texture.worldFromTexture);
    }
    for (const MaterialEntity& material : d.materials) {
        hash.Of(material);
        for (const int operand : material.operands) hash.Number(operand);
    }
    for (const LightEntity& light : d.lights) {
        hash.Of(light);
        hash.Matrix(light.worldFromLight);
    }
    HashShapes(d, &hash);
    for (const MediumEntity& medium : d.media) {
        hash.Of(medium);
        hash.Matrix(medium.worldFromMedium);
    }
    if (!d.media.empty()) hash.Number(d.cameraMedium);
    for (const EmbeddedImage& image : d.images)
        hash.Text({reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()});
    return fmt::format("crc32:{:08x}", hash.Result());
}

}  // namespace lull
