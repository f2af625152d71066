#include "renderer/scene/integrator.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "stopping/base/input_file.h"

namespace lull {

std::string PathIntegrator::Text() const {
    return fmt::format("up to {} bounce{}; Russian roulette below a throughput of {:g}", maxDepth,
                       maxDepth == 1 ? "" : "s", rrThreshold);
}

std::string NameOf(const Integrator& integrator, bool isVolumetric) {
    return std::visit([&](const auto& kind) { return kind.Name(isVolumetric); }, integrator);
}

std::string TextOf(const Integrator& integrator) {
    return std::visit([](const auto& kind) { return kind.Text(); }, integrator);
}

int MaxDepth(const Integrator& integrator) {
    return std::visit([](const auto& kind) { return kind.maxDepth; }, integrator);
}

bool CanBeGuided(const Integrator& integrator) {
    return std::visit([](const auto& kind) { return kind.kCanBeGuided; }, integrator);
}

Integrator MakeIntegrator(const Entity& entity, int maxDepth, bool isVolumetric,
                          Warnings& warnings) {
    const Parameters& params = entity.parameters;
    // volpath is path where there is nothing else for it to see.
    const bool isKnown = entity.name == "path" || entity.name == "volpath";
    PathIntegrator path;
    if (!isKnown)
        warnings.Add(entity.loc, fmt::format("Integrator \"{}\" is rendered as \"{}\"",
                                             Printable(entity.name), path.Name(isVolumetric)));
    path.maxDepth = params.GetInt("maxdepth", path.maxDepth);
    path.rrThreshold = params.GetFloat("rrthreshold", path.rrThreshold);
    if (maxDepth >= 0) path.maxDepth = maxDepth;
    if (path.maxDepth < 0) throw Error(entity.loc, "\"maxdepth\" has to be at least 0");
    params.GetString("lightsamplestrategy", "");  // the light table reads it
    if (isKnown) params.ReportUnused("Integrator \"" + entity.name + "\"", warnings);
    return path;
}

}  // namespace lull
