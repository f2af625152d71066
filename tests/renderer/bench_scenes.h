// Lists the scenes that benchmarks run on.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "renderer/input/pbrt_parser.h"
#include "renderer/scene/scene.h"

namespace lull {

// Returns the files of LULL_BENCH_SCENES, separated by colons, or our own scenes by name.
inline std::vector<std::string> BenchScenes() {
    std::vector<std::string> files;
    if (const char* list = std::getenv("LULL_BENCH_SCENES")) {
        std::istringstream in(list);
        for (std::string file; std::getline(in, file, ':');) files.push_back(file);
        return files;
    }
    for (const auto& folder : std::filesystem::directory_iterator(LULL_SCENES_DIR))
        if (const auto file = folder.path() / "scene.pbrt"; std::filesystem::exists(file))
            files.push_back(file.string());
    std::sort(files.begin(), files.end());
    return files;
}

// Compiles one of them, with silent substitutes for missing files and features.
inline std::unique_ptr<const Scene> LoadScene(const std::string& file, const Vec2i& resolution) {
    Warnings warnings({}, true);
    CompileOptions options;
    options.film.resolution = resolution;
    return Compile(ParsePbrt(file, warnings), options, warnings);
}

}  // namespace lull
