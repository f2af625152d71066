#include "renderer/commands/light_group_options.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/film/splat_plane.h"
#include "renderer/render/session.h"

namespace lull {

void AddLightGroupOption(CLI::App& app, std::vector<std::string>* names) {
    app.add_option(
           "--light-groups", *names,
           "Write the light of these lamps, objects, materials or kinds as layers; each: all")
        ->group("Output")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAME,...|each");
}

LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description& description,
                              const Scene& scene, LayerOptions layers, const PixelRect& region) {
    if (names.empty()) return {};
    LightGroups& groups = layers.groups;
    try {
        groups = MakeLightGroups(names, description, scene);
    } catch (const Error& e) {
        throw Error(std::string("--light-groups: ") + e.what());
    }
    const int64_t splats =
        IsBidirectional(scene.integrator) ? groups.Count() * int64_t(sizeof(SplatPixel)) : 0;
    CheckMemory(region.Area() * (BytesOfLayers(layers) + splats),
                fmt::format("{} light groups of {}x{} pixels", groups.Count(), region.Width(),
                            region.Height()),
                "name fewer, or render in parts with --crop");
    return groups;
}

}  // namespace lull
