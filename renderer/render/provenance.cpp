#include "renderer/render/provenance.h"

#include <filesystem>

namespace lull {

std::string SceneName(const std::string& file) {
    using std::filesystem::path;
    const path absolute = std::filesystem::absolute(file).lexically_normal();
    std::string name = absolute.stem().string();
    if (name == "scene" && absolute.has_parent_path() && absolute.parent_path().has_filename())
        name = absolute.parent_path().filename().string();
    for (char& c : name)
        if (c == ';' || c == '\n' || c == '\r') c = '_';
    return name.empty() ? "scene" : name;
}

std::string NameOf(SamplerKind kind) { return kind == SamplerKind::Random ? "random" : "sobol"; }

std::string NameOf(Estimator estimator) {
    return estimator == Estimator::Combined ? "combined" : "pbrt-v3";
}

std::string NameOf(TextureFiltering filtering) {
    return filtering == TextureFiltering::Bilinear ? "bilinear" : "pbrt-v3";
}

}  // namespace lull
