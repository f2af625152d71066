// Compiles the scenes that tests write down.
#pragma once

#include <memory>
#include <string>

#include "renderer/base/math.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/scene/scene.h"
#include "tests/renderer/files/test_files.h"

namespace lull {

// Returns the text of a pbrt-v3 file: the directives before the world, and the world.
inline std::string WorldText(const std::string& world, const std::string& before = "") {
    return before + "\nWorldBegin\n" + world + "\nWorldEnd\n";
}

// Returns two triangles between four points.
inline std::string Quad(const std::string& points) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [" + points +
           "]\n";
}

// A part of a scene's text, and the name of the test with it.
struct NamedText {
    std::string name, text;
};
inline constexpr auto kByName = [](const auto& info) { return std::string(info.param.name); };

// Compiles the scene of a pbrt-v3 file. Without `warnings` nobody hears of them: many scenes of
// tests have no lights, or are of odd sizes. Throws Error.
inline std::unique_ptr<const Scene> SceneIn(const std::string& file,
                                            const CompileOptions& options = {},
                                            Warnings* warnings = nullptr) {
    Warnings own;
    Warnings& all = warnings ? *warnings : own;
    return Compile(ParsePbrt(file, all), options, all);
}

// Does the same with a file of that text, test.pbrt, on one thread.
inline std::unique_ptr<const Scene> SceneOf(const std::string& text, CompileOptions options = {},
                                            Warnings* warnings = nullptr) {
    options.threads = 1;
    return SceneIn(TemporaryDirectory().Write("test.pbrt", text), options, warnings);
}

// Returns the warnings of a text, by kind.
inline std::map<std::string, int> WarningsOf(const std::string& text) {
    Warnings warnings;
    SceneOf(text, {}, &warnings);
    return warnings.Counts();
}

// Returns the pixels that a render of the scene has.
inline PixelRect RegionOf(const Scene& scene) { return {scene.film.cropMin, scene.film.cropMax}; }

}  // namespace lull
