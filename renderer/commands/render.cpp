// `lull render`: renders a scene until every block has stopped.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <utility>

#include "renderer/base/clocks.h"
#include "renderer/commands/prepared_render.h"
#include "renderer/commands/render_messages.h"
#include "renderer/mpi/job.h"
#include "renderer/pages/html_page.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/denoised_image.h"
#include "renderer/results/report.h"
#include "renderer/scene/light_groups.h"
#include "stopping/base/input_file.h"
#include "stopping/rules/baselines.h"

namespace lull::render {

namespace {

// Makes criteria that see blocks as graded, unless the rule sees to that itself, or only counts.
CriterionMaker MakeGradedCriteria(const Rule& rule, const std::vector<Grade>& grades) {
    CriterionMaker criteriaOf = CriteriaOf(rule);
    if (grades.empty() || rule.stopAt || rule.need == ViewNeed::Measured) return criteriaOf;
    return [criteriaOf, grades](const BlockInfo& info) {
        std::vector<GradedJudge> judges;
        for (const Grade& grade : grades) judges.push_back({grade, criteriaOf(info)});
        return std::make_unique<GradedCriterion>(std::move(judges));
    };
}

CriterionMaker MakeCautiousCriteria(const PreparedRender& p) {
    if (p.cautions.empty()) return MakeGradedCriteria(p.rule, p.grades);
    std::map<double, CriterionMaker> makers;
    for (const double caution : p.cautions)
        if (CriterionMaker& maker = makers[caution]; !maker)
            maker =
                MakeGradedCriteria(p.ReadRule("--importance", p.request.Rule(), caution), p.grades);
    return [makers, cautions = p.cautions](const BlockInfo& info) {
        return makers.at(cautions[size_t(info.index)])(info);
    };
}

CriterionMaker MakeCriterionMaker(PreparedRender* p) {
    CriterionMaker criteriaOf = MakeCautiousCriteria(*p);
    if (!p->request.HasPage()) return criteriaOf;
    return [criteriaOf, p](const BlockInfo& info) {
        std::vector<std::unique_ptr<Criterion>> rules;
        rules.push_back(criteriaOf(info));
        return std::make_unique<BlockMonitor>(std::move(rules), MonitorOptions{.curves = true},
                                              &p->histories[size_t(info.index)]);
    };
}

void AddListeners(const PreparedRender& p, RenderEvents* events) {
    const Messages messages = MessagesOf(p.settings);
    if (p.clock)
        events->onProgress =
            WarnOfFirstSamples(p.region.Area(), messages, std::move(events->onProgress));
    const RenderRequest& request = p.request;
    const bool isDefault = !p.clock && !request.denoise && !request.stop && !request.spp;
    if (isDefault && !p.settings.quiet)
        events->onProgress =
            AdviseDenoising(p.region.Area(), messages, std::move(events->onProgress));
    if (messages.isJson) events->onStop = StopEvents(p.rule.trend.kind);
}

SessionOptions MakeOptions(PreparedRender* p) {
    SessionOptions how = p->MakeSessionOptions(FixedSpp(p->request.Rule()) == 0);
    how.render.makeCriterion = MakeCriterionMaker(p);
    how.render.trend = p->rule.trend;
    how.render.display = p->display.get();
    AddListeners(*p, &how.render.events);
    how.film = p->film;
    how.clock = p->clock;
    // An interruption or a preview finds the whole image, whatever its sample counts.
    how.render.schedule.inSteps = true;
    how.firstLook = p->display || p->request.preview;
    // The hash of a large scene takes its time, and nobody asks for it where there is neither.
    if (p->settings.checkpoint.file.empty() && p->ranks->Count() == 1) return how;
    how.identity = p->Identity();
    how.identity["curves"] = p->request.HasPage() ? "yes" : "no";
    return how;
}

// Sets the visible error of blocks that the rule `denoised` has stopped to that by which it did.
// Theirs are still the same samples, which the picture in the end filters more carefully: its own
// estimate, equally rough, may be above the threshold.
void KeepDecisions(const RenderResult& result, DenoisedImage* denoised) {
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        const BlockResult& block = result.blocks[i];
        std::optional<VisibleError>& error = denoised->blocks[i];
        if (!error || !block.block.stoppedByVote || block.decisions.empty()) continue;
        error->estimate = block.decisions.back().decision.value;
        error->upper = std::max(error->upper, error->estimate);
    }
}

// Removes the error estimates of blocks with too few samples for one, and sets the error of their
// pixels to the largest. Returns the number of these blocks.
int RemoveUnknownErrors(const RenderResult& result, const PixelRect& region,
                        DenoisedImage* denoised) {
    int count = 0;
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        if (result.blocks[i].block.spp >= int(kLeastDenoisedSpp)) continue;
        ++count;
        if (i < denoised->blocks.size()) denoised->blocks[i].reset();
        const PixelRect& pixels = result.blocks[i].block.pixels;
        for (int y = pixels.min.y(); y < pixels.max.y(); ++y)
            std::fill_n(denoised->error.begin() + (y - region.min.y()) * region.Width() +
                            (pixels.min.x() - region.min.x()),
                        pixels.Width(), kUnknownError);
    }
    return count;
}

