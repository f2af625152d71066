#include "renderer/commands/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/commands/command.h"
#include "renderer/image/image_io.h"
#include "renderer/progress/forecast.h"
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
  lull render scene.pbrt --stop lnoise:0.3 --max-spp 2000 --report report.html
  lull render scene.pbrt --spp 64 --resolution 400x300
  lull render scene.pbrt --checkpoint c.h5 --resume    # the same again after an interruption
  lull render scene.pbrt --checkpoint c.h5 --resume --keep-checkpoint --max-spp 20000
  lull render scene.pbrt --preview 60                  # writes the current image every minute
  lull render scene.pbrt --until 09:00                 # ends then, noisiest blocks first
  mpirun -n 4 lull render scene.pbrt                   # on several machines, if built with MPI

With --time or --until, the noisiest blocks are sampled first. Every pixel gets one sample, even past
the deadline. The sample counts depend on the machine; --stop thresholds:OUT.thresholds.csv repeats
the image. A file of --checkpoint is kept.

Ctrl-C ends the render and writes the current image; a second Ctrl-C ends it at once.
Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

template <typename Parse>
CLI::Validator CheckBy(const Parse& parse) {
    const auto problem = [=](const std::string& text) -> std::string {
        try {
            parse(text);
            return "";
        } catch (const std::exception& e) {
            return e.what();
        }
    };
    return CLI::Validator(problem, "");
}

bool ParsePixel(const std::string& text, std::optional<Vec2i>* pixel) {
    std::array<int, 2> p;
    if (!ParseNumbers(text, ',', &p) || p[0] < 0 || p[1] < 0) return false;
    *pixel = Vec2i(p[0], p[1]);
    return true;
}

// Reads FROM:TO:FPS.
bool ParseSequence(const std::string& text, std::optional<Sequence>* sequence) {
    constexpr double kMostFrames = 99999;
    const std::string_view numbers(text.data(), text.size() - (text.ends_with("fps") ? 3 : 0));
    std::array<double, 3> parts;
    if (!ParseNumbers(numbers, ':', &parts)) return false;
    const auto [from, to, fps] = parts;
    *sequence = {from, to, fps};
    return 0 <= from && from <= to && to <= 1e9 && 0 < fps &&
           (to - from) * fps <= kMostFrames;  // false for NaN, too
}

void AddLayerOptions(CLI::App& app, RenderRequest* o) {
    const auto readAovs = [=](const std::vector<std::string>& names) {
        try {
            const bool throughSpecular = o->aovs.throughSpecular;
            o->aovs = ParseAovs(names);
            o->aovs.throughSpecular = throughSpecular;
        } catch (const Error& e) {
            throw CLI::ValidationError("--aov", e.what());
        }
    };
    auto* aov = app.add_option_function<std::vector<std::string>>(
                       "--aov", readAovs, "Write these AOVs of the first hits to the EXR")
                    ->group("Output")
                    ->delimiter(',')
                    ->allow_extra_args(false)
                    ->type_name(AllAovs("|") + ",...");
    AddOption(app, "Output", "--aov-through-specular", &o->aovs.throughSpecular,
              "Take AOVs from the reflected or refracted surface, not from mirrors and glass")
        ->needs(aov);
    AddOption(app, "Output", "--light-groups", &o->lightGroups,
              "Write the light of these lamps, objects, materials or kinds as layers; each: all",
              "NAME,...|each")
        ->delimiter(',')
        ->allow_extra_args(false);
}

void AddPictureOptions(CLI::App& app, RenderRequest* o) {
    AddChoiceOption(app, "--tone-map", &o->pictures.grade.toneMap,
                    "Map the tones of the PNG; filmic keeps highlights up to 5.6 times white")
        ->group("Image");
    CLI::Option* toneMap = app.get_option("--tone-map");
    AddOption(app, "Image", "--ocio", &o->ocio,
              "Map the PNG by a view of this OpenColorIO configuration [with --view: $OCIO]",
              "CONFIG.ocio")
        ->excludes(toneMap);
    AddOption(app, "Image", "--view", &o->view,
              "Choose OpenColorIO's view [that of the configuration]", "NAME")
        ->excludes(toneMap);
    AddOption(app, "Image", "--view-exposure", &o->pictures.grade.exposure,
              "Brighten the PNG by EV stops, and judge noise in it as it is shown", "EV",
              Between(-100.f, 100.f));
    AddOption(app, "Output", "--png-bits", &o->pictures.pngBits,
              "Set the bits per channel of the PNG", "8|16", OneOf(std::set{8, 16}));
    AddOption(app, "Output", "--exr-half", &o->pictures.exrHalf,
              "Write colours and normals of the EXR with 16 bits, up to 65504");
    AddOption(app, "Output", "--display", &o->display,
              "Show the render live in tev at this address", "HOST:PORT")
        ->check(CheckBy(ParseDisplayAddress));
    AddOption(app, "Output", "--preview", &o->preview, "Write the current image every SECONDS",
              "SECONDS", Between(0.1, 1e6));
    AddOption(app, "Image", "--transparent", &o->pictures.isTransparent,
              "Remove the directly visible background; the PNG gets alpha");
}

