#include "renderer/input/description.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "renderer/files/file_io.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

int Components(ParameterType type) {
    switch (type) {
        case ParameterType::Point2:
        case ParameterType::Vector2:
            return 2;
        case ParameterType::Point3:
        case ParameterType::Vector3:
        case ParameterType::Normal:
        case ParameterType::Spectrum:
            return 3;
        default:
            return 1;
    }
}

const Parameter* Search(const std::vector<Parameter>& parameters, ParameterType type,
                        const std::string& name) {
    for (const Parameter& parameter : parameters)
        if (parameter.type == type && parameter.name == name) return &parameter;
    for (const Parameter& parameter : parameters)
        if (parameter.name == name) parameter.wanted = type;
    return nullptr;
}

std::string TypesOf(const Parameter& parameter) {
    if (parameter.lookedUp || !parameter.wanted) return "";
    if (*parameter.wanted == parameter.type) {
        const size_t count = std::visit([](const auto& v) { return v.size(); }, parameter.values);
        return "; it has " + std::to_string(count) + " values and has to have " +
               std::to_string(Components(parameter.type));
    }
    return "; it is given as \"" + NameOf(parameter.type) + "\" and has to be \"" +
           NameOf(*parameter.wanted) + "\"";
}

template <typename T>
const T* FindOne(const std::vector<Parameter>& parameters, ParameterType type,
                 const std::string& name) {
    const Parameter* parameter = Search(parameters, type, name);
    if (!parameter) return nullptr;
    const auto& values = std::get<std::vector<T>>(parameter->values);
    if (int(values.size()) != Components(type)) {
        parameter->wanted = type;
        return nullptr;
    }
    parameter->lookedUp = true;
    return values.data();
}

}  // namespace

void Parameters::Add(Parameter parameter) {
    for (Parameter& present : parameters)
        if (present.type == parameter.type && present.name == parameter.name) {
            present = std::move(parameter);
            return;
        }
    parameters.push_back(std::move(parameter));
}

float Parameters::GetFloat(const std::string& name, float otherwise) const {
    const float* value = FindOne<float>(parameters, ParameterType::Float, name);
    return value ? *value : otherwise;
}

int Parameters::GetInt(const std::string& name, int otherwise) const {
    const int* value = FindOne<int>(parameters, ParameterType::Integer, name);
    return value ? *value : otherwise;
}

bool Parameters::GetBool(const std::string& name, bool otherwise) const {
    const int* value = FindOne<int>(parameters, ParameterType::Bool, name);
    return value ? *value != 0 : otherwise;
}

std::string Parameters::GetString(const std::string& name, const std::string& otherwise) const {
    const std::string* value = FindOne<std::string>(parameters, ParameterType::String, name);
    return value ? *value : otherwise;
}

Vec3f Parameters::GetPoint3(const std::string& name, const Vec3f& otherwise) const {
    const float* p = FindOne<float>(parameters, ParameterType::Point3, name);
    return p ? Vec3f(p[0], p[1], p[2]) : otherwise;
}

Vec3f Parameters::GetVector3(const std::string& name, const Vec3f& otherwise) const {
    const float* v = FindOne<float>(parameters, ParameterType::Vector3, name);
    return v ? Vec3f(v[0], v[1], v[2]) : otherwise;
}

Rgb Parameters::GetSpectrum(const std::string& name, const Rgb& otherwise) const {
    const float* c = FindOne<float>(parameters, ParameterType::Spectrum, name);
    return c ? Rgb(c[0], c[1], c[2]) : otherwise;
}

const Parameter* Parameters::Find(ParameterType type, const std::string& name) const {
    const Parameter* parameter = Search(parameters, type, name);
    if (parameter) parameter->lookedUp = true;
    return parameter;
}

std::optional<Parameter> Parameters::Take(ParameterType type, const std::string& name) {
    const auto it = std::ranges::find_if(
        parameters, [&](const Parameter& p) { return p.type == type && p.name == name; });
    if (it == parameters.end()) return {};
    Parameter taken = std::move(*it);
    parameters.erase(it);
    return taken;
}

std::span<const float> Parameters::GetFloats(ParameterType type, const std::string& name) const {
    const Parameter* parameter = Find(type, name);
    if (!parameter) return {};
    const auto* values = std::get_if<std::vector<float>>(&parameter->values);
    return values ? std::span<const float>(*values) : std::span<const float>();
}

std::span<const int> Parameters::GetInts(const std::string& name) const {
    const Parameter* parameter = Find(ParameterType::Integer, name);
    if (!parameter) return {};
    return std::get<std::vector<int>>(parameter->values);
}

const TextureRef* Parameters::GetTexture(const std::string& name) const {
    return FindOne<TextureRef>(parameters, ParameterType::Texture, name);
}

std::string Parameters::Mistyped(const std::string& name) const {
    for (const Parameter& parameter : parameters)
        if (parameter.name == name) return TypesOf(parameter);
    return "";
}

void Parameters::ReportUnused(const std::string& owner, Warnings& warnings) const {
    for (const Parameter& parameter : parameters)
        if (!parameter.lookedUp)
            warnings.Add(parameter.loc, "unused parameter",
                         "'" + Printable(parameter.name) + "' of " + owner + " has no effect" +
                             TypesOf(parameter));
}

bool IntegratorSeesMedia(const std::string& name) {
    return name == "volpath" || name == "bdpt" || name == "mlt";
}

std::vector<std::string> FilesOf(const Description& d) {
    std::vector<std::string> files = d.sources;
    const auto add = [&](const Entity& entity) {
        for (const Parameter& parameter : entity.parameters.All())
            if (const auto* texts = std::get_if<std::vector<std::string>>(&parameter.values))
                for (const std::string& text : *texts) {
                    const std::string path = ResolvePath(d, text);
                    std::error_code error;
                    if (!text.empty() && std::filesystem::is_regular_file(path, error))
                        files.push_back(path);
                }
    };
    const auto addAll = [&](const auto& entities) {
        for (const Entity& entity : entities) add(entity);
    };
    add(d.camera);
    addAll(d.textures);
    addAll(d.materials);
    addAll(d.lights);
    addAll(d.shapes);
    for (const ObjectEntity& object : d.objects) addAll(object.shapes);
    addAll(d.media);
    return files;
}

namespace {

std::string WithBackslashes(const std::string& name) {
    constexpr std::string_view kRead = "\b\f\n\r\t", kWritten = "bfnrt";
    std::string written;
    for (const char c : name) {
        const size_t at = kRead.find(c);
        if (at != kRead.npos) written += '\\';
        written += at != kRead.npos ? kWritten[at] : c;
    }
    return written;
}

}  // namespace

std::string ResolvePath(const Description& description, const std::string& file) {
    // An absolute path replaces the directory.
    const auto resolved = [&](const std::string& name) {
        if (name.empty() || description.directory.empty()) return name;
        return (std::filesystem::path(description.directory) / name).string();
    };
    std::error_code ignored;
    const std::string written = WithBackslashes(file);
    if (written.find('\\') == written.npos || std::filesystem::exists(resolved(file), ignored))
        return resolved(file);
    std::string slashed = written;
    std::ranges::replace(slashed, '\\', '/');
    return resolved(std::filesystem::exists(resolved(slashed), ignored) ? slashed : written);
}

// Identifies scenes.

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
