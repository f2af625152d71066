// `lull selftest`: renders three small scenes whose radiance is known, to check a build on the
// user's own machine.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/render/film_picture.h"
#include "renderer/render/render.h"
#include "stopping/rules/rule_table.h"

namespace lull::selftest {

namespace {

// All light comes from inside a closed sphere that emits 1 and reflects one half: 1 + 1/2 + ...
constexpr const char* kFurnace =
    "Integrator \"path\" \"integer maxdepth\" 100\n"
    "LookAt 0 0 0  0 0 1  0 1 0\n"
    "WorldBegin\n"
    "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
    "ReverseOrientation\n"
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
    "Shape \"sphere\"\n"
    "WorldEnd\n";

// A point of intensity pi, 1 above a plane that reflects one half: pi * .5 / pi.
constexpr const char* kPoint =
    "LookAt .01 0 2  0 0 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" .1\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [3.1415927 3.1415927 3.1415927] \"point from\" [0 0 1]\n"
    "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
    "Shape \"disk\" \"float radius\" 9\n"
    "WorldEnd\n";

struct Outcome {
    double mean = 0;         // of green
    double difference = -1;  // upper bound of the visible difference when denoised; -1: not asked
    int spp = 0;
};

std::unique_ptr<const Scene> SceneOf(const std::string& text) {
    const std::unique_ptr<FILE, int (*)(FILE*)> file(std::tmpfile(), std::fclose);
    if (!file || std::fputs(text.c_str(), file.get()) < 0 || std::fflush(file.get()) != 0)
        throw Error("cannot write a temporary file");
    CompileOptions options;
    options.film.resolution = Vec2i(60, 60);
    Warnings warnings;
    const auto scene = ParsePbrt(fmt::format("/proc/self/fd/{}", fileno(file.get())), warnings);
    return Compile(scene, options, warnings);
}

Outcome RenderBlock(const std::string& text, const std::string& rule, bool denoise) {
    const std::unique_ptr<const Scene> scene = SceneOf(text);
    const PixelRect region{scene->film.cropMin, scene->film.cropMax};
    const auto parsed =
        std::make_shared<const Rule>(ParseRule(rule, {.blockCount = 1, .models = ModelFolder()}));
    RenderOptions options;
    options.sampler = Sampler(SamplerKind::SobolHalves, 0);
    options.makeCriterion = [&](const BlockInfo& block) { return MakeCriterion(parsed, block); };
    Film film(region, {.grid = GridOf(options.schedule), .layers = {.features = denoise}});
    options.source = SamplesOf(*scene, Estimator::Combined);
    options.film = &film;
    const RenderResult result = Render(options);
    Outcome outcome{.spp = result.blocks[0].block.spp};
    std::vector<float> rgb = film.MeanImage();
    if (denoise) {
        const DenoisedImage clean = RunDenoiser(PictureOf(film, region), {&region, 1});
        rgb = clean.image.values;
        outcome.difference = clean.blocks[0]->upper;
    }
    for (size_t i = 1; i < rgb.size(); i += 3)
        outcome.mean += double(rgb[i]) * 3 / double(rgb.size());
    return outcome;
}

bool Check(const char* name, double answer, double tolerance, double ours) {
    const bool passed = std::abs(ours - answer) <= tolerance;
    fmt::print("{:<6} {:<56} {:>6} {:>6}  {:.6g}\n", passed ? "ok" : "FAILED", name, answer,
               tolerance, ours);
    return passed;
}

ExitCode RunSelftest() {
    fmt::print("{:<63} {:>6} {:>6}  {}\n", "", "answer", "+-", "ours");
    const Outcome furnace = RenderBlock(kFurnace, "fixed:64", false);
    const Outcome point = RenderBlock(kPoint, "fixed:4", false);
    const Outcome clean = RenderBlock(kFurnace, "learned", true);
    const bool passed[] = {
        Check("radiance in a closed sphere that emits and reflects", 2, 0.01, furnace.mean),
        Check("radiance of a plane under a point light", 0.5, 0.001, point.mean),
        Check("the same sphere by the rule learned, denoised", 2, 0.01, clean.mean),
        Check("upper bound of its visible difference", 0, 3.1, clean.difference),
        Check("spp at which the rule stops", 400, 380, clean.spp)};
    const auto failed = std::ranges::count(passed, false);
    if (failed > 0)
        throw Error(
            "{} of {} checks failed: this build renders wrong images; build it again, with another "
            "compiler or LULL_ARCH=",
            failed, std::size(passed));
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* selftest = app.add_subcommand("selftest", "Checks this build against known answers.");
    selftest->footer("Exit code 1 if a check fails.\nExample: lull selftest");
    selftest->callback([=] { *command = [] { return RunSelftest(); }; });
}

}  // namespace lull::selftest
