#include "renderer/commands/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "renderer/commands/aov_options.h"
#include "renderer/commands/command.h"
#include "renderer/commands/guide_options.h"
#include "renderer/commands/render_files.h"
#include "renderer/render/film_picture.h"
#include "stopping/rules/denoised.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

constexpr const char* kFooter =
    R"(Files, beside each other:
  OUT.exr             linear image, with the samples per pixel in channel "spp"
  OUT.png             the same image for displays, 8-bit sRGB
  OUT.spp.png         samples per pixel of each block in false colours
  OUT.thresholds.csv  samples per pixel at which each block stopped, row by row
  OUT.ranges.csv      between which samples per pixel people would have stopped each block, in 80 of
                      100 cases, where the model of the rule knows; also in the report

Examples:
  lull render scene.pbrt -o image.exr
  lull render scene.pbrt --stop lnoise:0.3 --cap 2000 --report report.html
  lull render scene.pbrt --spp 64 --resolution 400x300 --sampler sobol
  lull render scene.pbrt --checkpoint c.h5 --resume    # the same again after an interruption
  lull render scene.pbrt --checkpoint c.h5 --resume --keep-checkpoint --cap 20000    # and more
  lull render scene.pbrt --preview 60                  # with a picture to look at every minute
  lull render scene.pbrt --until 09:00                 # as clean as it gets until then
  mpirun -n 4 lull render scene.pbrt                   # on several machines, if built with MPI

With --time or --until, blocks stop as without; when that is not enough for all, the worst is as
good as it can be. Every pixel gets its first sample, even if that takes longer. How many samples
the others got depends on the machine: --stop thresholds:OUT.thresholds.csv repeats the image. A
checkpoint is kept, to go on from.

Ctrl-C ends the render early and writes what there is; twice, it ends at once.
Exit codes: 0 done, 1 the input or the environment is at fault, 2 wrong usage, 130 interrupted.)";

void AddDenoiserOptions(CLI::App& app, RenderRequest* o) {
    app.add_flag("--denoise", o->denoise,
                 "Take the noise out of the image, with blocks that stop when it is clean then;\n"
                 "the EXR has the means of the samples as noisy.R, .G, .B, and the estimated\n"
                 "standard error of each pixel in lightness as error");
    app.add_flag("--denoise-layers", o->denoiseLayers,
                 "Keep in the EXR what `lull denoise` needs to do so later");
}

void AddCheckpoints(CLI::App& app, CheckpointOptions* checkpoint) {
    AddCheckpointOptions(app, checkpoint);
    checkpoint->mayDiffer = MayDiffer::Stops;
    app.add_flag("--keep-checkpoint", checkpoint->isKept,
                 "Keep it when the render is done, too, to go on with a larger --cap, more\n"
                 "--caution or another rule")
        ->needs(app.get_option("--checkpoint"));
}

}  // namespace

std::string RenderRequest::Rule() const {
    if (spp > 0) return fmt::format("fixed:{}", spp);
    return stop.value_or(denoise ? kDenoisedRuleName : kDefaultRule);
}

void AddRenderOptions(CLI::App& app, RenderRequest* o) {
    AddRenderSettings(app, &o->render);
    app.add_option("-o,--output", o->output,
                   "Image to write, .exr or .png; both are written [named as in the scene]")
        ->check([](const std::string& file) {
            return HasImageExtension(file) ? "" : file + " ends neither in .exr nor in .png";
        })
        ->type_name("OUT.exr");
    auto* stop = app.add_option("--stop", o->stop,
                                "When blocks stop; see below [learned; with --denoise: denoised]")
                     ->type_name("RULE");
    AddCautionOption(app, &o->render.caution);
    app.add_option("--spp", o->spp, "Samples per pixel, the same for all: --stop fixed:N")
        ->check(CLI::Range(1, 1 << 24))
        ->type_name("N")
        ->excludes(stop);
    app.add_option("--report", o->report,
                   "Write what happened to each block: .html to look at, .json for programs")
        ->check([](const std::string& file) {
            const bool isKnown = file.ends_with(".html") || file.ends_with(".json");
            return isKnown ? "" : file + " ends neither in .html nor in .json";
        })
        ->type_name("R.html|R.json");
    AddDenoiserOptions(app, o);
    AddGuideOptions(app, &o->guide);
    AddAovOptions(app, &o->aovs);
    AddPictureOptions(app, &o->pictures);
    app.add_flag("--transparent", o->pictures.format.isTransparent,
                 "Leave out the background that the camera sees past everything: the PNG has\n"
                 "alpha, and the EXR colours multiplied by it with --aov alpha");
    AddPathOptions(app, &o->path);
    AddClockOptions(app, &o->clock);
    AddCheckpoints(app, &o->render.checkpoint);
    app.footer("Stopping rules (--stop); a block stops\n" + RuleHelp(100) + "\n" + kFooter);
}

void CheckRequest(const RenderRequest& request) {
    if (request.path.pixel && request.guide.mode != GuideMode::Off)
        throw UsageError(
            "--pixel: paths with a guide depend on all that it has learned, and are not printed; "
            "leave --guide out");
    // Where all samples belong to one half, nothing says how large their noise is.
    if (request.CollectsFeatures() && request.spp > 0 && request.spp < int(kLeastDenoisedSpp))
        throw UsageError(
            fmt::format("--spp {}: {} needs at least {}, to know what is noise", request.spp,
                        request.denoise ? "--denoise" : "--denoise-layers", kLeastDenoisedSpp));
}

}  // namespace lull