void AddWorkOptions(CLI::App& app, RenderRequest* o) {
    auto* pixel = AddOption(
        app, "Advanced", "--pixel", ParsePixel, &o->pixel, "x,y in pixels",
        "Print one path through this pixel, vertex by vertex, instead of rendering", "x,y");
    AddOption(app, "Advanced", "--sample", &o->sample, "Choose the sample of --pixel, from 0", "K",
              Between(0, (1 << 24) - 1))
        ->needs(pixel);
    auto* time = AddOption(app, kCommonOptions, "--time", &o->time,
                           "End after this wall-clock time, e.g. 90s, 10m or 1h30m", "TIME",
                           CheckBy(ParseDuration));
    AddOption(app, "Interruption", "--until", &o->until, "End at this local time", "HH:MM",
              CheckBy([](const std::string& text) { NextTimeOfDay(text, 0); }))
        ->excludes(time);
    CLI::Option* frame = app.get_option("--frame");
    auto* frames =
        AddOption(app, "Scene", "--frames", ParseSequence, &o->sequence,
                  "FROM:TO:FPS such as 0:2:24fps, with 0 <= FROM <= TO and at most 99999 frames",
                  "glTF: render the frames from FROM to TO seconds, as OUT.0001.exr, ...",
                  "FROM:TO:FPS")
            ->excludes(frame);
    AddOption(app, "Scene", "--same-seed", &o->sameSeed,
              "Render all frames with --seed S; else OUT.000n.exr has the seed S + n")
        ->needs(frames);
    // --frames satisfies these as well.
    for (const char* name : {"--animation", "--shutter"}) app.get_option(name)->remove_needs(frame);
    CheckpointOptions* checkpoint = &o->render.checkpoint;
    AddCheckpointOptions(app, checkpoint);
    checkpoint->mayDiffer = MayDiffer::Stops;
    AddOption(app, "Interruption", "--keep-checkpoint", &checkpoint->isKept,
              "Keep the checkpoint at the end, for a larger --max-spp or another rule")
        ->needs(app.get_option("--checkpoint"));
}

}  // namespace

int Sequence::Count() const {
    // 2 s at 24 fps are 48 frames, though 1/24 is not exact.
    return std::max(1, int(std::ceil((to - from) * fps - 1e-6)));
}

std::string RenderRequest::Rule() const {
    if (spp) return fmt::format("fixed:{}", *spp);
    return stop.value_or(denoise ? kDenoisedRuleName : kDefaultRule);
}

std::vector<Grade> RenderRequest::Grades() const {
    std::vector<Grade> grades = {pictures.grade};
    if (gradedBy != 0) {
        grades.push_back(grades.front());
        grades.back().exposure += gradedBy;
    }
    return std::ranges::all_of(grades, &Grade::IsPlain) ? std::vector<Grade>() : grades;
}

std::string RenderRequest::ClockText() const {
    return !time.empty() ? time : !until.empty() ? "until " + until : "";
}