// A preview that cannot be written is a warning, the first time: the files may be written in the
// end.
void WritePreview(const PreparedRender& p, Session* session, const RenderResult& result,
                  bool* warned) try {
    const Film& film = session->GetFilm();
    std::optional<DenoisedImage> denoised;
    if (p.request.denoise) {
        denoised = DenoiseEyes(film.Region(), p.blocks, p.settings.schedule.eyeWidth,
                               [&](const PixelRect& eye, const std::vector<Block>&) {
                                   return DenoisePreview(film, eye);
                               });
        RemoveUnknownErrors(result, film.Region(), &*denoised);
    }
    ResultFiles written(Rescue::None);
    WriteImage({p.files.exr, p.files.png}, {*p.scene, p.provenance},
               {film, denoised ? &*denoised : nullptr, result, {}, p.request.pictures}, &written);
    written.Check();
} catch (const Error& e) {
    if (!std::exchange(*warned, true))
        MessagesOf(p.settings).Warn(fmt::format("no preview: {}", e.what()));
}

RenderResult RenderPrepared(PreparedRender* p, Session* session) {
    if (p->clock) p->ranks->SetClock(p->clock);
    if (p->denoiser && p->display)
        p->denoiser->ShowPictures(
            [display = p->display.get()](const PixelRect& pixels, std::span<const float> rgb) {
                display->ShowDenoised(pixels, rgb);
            });
    if (p->request.preview)
        session->Preview(*p->request.preview,
                         [=, warned = false](const RenderResult& result) mutable {
                             WritePreview(*p, session, result, &warned);
                         });
    return p->Run(session);
}

struct DenoiserResults {
    std::optional<DenoisedImage> image;
    std::vector<ExrChannel> halves;  // what can be denoised later
};

