// `lull render`: renders a scene until every block has stopped.
#include <fmt/format.h>

#include <CLI/App.hpp>

#include "renderer/base/clocks.h"
#include "renderer/commands/denoising.h"
#include "renderer/commands/prepared_render.h"
#include "renderer/commands/render_messages.h"
#include "renderer/mpi/job.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/denoised_image.h"
#include "stopping/base/input_file.h"
#include "stopping/rules/baselines.h"

namespace lull::render {

namespace {

// Returns the maker of the criteria; for a page, they also keep the curves of each block.
CriterionMaker MakeCriterionMaker(const Rule& rule, const std::vector<Grade>& grades,
                                  bool withCurves, std::vector<BlockHistory>* histories) {
    CriterionMaker criteriaOf = MakeGradedCriteria(rule, grades);
    if (!withCurves) return criteriaOf;
    return [criteriaOf, histories](const BlockInfo& info) {
        std::vector<std::unique_ptr<Criterion>> rules;
        rules.push_back(criteriaOf(info));
        return std::make_unique<BlockMonitor>(std::move(rules), MonitorOptions{.curves = true},
                                              &(*histories)[size_t(info.index)]);
    };
}

// Adds who hears of the render beside those that every command has.
void AddListeners(const PreparedRender& p, RenderEvents* events) {
    const Messages messages = MessagesOf(p.render.settings);
    if (p.clock)
        events->onProgress = WarnOfFirstSamples(p.render.input.region.Area(), messages,
                                                std::move(events->onProgress));
    const RenderRequest& request = p.request;
    const bool isDefault = !p.clock && !request.denoise && !request.stop && request.spp == 0;
    if (isDefault && !p.render.settings.quiet)
        events->onProgress =
            AdviseDenoising(p.render.input.region.Area(), messages, std::move(events->onProgress));
    if (messages.isJson) events->onStop = StopEvents(p.rule.trend.kind);
}

SessionOptions MakeOptions(PreparedRender* p) {
    const RenderJob& render = p->render;
    SessionOptions how = render.MakeSessionOptions(FixedSpp(p->request.Rule()) == 0);
    how.render.makeCriterion =
        MakeCriterionMaker(p->rule, p->grades, p->request.HasPage(), &p->histories);
    how.render.trend = p->rule.trend;
    how.render.display = p->display.get();
    AddListeners(*p, &how.render.events);
    how.film = p->film;
    how.clock = p->clock;
    // An interruption or a preview finds the whole image, whatever its sample counts.
    how.render.schedule.inSteps = true;
    how.firstLook = p->display || p->request.pictures.preview > 0;
    // The hash of a large scene takes its time, and nobody asks for it where there is neither.
    if (render.settings.checkpoint.file.empty() && render.ranks->Count() == 1) return how;
    how.identity = render.Identity();
    how.identity["curves"] = p->request.HasPage() ? "yes" : "no";
    return how;
}

// A preview that cannot be written is a warning: the files may be written in the end.
void WritePreview(const PreparedRender& p, Session* session, const RenderResult& result) try {
    const Film& film = session->GetFilm();
    std::optional<DenoisedImage> denoised;
    if (p.request.denoise) {
        denoised = DenoisePreview(film);
        RemoveUnknownErrors(result, film.Region(), &*denoised);
    }
    ResultFiles written(Rescue::None);
    WriteImage({p.files.exr, p.files.png}, {*p.render.scene, p.render.provenance},
               {film, denoised ? &*denoised : nullptr, result, {}, p.request.pictures.format},
               &written);
    written.Check();
} catch (const Error& e) {
    MessagesOf(p.render.settings).Warn(fmt::format("no preview: {}", e.what()));
}

// Renders, and shows pictures on the way where they are asked for.
RenderResult RenderPrepared(PreparedRender* p, Session* session) {
    if (p->clock) p->render.ranks->SetClock(p->clock);
    if (p->render.denoiser && p->display)
        p->render.denoiser->ShowPictures(
            [display = p->display.get()](const PixelRect& pixels, std::span<const float> rgb) {
                display->ShowDenoised(pixels, rgb);
            });
    if (const double seconds = p->request.pictures.preview; seconds > 0)
        session->Preview(seconds,
                         [=](const RenderResult& result) { WritePreview(*p, session, result); });
    return p->render.Run(session);
}

// Denoised image of a finished render.
struct DenoiserResults {
    std::optional<DenoisedImage> image;
    std::vector<ExrChannel> halves;  // what can be denoised later
};

// Denoises each eye of a pair by itself, so that neither sees the other at the seam.
DenoisedImage DenoisePair(const PreparedRender& p, const Film& film, const ProgressStyle& style,
                          const DenoiserOptions& how) {
    const PixelRect& region = p.render.input.region;
    const Vec2i across(region.Width() / 2, 0);
    const PixelRect left{region.min, region.max - across};
    const size_t count = p.blocks.size() / 2;
    const auto denoise = [&](const PixelRect& eye, size_t first) {
        const std::vector<Block> blocks(p.blocks.begin() + std::ptrdiff_t(first),
                                        p.blocks.begin() + std::ptrdiff_t(first + count));
        return film.layers.Find<LightGroupLayer>()
                   ? DenoiseWithReports(GroupedPictureOf(film, eye), eye, blocks, style, how)
                   : DenoiseWithReports(PictureOf(film, eye), eye, blocks, style, how);
    };
    const DenoisedImage first = denoise(left, 0);
    return Beside(first, denoise({left.min + across, left.max + across}, count));
}

// Makes the requested images, and frees their inputs.
DenoiserResults TakeDenoised(const PreparedRender& p, const RenderResult& result,
                             Session* session) {
    const RenderSettings& settings = p.render.settings;
    const PixelRect& region = p.render.input.region;
    Film& film = session->GetFilm();
    DenoiserResults made;
    NoisyPicture picture;
    GroupedPicture groups;
    const bool isPair = p.render.input.film.isPair;
    const bool hasGroups = p.request.denoise && film.layers.Find<LightGroupLayer>();
    const DenoiserOptions how{.gradings = GradingsOf(p.grades)};
    const ProgressStyle style = StyleOfReports(settings.jsonProgress, settings.quiet);
    const auto start = std::chrono::steady_clock::now();
    if (p.request.denoiseLayers) made.halves = MakeHalfChannels(film, region);
    if (isPair && p.request.denoise)
        made.image = DenoisePair(p, film, style, how);
    else if (hasGroups)
        groups = TakeGroups(&film);
    else if (p.request.denoise)
        picture = TakePicture(&film);
    film.layers.ForgetFeatures();  // what follows needs the memory
    film.DropHalf();
    if (!p.request.denoise) return made;
    const Messages messages = MessagesOf(settings);
    if (!isPair)
        made.image = hasGroups
                         ? DenoiseWithReports(std::move(groups), region, p.blocks, style, how)
                         : DenoiseWithReports(std::move(picture), region, p.blocks, style, how);
    if (IsRule(p.rule.text, kDenoisedRuleName)) KeepDecisions(result, &*made.image);
    if (const int unknown = RemoveUnknownErrors(result, region, &*made.image); unknown > 0)
        messages.Warn(fmt::format(
            "{} of {} blocks have fewer than {} samples per pixel; how far they are from "
            "the true image is unknown",
            unknown, result.blocks.size(), kLeastDenoisedSpp));
    PrintDenoised(*made.image, SecondsSince(start), settings.quiet, messages,
                  IsRule(p.rule.text, kDenoisedRuleName) ? p.rule.threshold
                                                         : kAcceptedDifference / settings.caution);
    if (p.display) p.display->ShowDenoised(region, made.image->image.values);
    return made;
}

// Prints how the render ended, writes all files, and prints how it continues.
ExitCode Write(PreparedRender& p, const RenderResult& result, Session* session) {
    const RenderSettings& settings = p.render.settings;
    const Messages messages = MessagesOf(settings);
    const int64_t rejected = session->GetFilm().RejectedCount();
    PrintResult(settings, p.render.provenance, result, rejected);
    if (result.progress.samples == 0) return kInterrupted;  // there is nothing to write
    const DenoiserResults denoised = TakeDenoised(p, result, session);
    const bool isFrame = p.request.frameNumber > 0 && !settings.checkpoint.file.empty();
    const ResultFiles written =
        WriteFiles(p.files, {{*p.render.scene, p.render.provenance},
                             session->GetFilm(),
                             result,
                             p.histories,
                             p.render.input.warnings,
                             denoised.image ? &*denoised.image : nullptr,
                             denoised.halves,
                             p.render.input.description,
                             p.request.pictures.format,
                             isFrame && !result.cancelled ? SettingsOf(p) : ""});
    for (const std::string& name : written.Names()) fmt::print("{}\n", name);
    if (p.display) p.display->Finish();
    const CheckpointOptions& checkpoint = settings.checkpoint;
    const bool goesOn = result.cancelled || (result.timeUp && !checkpoint.file.empty());
    if (goesOn && !settings.quiet) messages.Note(HowToGoOn(checkpoint));
    if (messages.isJson) SayEnd(written, result, rejected);
    written.Check();
    if (!result.cancelled && !result.timeUp) p.render.RemoveCheckpoint();
    return result.cancelled ? kInterrupted : kDone;
}

// Prints the path of a sample instead.
ExitCode RunPath(const RenderRequest& request, MpiJob* ranks) {
    RenderJob render(request.render, ranks, false);
    render.Compile();
    PrintPath(request.path, render.settings, render.input.description, *render.scene);
    return kDone;
}

// Renders one image, unless it is a frame that is finished.
ExitCode RunImage(const RenderRequest& request, MpiJob* ranks, const std::string& note = "") {
    const std::unique_ptr<PreparedRender> p = Prepare(request, ranks);
    const CheckpointOptions& checkpoint = request.render.checkpoint;
    if (request.frameNumber > 0 && checkpoint.resume && !IsThere(checkpoint.file) && IsFinished(*p))
        return kDone;
    if (!note.empty()) MessagesOf(request.render).Note(note);
    Session session(*p->render.scene, p->render.input.region, MakeOptions(p.get()));
    const RenderResult result = RenderPrepared(p.get(), &session);
    ranks->End();
    return p->render.Leads() ? Write(*p, result, &session) : kDone;
}

// Renders all frames, each with a checkpoint of its own. To be resumed are those without all of
// their files, and those whose checkpoint has been left.
ExitCode RunSequence(const RenderRequest& request, MpiJob* ranks) {
    if (ranks->Count() > 1)
        throw UsageError("--frames: needs one process; give each rank frames of its own");
    const int count = request.sequence->Count();
    for (int number = 1; number <= count; ++number) {
        RenderRequest frame = request;
        const double time = request.sequence->TimeOf(number - 1);
        frame.frameNumber = number;
        frame.render.scene.view.frame = time;
        CheckpointOptions& checkpoint = frame.render.checkpoint;
        checkpoint.file = NumberedFile(checkpoint.file, number);
        std::string note;
        if (!request.render.quiet)
            note = fmt::format("frame {} of {}, at {:.6g} s", number, count, time);
        if (const ExitCode code = RunImage(frame, ranks, note); code != kDone) return code;
    }
    return kDone;
}

ExitCode RunRender(RenderRequest request, MpiJob* ranks) {
    CheckRequest(request);
    if (request.path.pixel) return ranks->Rank() == 0 ? RunPath(request, ranks) : kDone;
    SetWording(request.render, ranks);
    request.aovs.alpha |= request.pictures.format.isTransparent;
    LoadView(&request.pictures);
    return request.sequence ? RunSequence(request, ranks) : RunImage(request, ranks);
}

}  // namespace

void AddCommand(CLI::App& app, Command* command, MpiJob* ranks) {
    CLI::App* render =
        app.add_subcommand("render",
                           "Renders a scene, 20 samples per pixel a pass, until each\n"
                           "block of the image has stopped or is at the cap.");
    auto request = std::make_shared<RenderRequest>();
    AddRenderOptions(*render, request.get());
    render->callback([=] { *command = [=] { return RunRender(*request, ranks); }; });
}

}  // namespace lull::render
