#include "renderer/scene/integrator.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "stopping/base/input_file.h"

namespace lull {

namespace {

// Between mirrors that reflect all light, and in closed white rooms, Russian roulette ends no path.
constexpr int kMostBounces = 100'000;

template <typename Kind>
Kind ReadDepth(const Entity& entity, int maxDepth) {
    Kind kind;
    kind.maxDepth = entity.parameters.GetInt("maxdepth", kind.maxDepth);
    kind.rrThreshold = entity.parameters.GetFloat("rrthreshold", kind.rrThreshold);
    if (maxDepth >= 0) kind.maxDepth = maxDepth;
    if (kind.maxDepth < 0) throw Error(entity.loc, "\"maxdepth\" has to be at least 0");
    entity.parameters.GetString("lightsamplestrategy", "");  // the light table reads it
    return kind;
}

template <typename... Kinds>
std::vector<std::string> NamesOfKinds(const std::variant<Kinds...>&) {
    return {Kinds::Name(false)...};
}

bool AsksForBdpt(const std::string& name) {
    return name == BdptIntegrator::Name(false) || name == "mlt" || name == "sppm";
}

}  // namespace

std::vector<std::string> IntegratorNames() { return NamesOfKinds(Integrator()); }

std::string NameOf(const Integrator& integrator, bool isVolumetric) {
    return std::visit([&](const auto& kind) { return kind.Name(isVolumetric); }, integrator);
}

std::string TextOf(const Integrator& integrator) {
    const int depth = MaxDepth(integrator);
    return fmt::format("up to {} bounce{}; Russian roulette below a throughput of {:g}", depth,
                       depth == 1 ? "" : "s",
                       std::visit([](const auto& kind) { return kind.rrThreshold; }, integrator));
}

int MaxDepth(const Integrator& integrator) {
    return std::visit([](const auto& kind) { return kind.maxDepth; }, integrator);
}

Integrator MakeIntegrator(const Entity& entity, int maxDepth, bool isVolumetric,
                          const char* beyondBdpt, Warnings& warnings) {
    const auto warn = [&](const char* name, const std::string& why) {
        warnings.Add(entity.loc, fmt::format("Integrator \"{}\" is rendered as \"{}\"{}",
                                             Printable(entity.name), name, why));
    };
    const auto limit = [&](const char* name, int most, int* depth) {
        if (*depth > most)
            warnings.Add(entity.loc,
                         fmt::format("paths of \"{}\" have {} bounces at most", name, most));
        *depth = std::min(*depth, most);
    };
    const auto reportUnused = [&] {
        entity.parameters.ReportUnused("Integrator \"" + entity.name + "\"", warnings);
    };
    if (AsksForBdpt(entity.name) && !beyondBdpt) {
        auto bdpt = ReadDepth<BdptIntegrator>(entity, maxDepth);
        limit("bdpt", BdptIntegrator::kMostBounces, &bdpt.maxDepth);
        if (entity.name != BdptIntegrator::Name(isVolumetric)) {
            warn(BdptIntegrator::Name(isVolumetric), "");
            return bdpt;
        }
        // Of pbrt-v3's pictures of single strategies there are none.
        for (const char* name : {"visualizestrategies", "visualizeweights"})
            if (entity.parameters.GetBool(name, false))
                warnings.Add(entity.loc, fmt::format("\"{}\" has no effect", name));
        reportUnused();
        return bdpt;
    }
    auto path = ReadDepth<PathIntegrator>(entity, maxDepth);
    limit(path.Name(isVolumetric), kMostBounces, &path.maxDepth);
    // volpath is path where there is nothing else for it to see.
    if (entity.name == "path" || entity.name == "volpath")
        reportUnused();
    else
        warn(path.Name(isVolumetric),
             AsksForBdpt(entity.name) ? fmt::format(", as {}", beyondBdpt) : "");
    return path;
}

}  // namespace lull