DenoiserResults TakeDenoised(const PreparedRender& p, const RenderResult& result,
                             Session* session) {
    const RenderSettings& settings = p.settings;
    const PixelRect& region = p.region;
    Film& film = session->GetFilm();
    DenoiserResults made;
    const DenoiserOptions how{.gradings = GradingsOf(p.grades)};
    const ProgressStyle style = StyleOfReports(settings.jsonProgress, settings.quiet);
    const auto denoisePart = [&](const PixelRect& part, const std::vector<Block>& blocks) {
        if (film.layers.Find<LightGroupLayer>())
            return DenoiseWithReports(TakeGroups(&film, part), part, blocks, style, how);
        return DenoiseWithReports(TakePicture(&film, part), part, blocks, style, how);
    };
    const auto start = std::chrono::steady_clock::now();
    if (p.request.denoiseLayers) made.halves = MakeHalfChannels(film, region);
    if (p.request.denoise)
        made.image = DenoiseEyes(region, p.blocks, settings.schedule.eyeWidth, denoisePart);
    film.layers.ForgetFeatures();  // what follows needs the memory
    film.DropHalf();
    if (!made.image) return made;
    const Messages messages = MessagesOf(settings);
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

// Writes all files, each whole or not at all; a report whose name ends in .html as a page. Those of
// an earlier render that this one has none of are removed.
ResultFiles WriteFiles(PreparedRender& p, const Film& film, const RenderResult& result,
                       const DenoiserResults& made) {
    const RenderFiles& files = p.files;
    const PictureOrigin origin{*p.scene, p.provenance};
    const Provenance& provenance = p.provenance;
    const Description& description = p.description;
    Warnings& warnings = p.warnings;
    const DenoisedImage* denoised = made.image ? &*made.image : nullptr;
    LayerChannels layers =
        ChannelsOf({film, denoised, p.request.pictures.isTransparent,
                    [&](uint32_t n) { return NameOfObject(n, description, origin.scene); },
                    [&](uint32_t n) { return NameOfMaterial(n, description); }});
    layers.channels.insert(layers.channels.end(), made.halves.begin(), made.halves.end());
    // By which a finished frame is known.
    const bool isFrame = p.request.frameNumber > 0 && !p.settings.checkpoint.file.empty();
    if (isFrame && !result.cancelled) layers.attributes[kSettingsAttribute] = SettingsOf(p);
    ResultFiles results;
    const int64_t clamped =
        WriteImage({files.exr, files.png}, origin,
                   {film, denoised, result, std::move(layers), p.request.pictures}, &results);
    if (clamped > 0)
        warnings.Add({}, "values clamped to 65504",
                     fmt::format("{} in the EXR, as 16 bits hold no more; leave out "
                                 "--exr-half to keep them",
                                 clamped));
    results.Write(files.sppMap,
                  [&](const std::string& file) { WriteSppMap(file, provenance, result); });
    // Of an interrupted render nobody knows at which spp its blocks would have stopped.
    if (result.cancelled)
        ResultFiles::RemoveOld(files.thresholds);
    else
        results.Write(files.thresholds, [&](const std::string& file) {
            WriteThresholdsOf(file, provenance.scene, ThresholdsOf(provenance, result));
        });
    if (files.report.ends_with(".html"))
        results.WriteText(files.report, MakeRenderPage(provenance, result, film, p.histories,
                                                       warnings.Counts(), denoised));
    else if (!files.report.empty())
        results.WriteText(files.report, Dump(ReportJson(provenance, result, film.RejectedCount(),
                                                        warnings.Counts(), denoised)));
    return results;
}

ExitCode Write(PreparedRender& p, const RenderResult& result, Session* session) {
    const RenderSettings& settings = p.settings;
    const Messages messages = MessagesOf(settings);
    const int64_t rejected = session->GetFilm().RejectedCount();
    PrintResult(settings, p.provenance, result, rejected);
    if (result.progress.samples == 0) return kInterrupted;  // there is nothing to write
    const DenoiserResults denoised = TakeDenoised(p, result, session);
    const ResultFiles written = WriteFiles(p, session->GetFilm(), result, denoised);
    for (const std::string& name : written.Names()) fmt::print("{}\n", name);
    if (p.display) p.display->Finish();
    const CheckpointOptions& checkpoint = settings.checkpoint;
    const bool goesOn = result.cancelled || (result.timeUp && !checkpoint.file.empty());
    if (goesOn && !settings.quiet) messages.Note(HowToGoOn(checkpoint));
    if (messages.isJson) SayEnd(written, result, rejected);
    written.Check();
    if (!result.cancelled && !result.timeUp) p.RemoveCheckpoint();
    return result.cancelled ? kInterrupted : kDone;
}

ExitCode RunPath(const RenderRequest& request, MpiJob* ranks) {
    RenderJob render(request.render, ranks, false);
    render.Compile();
    PrintPath(*request.pixel, request.sample, render.settings, render.description, *render.scene);
    return kDone;
}

ExitCode RunImage(const RenderRequest& request, MpiJob* ranks, const std::string& note = "") {
    const std::unique_ptr<PreparedRender> p = Prepare(request, ranks);
    const CheckpointOptions& checkpoint = request.render.checkpoint;
    if (request.frameNumber > 0 && checkpoint.resume && !IsThere(checkpoint.file) && IsFinished(*p))
        return kDone;
    if (!note.empty()) MessagesOf(request.render).Note(note);
    Session session(*p->scene, p->region, MakeOptions(p.get()));
    const RenderResult result = RenderPrepared(p.get(), &session);
    ranks->End();
    return p->Leads() ? Write(*p, result, &session) : kDone;
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
        if (!request.sameSeed) frame.render.seed += uint64_t(number);
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
    if (request.pixel) return ranks->Rank() == 0 ? RunPath(request, ranks) : kDone;
    SetWording(request.render, ranks);
    request.aovs.alpha |= request.pictures.isTransparent;
    if (request.ocio || request.view)
        request.pictures.grade.view =
            LoadView(request.ocio.value_or(""), request.view.value_or(""));
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
