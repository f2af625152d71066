#include "renderer/commands/path_printer.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "renderer/base/color.h"
#include "renderer/commands/command.h"
#include "renderer/scene/light_groups.h"

namespace lull {
namespace {

template <typename Triple>
std::string Numbers(const Triple& v) {
    return fmt::format("{:.5g} {:.5g} {:.5g}", v[0], v[1], v[2]);
}

std::string PlaceOf(const PathStep& step, const Description& description, const Scene& scene) {
    switch (step.kind) {
        case PathStep::Kind::Sky:
            return "leaves the scene towards " + Numbers(step.position);
        case PathStep::Kind::Medium:
            return fmt::format("in a medium at {}, after {:.5g}", Numbers(step.position),
                               step.distance);
        default:
            return fmt::format("on \"{}\" of \"{}\" at {}, normal {}, after {:.5g}",
                               NameOfObject(step.object, description, scene),
                               NameOfMaterial(step.material, description), Numbers(step.position),
                               Numbers(step.normal), step.distance);
    }
}

std::string WayOf(const PathStep& step) {
    if (!step.goesOn) return "";
    const std::string density = step.isSpecular
                                    ? std::string("as in a mirror or clear glass")
                                    : fmt::format("with density {:.5g} per sr", step.pdf);
    return fmt::format(
        "     continues {}towards {}, {}\n",
        step.isTransmission && step.kind == PathStep::Kind::Surface ? "through it " : "",
        Numbers(step.direction), density);
}

// Returns why there is no further step.
std::string EndOf(const PathLog& log, const Scene& scene) {
    if (log.steps.empty()) return "It meets nothing that shines or scatters.\n";
    const PathStep& last = log.steps.back();
    if (last.kind == PathStep::Kind::Sky) return "";
    if (const int maxDepth = MaxDepth(scene.integrator); int(log.steps.size()) > maxDepth)
        return fmt::format("It ends at the greatest depth, {} bounces.\n", maxDepth);
    return last.goesOn ? "Terminated by Russian roulette.\n"
                       : "It ends here: nothing is scattered.\n";
}

bool ParsePixel(const std::string& text, Vec2i* pixel) {
    const char* end = text.data() + text.size();
    const auto [comma, error] = std::from_chars(text.data(), end, pixel->x());
    if (error != std::errc() || comma == end || *comma != ',') return false;
    const auto [last, second] = std::from_chars(comma + 1, end, pixel->y());
    return second == std::errc() && last == end && pixel->minCoeff() >= 0;
}

}  // namespace

void AddPathOptions(CLI::App& app, PathOfSample* options) {
    auto* pixel =
        app.add_option_function<std::string>(
               "--pixel",
               [=](const std::string& text) {
                   Vec2i p;
                   if (!ParsePixel(text, &p))
                       throw CLI::ValidationError(text, "is not x,y in pixels");
                   options->pixel = p;
               },
               "Print one path through this pixel, vertex by vertex, instead of rendering")
            ->group("Advanced")
            ->type_name("x,y");
    app.add_option("--sample", options->sample, "Choose the sample of --pixel, from 0")
        ->group("Advanced")
        ->needs(pixel)
        ->check(Between(0, (1 << 24) - 1))
        ->type_name("K")
        ->capture_default_str();
}

void PrintPath(const PathOfSample& wanted, const RenderSettings& settings,
               const Description& description, const Scene& scene) {
    const Vec2i pixel = *wanted.pixel, size = scene.film.resolution;
    if (pixel.x() >= size.x() || pixel.y() >= size.y())
        throw UsageError(fmt::format("--pixel {},{}: the image is {}x{}", pixel.x(), pixel.y(),
                                     size.x(), size.y()));
    if (!std::holds_alternative<PathIntegrator>(scene.integrator))
        throw UsageError(
            fmt::format("--pixel: a sample of \"{}\" is more than one path; add --integrator path",
                        NameOf(scene.integrator, scene.isVolumetric)));
    const SamplerKind kind = settings.sampler.value();
    Sampler sampler(kind, settings.seed);
    const PathLog log =
        LogSample(scene, settings.estimator, sampler, pixel, uint32_t(wanted.sample));

    fmt::print("Sample {} of pixel {},{} (sampler {}, seed {}, estimator {})\n", wanted.sample,
               pixel.x(), pixel.y(), NameOf(kind), settings.seed, NameOf(settings.estimator));
    fmt::print("  0  camera at {}, looks along {}\n", Numbers(log.ray.o),
               Numbers(log.ray.d.normalized()));
    int number = 0;
    for (const PathStep& step : log.steps) {
        fmt::print("{:3}  {}\n", ++number, PlaceOf(step, description, scene));
        if (number > 1) fmt::print("     light from here counts {}\n", Numbers(step.throughput));
        if (!IsBlack(step.emitted)) fmt::print("     it shines:     + {}\n", Numbers(step.emitted));
        if (!IsBlack(step.direct)) fmt::print("     lights bring:  + {}\n", Numbers(step.direct));
        fmt::print("{}", WayOf(step));
    }
    fmt::print("{}", EndOf(log, scene));
    const float factor = log.filterWeight * log.cameraWeight * log.filmScale;
    fmt::print("Radiance {}, luminance {:.5g}", Numbers(log.sample.radiance),
               Luminance(log.sample.radiance));
    if (factor != 1) fmt::print(", with a factor of {:.5g} by filter, lens and exposure", factor);
    fmt::print("{}\n", log.sample.rejected ? "; it was rejected: not finite, or negative" : "");
}

}  // namespace lull
