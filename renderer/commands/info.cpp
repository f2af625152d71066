// `lull info`: says what is in a scene, as it would be rendered.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <map>

#include "renderer/base/seconds_since.h"
#include "renderer/commands/command.h"
#include "renderer/commands/scene_options.h"
#include "renderer/measure/report.h"
#include "renderer/render/progress.h"

namespace lull {

namespace {

using Counts = std::map<std::string, int>;

// Formats "3 (2 matte, 1 glass)".
std::string CountsText(const Counts& counts) {
    int total = 0;
    std::string kinds;
    for (const auto& [kind, count] : counts) {
        total += count;
        kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count, kind);
    }
    return kinds.empty() ? "0" : fmt::format("{} ({})", total, kinds);
}

template <typename Entities>
Counts CountKinds(const Entities& entities) {
    Counts counts;
    for (const Entity& entity : entities) ++counts[entity.name];
    return counts;
}

Counts CountShapes(const Description& description) {
    Counts counts;
    const auto count = [&](const std::vector<ShapeEntity>& shapes) {
        for (const ShapeEntity& shape : shapes) counts[shape.name] += 1 + int(shape.strands.size());
    };
    count(description.shapes);
    for (const ObjectEntity& object : description.objects) count(object.shapes);
    return counts;
}

std::string VectorText(const Vec3f& v) {
    return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}

void Line(const std::string& label, const std::string& text) {
    fmt::print("{:<12} {}\n", label, text);
}

void PrintGeometry(const Description& description, const Scene& scene) {
    const Bounds3f& bounds = scene.shapes.bounds;
    Line("shapes", CountsText(CountShapes(description)));
    Line("triangles", fmt::format("{}", scene.shapes.TriangleCount()));
    Line("instances", fmt::format("{} of {} objects", scene.shapes.instances.size(),
                                  scene.shapes.objects.size()));
    Line("bounds",
         bounds.IsEmpty() ? "none" : VectorText(bounds.lower) + " to " + VectorText(bounds.upper));
}

void PrintAppearance(const Description& description, const Scene& scene) {
    Line("materials", CountsText(CountKinds(description.materials)));
    Line("textures", CountsText(CountKinds(description.textures)));
    if (!description.media.empty()) Line("media", CountsText(CountKinds(description.media)));
    Counts lights = CountKinds(description.lights);
    const int area = scene.lights.Count() - int(description.lights.size());
    if (area > 0) lights["area (one a primitive)"] = area;
    Line("lights", CountsText(lights));
}

void PrintView(const Description& description, const Scene& scene) {
    const Vec3f position = scene.camera.worldFromCamera.topRightCorner<3, 1>().cast<float>();
    Line("camera",
         fmt::format("{} at {}{}", description.camera.name, VectorText(position),
                     scene.camera.lenses ? ""
                     : scene.camera.lensRadius > 0
                         ? fmt::format(", lens radius {:g}, focus at {:g}", scene.camera.lensRadius,
                                       scene.camera.focalDistance)
                         : ", pinhole"));
    const FilmSettings& film = scene.film;
    Line("film",
         fmt::format("{} x {}, crop [{}, {}) x [{}, {}), scale {:g}, file {}", film.resolution.x(),
                     film.resolution.y(), film.cropMin.x(), film.cropMax.x(), film.cropMin.y(),
                     film.cropMax.y(), film.scale, film.filename));
    Line("filter", description.filter.name);
    Line("sampler",
         fmt::format("{} as {}, {} samples per pixel in the file", description.sampler.name,
                     NameOf(scene.sampler), scene.samplesPerPixel));
    Line("integrator",
         fmt::format("{} as {}, maximum depth {}, roulette threshold {:g}",
                     description.integrator.name, scene.isVolumetric ? "volpath" : "path",
                     scene.maxDepth, scene.rrThreshold));
}

void PrintCosts(const Scene& scene, double parseSeconds) {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    Line("memory", fmt::format("{}B in all at the most, {}B of it images",
                               FormatCount(double(usage.ru_maxrss) * 1024),
                               FormatCount(double(scene.textures.Bytes()))));
    Line("load time",
         fmt::format("{} file, {} textures, {} shapes, {} acceleration structure",
                     FormatDuration(parseSeconds), FormatDuration(scene.textureSeconds),
                     FormatDuration(scene.shapeSeconds), FormatDuration(scene.acceleratorSeconds)));
}

ExitCode RunInfo(const SceneOptions& options) {
    Warnings warnings = MakePrintedWarnings();
    const auto start = std::chrono::steady_clock::now();
    const Description description = LoadDescription(options, warnings);
    const double parseSeconds = SecondsSince(start);
    const std::unique_ptr<const Scene> scene = Compile(description, options.compile, warnings);

    Line("scene", options.file);
    PrintGeometry(description, *scene);
    PrintAppearance(description, *scene);
    PrintView(description, *scene);
    PrintCosts(*scene, parseSeconds);
    Line("warnings", CountsText(warnings.Counts()));
    return kDone;
}

}  // namespace

void AddInfoCommand(CLI::App& app, Command* command) {
    CLI::App* info =
        app.add_subcommand("info", "Says what is in a scene, as it would be rendered.");
    auto options = std::make_shared<SceneOptions>();
    AddSceneOptions(*info, options.get());
    info->footer("Example: lull info scene.pbrt");
    info->callback([=] { *command = [=] { return RunInfo(*options); }; });
}

}  // namespace lull
