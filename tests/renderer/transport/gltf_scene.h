// Makes scenes of glTF files, and measures their radiance.
#pragma once

#include <gtest/gtest.h>

#include "renderer/base/math.h"
#include "renderer/image/image_io.h"
#include "tests/renderer/input/gltf_files.h"
#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

// Its names would be in the way of those of other tests.
namespace lull::gltf_test {

inline CompileOptions ImageOf(int size) {
    CompileOptions options;
    options.threads = 1;
    options.film.resolution = Vec2i(size, size);
    return options;
}

// Compiles the text of a pbrt-v3 file.
inline std::unique_ptr<const Scene> Compiled(const std::string& text, int size) {
    Warnings warnings;
    auto scene = SceneOf(text, ImageOf(size), &warnings);
    EXPECT_EQ(warnings.Total(), 0);
    return scene;
}

inline std::unique_ptr<const Scene> Compiled(const Description& description, int size,
                                             bool warns = false) {
    Warnings warnings;
    auto scene = Compile(description, ImageOf(size), warnings);
    EXPECT_EQ(warnings.Total(), warns);
    return scene;
}

// Adds a camera 3 above the origin that sees from -half to half.
inline void LookDown(GltfFile* file, double half = 1) {
    file->root["cameras"] = {
        {{"type", "orthographic"},
         {"orthographic", {{"xmag", half}, {"ymag", half}, {"znear", 0}, {"zfar", 10}}}}};
    file->Node({{"camera", 0}, {"translation", {0, 0, 3}}});
}

// Compiles a file with its first camera, or with one 3 above the origin that sees from -1 to 1.
// `warns`: that it sees single-sided surfaces from behind.
inline std::unique_ptr<const Scene> Compiled(GltfFile file, int size = 4, bool warns = false) {
    if (!file.root.contains("cameras")) LookDown(&file);
    Warnings warnings;
    const Description d = ParseGltf(kFolder.Write("scene.gltf", file.Text()), {}, warnings);
    EXPECT_EQ(warnings.Total(), 0);
    return Compiled(d, size, warns);
}

struct Total {
    Rgb mean;
    float error;  // standard, of the green channel
};

inline Total Measure(const Scene& scene, Estimator estimator = Estimator::Combined,
                     int samples = 256) {
    const PixelStatistics pixels = MeasurePixels(scene, estimator, SamplerKind::Random, samples, 3);
    EXPECT_EQ(pixels.rejected, 0);
    const ImageMean image = MeanOf(pixels);
    return {image.mean.cast<float>(), float(image.error.y())};
}

// Adds the square from -1 to 1 in the plane z = 0, its front towards +z and its image upright.
inline int Square(GltfFile* file, const json& material, bool withTexture = false) {
    json attributes = {
        {"POSITION", file->Floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")}};
    if (withTexture) {
        attributes["NORMAL"] = file->Floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        attributes["TEXCOORD_0"] = file->Floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
    }
    file->root["materials"].push_back(material);
    return file->Mesh(attributes, {{"indices", file->Indices({0, 1, 2, 0, 2, 3})},
                                   {"material", file->root["materials"].size() - 1}});
}

// Adds an image of bytes, RGB a pixel, and returns its texture.
inline int Texture(GltfFile* file, const std::vector<std::array<int, 3>>& pixels, int width) {
    std::vector<Rgb> linear;
    for (const auto& p : pixels) {
        Rgb c;
        for (int i = 0; i < 3; ++i) c[i] = LinearFromSrgb(float(p[size_t(i)]) / 255);
        linear.push_back(c);
    }
    const std::vector<std::byte> png = EncodePng(linear, width, int(pixels.size()) / width);
    const int view = file->View(png);
    file->root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    file->root["textures"].push_back({{"source", file->root["images"].size() - 1}});
    return int(file->root["textures"].size()) - 1;
}

inline json Matte(double r, double g, double b) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

// Returns a black material that emits.
inline json Lamp() {
    json lamp = Matte(0, 0, 0);
    lamp["emissiveFactor"] = {1, 1, 1};
    return lamp;
}

// Adds a directional light from direction `d` that gives an irradiance of 1 at right angles.
inline void Sun(GltfFile* file, const Vec3f& d) {
    const auto q = Eigen::Quaternionf::FromTwoVectors(Vec3f::UnitZ(), d);
    file->Light({{"type", "directional"}, {"intensity", 683}},
                {{"rotation", {q.x(), q.y(), q.z(), q.w()}}});
}

}  // namespace lull::gltf_test
