// `lull info`: describes a scene as it would be rendered.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <map>

#include "renderer/base/clocks.h"
#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/files/file_io.h"
#include "renderer/progress/progress.h"
#include "renderer/results/report.h"
#include "renderer/scene/light_groups.h"
#include "renderer/scene/scene.h"

namespace lull::info {

namespace {

using Counts = std::map<std::string, int>;

std::string CountsText(const Counts& counts) {
    int total = 0;
    std::string kinds;
    for (const auto& [kind, count] : counts) {
        total += count;
        kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count, kind);
    }
    return kinds.empty() ? "0" : fmt::format("{} ({})", total, kinds);
}

std::string VariantsText(const std::vector<std::string>& variants) {
    std::string text;
    for (size_t i = 0; i < variants.size(); ++i)
        text += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, Printable(variants[i]));
    return text + "; --variant NAME|N chooses";
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

std::string Number(int64_t count, const std::string& what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void Line(const std::string& label, const std::string& text) {
    fmt::print("{:<12} {}\n", label, text);
}

void PrintGeometry(const Description& description, const Scene& scene) {
    const Bounds3f& bounds = scene.shapes.bounds;
    Line("shapes", CountsText(CountShapes(description)));
    Line("triangles", fmt::format("{}", scene.shapes.TriangleCount()));
    if (const size_t copies = scene.shapes.instances.size(); copies > 0)
        Line("instances", fmt::format("{} of {}", copies,
                                      Number(int64_t(scene.shapes.objects.size()), "object")));
    Line("bounds",
         bounds.IsEmpty() ? "none" : VectorText(bounds.lower) + " to " + VectorText(bounds.upper));
}

void PrintAppearance(const Description& description, const Scene& scene) {
    Line("materials", CountsText(CountKinds(description.materials)));
    Line("textures", CountsText(CountKinds(description.textures)));
    if (!description.variants.empty()) Line("variants", VariantsText(description.variants));
    if (!description.media.empty()) Line("media", CountsText(CountKinds(description.media)));
    Counts lights = CountKinds(description.lights);
    const int area = scene.lights.Count() - int(description.lights.size());
    if (area > 0) lights[area == 1 ? "emitting shape" : "emitting shapes or triangles"] = area;
    Line("lights", CountsText(lights));
}

std::vector<std::string> NamesOfSlabs(const Description& description, const Scene& scene) {
    std::vector<std::string> names;
    size_t index = 0;
    const auto add = [&](const ShapeEntity& entity) {
        const Shape& shape = scene.shapes.shapes[index++];
        const Mesh* mesh = std::get_if<Mesh>(&shape.geometry);
        if (!mesh || entity.material < 0) return;
        const Parameters& parameters = description.materials[size_t(entity.material)].parameters;
        if (!parameters.GetBool("solid", false) ||
            parameters.GetFloat("transmissionfactor", 0) <= 0)
            return;
        if (CountSlabs(*mesh) == 0) return;
        const std::string name = GivenName(entity);
        names.push_back(name.empty() ? NameOfMaterial(uint32_t(entity.material) + 1, description)
                                     : name);
    };
    for (const ShapeEntity& entity : description.shapes) add(entity);
    for (const ObjectEntity& object : description.objects)
        for (const ShapeEntity& entity : object.shapes) add(entity);
    return names;
}

void PrintSlabs(const Description& description, const Scene& scene) {
    constexpr size_t kMostListed = 3;
    const std::vector<std::string> names = NamesOfSlabs(description, scene);
    if (names.empty()) return;
    std::string text;
    for (size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
        text += (i > 0 ? ", \"" : "\"") + Printable(names[i]) + "\"";
    if (names.size() > kMostListed) text += fmt::format(" and {} more", names.size() - kMostListed);
    Line("hint", text +
                     ": flat slabs of solid glass, which light sampling does not pass; without "
                     "KHR_materials_volume they are sheets, which it does pass");
}

std::string FilmText(const FilmSettings& film, const std::string& file) {
    std::string text = fmt::format("{} x {} pixels", film.resolution.x(), film.resolution.y());
    if ((film.cropMin != Vec2i(0, 0)) || (film.cropMax != film.resolution))
        text += fmt::format(", of them columns {} to {} and rows {} to {}", film.cropMin.x(),
                            film.cropMax.x() - 1, film.cropMin.y(), film.cropMax.y() - 1);
    if (film.scale != 1) text += fmt::format(", values times {:g}", film.scale);
    return text + ", image " + DefaultOutput(film.filename, file);
}

std::string UsedText(const std::string& used, const Entity& asked) {
    if (!asked.loc.file || asked.name == used) return used;
    return fmt::format("{} ({} in the file)", used, asked.name);
}

void PrintView(const Description& description, const Scene& scene, const std::string& file) {
    const Vec3f position = scene.camera.worldFromCamera.topRightCorner<3, 1>().cast<float>();
    Line("camera",
         fmt::format("{} at {}{}", description.camera.name, VectorText(position),
                     scene.camera.lenses ? ""
                     : scene.camera.lensRadius > 0
                         ? fmt::format(", lens radius {:g}, focus at {:g}", scene.camera.lensRadius,
                                       scene.camera.focalDistance)
                         : ", pinhole"));
    Line("film", FilmText(scene.film, file));
    Line("filter", description.filter.name);
    Line("sampler",
         UsedText(NameOf(DefaultSampler(Estimator::Combined, scene)), description.sampler));
    if (description.sampler.loc.file)
        Line("samples", fmt::format("{} per pixel in the file; without --spp each block stops by "
                                    "itself",
                                    scene.samplesPerPixel));
    Line("paths",
         fmt::format("{}, {}",
                     UsedText(NameOf(scene.integrator, scene.isVolumetric), description.integrator),
                     TextOf(scene.integrator)));
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
    Warnings warnings = MakePrintedWarnings(options);
    const auto start = std::chrono::steady_clock::now();
    const Description description = LoadDescription(options, warnings);
    const double parseSeconds = SecondsSince(start);
    const std::unique_ptr<const Scene> scene = Compile(description, options.compile, warnings);
    warnings.Summarize();

    Line("scene", options.file);
    PrintGeometry(description, *scene);
    PrintAppearance(description, *scene);
    PrintSlabs(description, *scene);
    PrintView(description, *scene, options.file);
    PrintCosts(*scene, parseSeconds);
    Line("warnings", CountsText(warnings.Counts()));
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* info = app.add_subcommand("info", "Describes a scene as it would be rendered.");
    auto options = std::make_shared<SceneOptions>();
    AddSceneOptions(*info, options.get());
    info->footer("Example: lull info scene.pbrt");
    info->callback([=] { *command = [=] { return RunInfo(*options); }; });
}

}  // namespace lull::info
