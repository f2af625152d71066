// Makes glTF files for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/input/gltf_loader.h"
#include "tests/renderer/files/test_files.h"

namespace lull {

using nlohmann::json;

inline std::string Base64(const std::string& bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

inline const json kPerspectiveCamera = {{"type", "perspective"},
                                        {"perspective", {{"yfov", 1}, {"znear", 0.1}}}};

// Contents of a glTF file; the JSON may be changed at will before it is written.
struct GltfFile {
    json root = {{"asset", {{"version", "2.0"}}},
                 {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},
                 {"nodes", json::array()},
                 {"meshes", json::array()}};
    std::string bytes;

    // Adds a view of `data` and returns its index.
    int View(const std::string& data, int stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
        if (stride > 0) view["byteStride"] = stride;
        bytes += data;
        root["bufferViews"].push_back(view);
        return int(root["bufferViews"].size()) - 1;
    }
    template <typename T>
    int View(const std::vector<T>& values, int stride = 0) {
        return View(
            std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)),
            stride);
    }
    int Accessor(int view, int componentType, size_t count, const char* type,
                 const json& more = json::object()) {
        json accessor = {{"bufferView", view},
                         {"componentType", componentType},
                         {"count", count},
                         {"type", type}};
        accessor.update(more);
        root["accessors"].push_back(accessor);
        return int(root["accessors"].size()) - 1;
    }
    int Floats(const std::vector<float>& values, const char* type) {
        const std::string kind = type;
        const size_t components = kind == "SCALAR" ? 1 : size_t(kind[3] - '0');
        return Accessor(View(values), 5126, values.size() / components, type);
    }
    int Indices(const std::vector<uint16_t>& values) {
        return Accessor(View(values), 5123, values.size(), "SCALAR");
    }

    // Adds a mesh of one primitive.
    int Mesh(const json& attributes, const json& more = json::object()) {
        json primitive = {{"attributes", attributes}};
        primitive.update(more);
        root["meshes"].push_back({{"primitives", {primitive}}});
        return int(root["meshes"].size()) - 1;
    }
    // Adds the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0).
    int Triangle(const json& more = json::object()) {
        return Mesh({{"POSITION", Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}}, more);
    }
    // Adds a node to the scene.
    int Node(const json& node) {
        root["nodes"].push_back(node);
        const int index = int(root["nodes"].size()) - 1;
        json& nodes = root["scenes"][0]["nodes"];
        if (index > 0) nodes.push_back(index);
        return index;
    }

    // Adds a node with a light to the scene.
    void Light(const json& light, json node = json::object()) {
        json& lights = root["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(light);
        node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
        Node(node);
    }
    // Adds the triangle with a material to the scene.
    void Surface(const json& material) {
        root["materials"].push_back(material);
        Node({{"mesh", Triangle({{"material", root["materials"].size() - 1}})}});
    }

    std::string Text() const {
        json whole = root;
        if (!bytes.empty())
            whole["buffers"] = {{{"byteLength", bytes.size()},
                                 {"uri", "data:application/octet-stream;base64," + Base64(bytes)}}};
        return whole.dump();
    }
    std::string Binary() const {
        json whole = root;
        whole["buffers"] = {{{"byteLength", bytes.size()}}};
        return Glb(whole.dump(), bytes);
    }
    static std::string Glb(std::string text, std::string data) {
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4);
        const auto number = [](size_t n) {
            const auto n32 = uint32_t(n);
            return std::string(reinterpret_cast<const char*>(&n32), 4);
        };
        return "glTF" + number(2) + number(12 + 8 + text.size() + 8 + data.size()) +
               number(text.size()) + "JSON" + text + number(data.size()) + std::string("BIN\0", 4) +
               data;
    }
};

// Gives a test of the loader a directory of its own.
struct GltfFolder : TemporaryDirectory {
    Description Parse(const GltfFile& file, const GltfOptions& options = {},
                      Warnings* warnings = nullptr) const {
        Warnings ignored;
        return ParseGltf(Write("scene.gltf", file.Text()), options, warnings ? *warnings : ignored);
    }

    // Parses a file that nothing is to be warned of.
    Description ParseSilently(const GltfFile& file, const GltfOptions& options = {}) const {
        Warnings warnings;
        Description d = Parse(file, options, &warnings);
        EXPECT_EQ(warnings.Total(), 0);
        return d;
    }

    // Returns the message of the Error that a text gives, without the folder's name; "" for none.
    std::string ErrorOf(const std::string& text, const std::string& name = "scene.gltf") const {
        const std::string written = Write(name, text);
        return WithoutPath(lull::ErrorOf([&] {
            Warnings ignored;
            ParseGltf(written, {}, ignored);
        }));
    }
    std::string ErrorOf(const GltfFile& file) const { return ErrorOf(file.Text()); }
};
inline const GltfFolder kFolder;

// Returns a file of the triangle alone.
inline GltfFile OneTriangle(const json& more = json::object()) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle(more)}});
    return file;
}

template <typename T>
void ExpectNear(const std::vector<T>& values, const std::vector<double>& expected,
                double tolerance = 1e-6) {
    ASSERT_EQ(values.size(), expected.size());
    for (size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], expected[i], tolerance) << "value " << i;
}

inline std::vector<float> FloatsOf(const Entity& entity, ParameterType type, const char* name) {
    const auto values = entity.parameters.GetFloats(type, name);
    return {values.begin(), values.end()};
}

inline std::vector<float> Positions(const Description& d, size_t shape = 0) {
    return FloatsOf(d.shapes.at(shape), ParameterType::Point3, "P");
}

}  // namespace lull
