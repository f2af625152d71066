#include "renderer/input/description.h"

#include <filesystem>
#include <utility>

#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Returns the numbers of `parameter` that make up one value of `type`.
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

// Finds the parameter of that type and name without marking it as used.
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

// Returns the values if the parameter is there with exactly one value (and marks it), else null.
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

// Returns a name with the backslashes that it had before they were read as escapes.
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

}  // namespace lull