void AddRenderOptions(CLI::App& app, RenderRequest* o) {
    AddRenderSettings(app, &o->render);
    AddOption(app, kCommonOptions, "-o,--output", &o->output,
              "Write OUT.exr and OUT.png [the name in the scene]", "OUT.exr")
        ->check([](const std::string& file) {
            const std::filesystem::path end = std::filesystem::path(file).extension();
            return end == ".exr" || end == ".png" ? "" : file + " ends neither in .exr nor in .png";
        });
    auto* stop =
        AddOption(app, kCommonOptions, "--stop", &o->stop,
                  "Choose the stopping rule, listed below [learned; --denoise: denoised]", "RULE");
    AddCautionOptions(app, kCommonOptions, &o->render.caution);
    AddOption(
        app, "Stopping", "--importance", &o->importance,
        "Multiply the caution of a block by 1 + the largest value, 0 to 1, of this image in it, or "
        "by X where this object or material is seen",
        "MASK.png|NAME=X");
    AddOption(app, "Stopping", "--graded-by", &o->gradedBy,
              "Judge the image brightened by EV stops as well; the noisier counts", "EV",
              Between(-100.f, 100.f));
    AddOption(app, kCommonOptions, "--spp", &o->spp,
              "Render all blocks with N spp, as --stop fixed:N", "N", Between(1, 1 << 24))
        ->excludes(stop);
    AddOption(app, kCommonOptions, "--report", &o->report,
              "Write every decision, as a page or as JSON", "R.html|R.json")
        ->check([](const std::string& file) {
            const bool isKnown = file.ends_with(".html") || file.ends_with(".json");
            return isKnown ? "" : file + " ends neither in .html nor in .json";
        });
    AddOption(app, kCommonOptions, "--denoise", &o->denoise,
              "Denoise, and stop blocks once the denoised image is clean");
    AddOption(app, "Denoising", "--denoise-layers", &o->denoiseLayers,
              "Write the AOVs that `lull denoise` needs");
    AddLayerOptions(app, o);
    AddPictureOptions(app, o);
    AddWorkOptions(app, o);
    app.footer("Stopping rules (--stop); a block stops\n" + RuleHelp(100) + "\n" + kFooter);
}

void CheckRequest(const RenderRequest& request) {
    const GltfOptions& view = request.render.scene.view;
    if (!view.frame && !request.sequence && (!view.animation.empty() || view.shutter > 0))
        throw UsageError("--animation and --shutter need --frame or --frames");
    if (request.sequence && request.pixel)
        throw UsageError("--pixel: a path is of one image; choose it with --frame");
    if (request.sequence && !request.until.empty())
        throw UsageError("--until: it is one moment for all frames; --time holds for each");
    // Where all samples belong to one half, nothing says how large their noise is.
    const int cap = request.render.cap.value_or(int(kLeastDenoisedSpp));
    const int fixed = FixedSpp(request.Rule());
    const bool isFixed = fixed > 0 && fixed <= cap;
    if (const int spp = isFixed ? fixed : cap;
        request.denoiseLayers && spp < int(kLeastDenoisedSpp))
        throw UsageError("--{}{}: --denoise-layers needs at least {}, to estimate the noise",
                         isFixed ? (request.spp ? "spp " : "stop fixed:") : "max-spp ", spp,
                         kLeastDenoisedSpp);
}

std::function<double()> StartClock(const RenderRequest& request) {
    if (!request.time.empty()) {
        // Of the steady clock, as nobody sets that; of `until`, the one that people look at.
        using Clock = std::chrono::steady_clock;
        return [end = ParseDuration(request.time), start = Clock::now()] {
            return end - SecondsSince(start);
        };
    }
    if (request.until.empty()) return {};
    using Clock = std::chrono::system_clock;
    const auto end =
        Clock::from_time_t(NextTimeOfDay(request.until, Clock::to_time_t(Clock::now())));
    return [end] { return std::chrono::duration<double>(end - Clock::now()).count(); };
}

std::unique_ptr<Display> MakeDisplay(const RenderRequest& request, const std::string& name,
                                     const PixelRect& region, int ranks) {
    if (request.display.empty()) return nullptr;
    if (ranks > 1)
        throw Error("--display: needs one process, as no rank has the whole image before the end");
    CheckMemory(region.Area() * int64_t(5 * sizeof(float) + 1),
                fmt::format("--display of {}x{} pixels", region.Width(), region.Height()),
                "leave it out");
    return std::make_unique<Display>(ParseDisplayAddress(request.display), name, region,
                                     [messages = MessagesOf(request.render)](
                                         const std::string& message) { messages.Warn(message); });
}

std::string NumberedFile(const std::string& file, int number) {
    if (file.empty()) return file;
    std::filesystem::path path = file;
    const std::string end = fmt::format(".{:04}{}", number, path.extension().string());
    return path.replace_extension(end).string();
}

}  // namespace lull::render
