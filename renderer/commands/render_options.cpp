#include "renderer/commands/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "renderer/commands/command.h"
#include "renderer/commands/output_options.h"
#include "renderer/commands/render_files.h"
#include "renderer/render/film_picture.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"

namespace lull::render {

namespace {

constexpr const char* kFooter =
    R"(Files, in one folder:
  OUT.exr             linear image, with the samples per pixel in channel "spp"
  OUT.png             the same image for displays, 8-bit sRGB
  OUT.spp.png         samples per pixel of each block in false colours
  OUT.thresholds.csv  samples per pixel at which each block stopped, row by row

Examples:
  lull render scene.pbrt -o image.exr
  lull render scene.pbrt --stop lnoise:0.3 --cap 2000 --report report.html
  lull render scene.pbrt --spp 64 --resolution 400x300
  lull render scene.pbrt --checkpoint c.h5 --resume    # the same again after an interruption
  lull render scene.pbrt --checkpoint c.h5 --resume --keep-checkpoint --cap 20000    # and more
  lull render scene.pbrt --preview 60                  # writes the current image every minute
  lull render scene.pbrt --until 09:00                 # ends then, noisiest blocks first
  mpirun -n 4 lull render scene.pbrt                   # on several machines, if built with MPI

With --time or --until, the noisiest blocks are sampled first. Every pixel gets one sample, even past
the deadline. The sample counts depend on the machine; --stop thresholds:OUT.thresholds.csv repeats
the image. A file of --checkpoint is kept.

Ctrl-C ends the render and writes the current image; a second Ctrl-C ends it at once.
Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

void AddDenoiserOptions(CLI::App& app, RenderRequest* o) {
    app.add_flag("--denoise", o->denoise,
                 "Denoise, and stop blocks once the denoised image is clean")
        ->group(kCommonOptions);
    app.add_flag("--denoise-layers", o->denoiseLayers, "Write the AOVs that `lull denoise` needs")
        ->group("Denoising");
}

void AddCheckpoints(CLI::App& app, CheckpointOptions* checkpoint) {
    AddCheckpointOptions(app, checkpoint);
    checkpoint->mayDiffer = MayDiffer::Stops;
    app.add_flag("--keep-checkpoint", checkpoint->isKept,
                 "Keep the checkpoint at the end, for a larger --cap or another rule")
        ->group("Interruption")
        ->needs(app.get_option("--checkpoint"));
}

}  // namespace

std::string RenderRequest::Rule() const {
    if (spp > 0) return fmt::format("fixed:{}", spp);
    return stop.value_or(denoise ? kDenoisedRuleName : kDefaultRule);
}

std::vector<Grade> RenderRequest::Grades() const {
    std::vector<Grade> grades = {pictures.format.grade};
    if (gradedBy != 0) {
        grades.push_back(grades.front());
        grades.back().exposure += gradedBy;
    }
    return std::ranges::all_of(grades, &Grade::IsPlain) ? std::vector<Grade>() : grades;
}

void AddRenderOptions(CLI::App& app, RenderRequest* o) {
    AddRenderSettings(app, &o->render);
    app.add_option("-o,--output", o->output, "Write OUT.exr and OUT.png [the name in the scene]")
        ->group(kCommonOptions)
        ->check([](const std::string& file) {
            return HasImageExtension(file) ? "" : file + " ends neither in .exr nor in .png";
        })
        ->type_name("OUT.exr");
    auto* stop =
        app.add_option("--stop", o->stop,
                       "Choose the stopping rule, listed below [learned; --denoise: denoised]")
            ->group(kCommonOptions)
            ->type_name("RULE");
    AddCautionOption(app, &o->render.caution)->group(kCommonOptions);
    app.add_option("--graded-by", o->gradedBy,
                   "Judge the image brightened by EV stops as well; the noisier counts")
        ->group("Stopping")
        ->check(Between(-100.f, 100.f))
        ->type_name("EV")
        ->capture_default_str();
    app.add_option("--spp", o->spp, "Render all blocks with N spp, as --stop fixed:N")
        ->group(kCommonOptions)
        ->check(Between(1, 1 << 24))
        ->type_name("N")
        ->excludes(stop);
    app.add_option("--report", o->report, "Write every decision, as a page or as JSON")
        ->group(kCommonOptions)
        ->check([](const std::string& file) {
            const bool isKnown = file.ends_with(".html") || file.ends_with(".json");
            return isKnown ? "" : file + " ends neither in .html nor in .json";
        })
        ->type_name("R.html|R.json");
    AddDenoiserOptions(app, o);
    AddAovOptions(app, &o->aovs);
    AddLightGroupOption(app, &o->lightGroups);
    AddPictureOptions(app, &o->pictures);
    app.add_flag("--transparent", o->pictures.format.isTransparent,
                 "Remove the directly visible background; the PNG gets alpha")
        ->group("Image");
    AddPathOptions(app, &o->path);
    AddClockOptions(app, &o->clock);
    AddSequenceOptions(app, &o->sequence);
    AddCheckpoints(app, &o->render.checkpoint);
    app.footer("Stopping rules (--stop); a block stops\n" + RuleHelp(100) + "\n" + kFooter);
}

void CheckRequest(const RenderRequest& request) {
    const GltfOptions& view = request.render.scene.view;
    if (!view.frame && !request.sequence && (!view.animation.empty() || view.shutter > 0))
        throw UsageError("--animation and --shutter need --frame or --frames");
    if (request.sequence && request.path.pixel)
        throw UsageError("--pixel: a path is of one image; choose it with --frame");
    if (request.sequence && !request.clock.until.empty())
        throw UsageError("--until: it is one moment for all frames; --time holds for each");
    // Where all samples belong to one half, nothing says how large their noise is.
    const int cap = request.render.cap.value_or(int(kLeastDenoisedSpp));
    const int fixed = FixedSpp(request.Rule());
    const bool isFixed = fixed > 0 && fixed <= cap;
    if (const int spp = isFixed ? fixed : cap;
        request.denoiseLayers && spp < int(kLeastDenoisedSpp))
        throw UsageError(fmt::format(
            "--{}{}: --denoise-layers needs at least {}, to estimate the noise",
            isFixed ? (request.spp > 0 ? "spp " : "stop fixed:") : "cap ", spp, kLeastDenoisedSpp));
}

}  // namespace lull::render
