#include "renderer/commands/prepared_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "renderer/commands/command.h"
#include "renderer/files/file_io.h"
#include "renderer/image/image_io.h"
#include "renderer/mpi/job.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/denoised_image.h"
#include "renderer/scene/light_groups.h"
#include "renderer/transport/integrator.h"
#include "stopping/base/input_file.h"
#include "stopping/base/parallel.h"

namespace lull::render {

namespace {

// Returns the length of passes: shorter where the rule counts samples and stops blocks within the
// first, as one that repeats a render that was short of time.
int PassLengthFor(const Rule& rule, int blocks, const ScheduleOptions& schedule) {
    int length = schedule.passLength;
    if (!rule.stopAt) return length;
    for (int i = 0; i < blocks; ++i)
        if (const int stop = rule.stopAt({.index = i}); stop < std::min(length, schedule.cap))
            length = std::gcd(length, stop);
    return std::max(1, length);
}

// Returns the largest value in [0, 1] in these pixels of a mask stretched over an image of `size`.
float LargestIn(const Image& mask, const PixelRect& pixels, const Vec2i& size) {
    const std::array<int64_t, 2> extent = {mask.width, mask.height};
    const auto begin = [&](int i) { return pixels.min[i] * extent[size_t(i)] / size[i]; };
    const auto end = [&](int i) { return (pixels.max[i] * extent[size_t(i)] - 1) / size[i] + 1; };
    const int colours = mask.channels < 3 ? 1 : 3;
    float largest = 0;
    const auto visit = [&]<typename T>(const std::vector<T>& texels) {
        const float scale = std::is_same_v<T, uint8_t> ? 255 : 1;
        for (int64_t y = begin(1); y < end(1); ++y)
            for (int64_t x = begin(0); x < end(0); ++x)
                for (int c = 0; c < colours; ++c)
                    largest = std::max(
                        largest,
                        float(texels[size_t((y * extent[0] + x) * mask.channels + c)]) / scale);
    };
    std::visit(visit, mask.texels);
    return std::min(largest, 1.f);
}

// Sets the caution of each block to that of the settings times its factor. Blocks that do not vote
// add theirs to their leader.
void SetCautions(const std::string& source, std::span<const double> factors, PreparedRender* p) {
    for (const double factor : factors) p->cautions.push_back(p->settings.caution * factor);
    for (size_t i = 0; i < p->blocks.size(); ++i)
        if (const int leader = p->blocks[i].leader; leader >= 0)
            p->cautions[size_t(leader)] = std::max(p->cautions[size_t(leader)], p->cautions[i]);
    p->rule.text += ", importance " + source;
}

// Multiplies the caution by 1 and the mask, in eighths: there are nine rules at the most.
void SetCautionsByMask(PreparedRender* p) {
    const Image mask = ReadImage(p->request.importance);
    const FilmSettings& film = p->filmSettings;
    std::vector<double> factors;
    for (const Block& block : p->blocks) {
        PixelRect pixels = block.pixels;
        if (pixels.min.x() >= film.cropMax.x())  // of the right eye
            for (Vec2i* corner : {&pixels.min, &pixels.max}) corner->x() -= film.Size().x();
        factors.push_back(1 + std::round(8 * LargestIn(mask, pixels, film.resolution)) / 8);
    }
    SetCautions(FileChecksum(p->request.importance), factors, p);
}

// An object or a material, and the factor of caution where it is seen.
struct ImportantObject {
    std::string name;
    double factor;
};

// Parses --importance NAME=X; returns nothing for a mask.
std::optional<ImportantObject> ParseImportantObject(const std::string& importance) {
    const size_t equals = importance.rfind('=');
    std::array<double, 1> factor;
    if (equals == std::string::npos ||
        !ParseNumbers(std::string_view(importance).substr(equals + 1), ',', &factor))
        return {};
    if (!(factor[0] >= 0.01 && factor[0] <= 100))
        throw UsageError("--importance: the factor of {} is not from 0.01 to 100", importance);
    return {{importance.substr(0, equals), factor[0]}};
}

// Multiplies the caution of blocks where the first sample of a pixel sees the object or material.
void SetCautionsByObject(const ImportantObject& important, PreparedRender* p) {
    const Scene& scene = *p->scene;
    const auto numbersOf = [&](size_t count, const auto& nameOf) {
        std::vector<bool> isNamed(count + 1);
        for (uint32_t n = 1; n <= count; ++n) isNamed[n] = nameOf(n) == important.name;
        return isNamed;
    };
    const std::vector<bool> objects =
        numbersOf(p->description.shapes.size() + scene.shapes.instances.size(),
                  [&](uint32_t n) { return NameOfObject(n, p->description, scene); });
    const std::vector<bool> materials = numbersOf(p->description.materials.size(), [&](uint32_t n) {
        return NameOfMaterial(n, p->description);
    });
    if (std::ranges::count(objects, true) + std::ranges::count(materials, true) == 0)
        throw Error(
            "--importance: no object and no material is named '{}'; the EXR of --aov cryptomatte "
            "has their names",
            Printable(important.name));
    const auto isSeenIn = [&](const PixelRect& rect) {
        Sampler sampler(SamplerKind::Random, p->settings.seed);
        PathSample sample{.asksForHit = true};
        for (int y = rect.min.y(); y < rect.max.y(); ++y)
            for (int x = rect.min.x(); x < rect.max.x(); ++x) {
                RenderSample(scene, p->settings.estimator, sampler, {x, y}, 0, &sample);
                if (objects[sample.hit.object] || materials[sample.hit.material]) return true;
            }
        return false;
    };
    std::vector<char> isSeen(p->blocks.size());
    RunWithThreads(p->settings.scene.compile.threads, [&] {
        ForEachIndex(int(isSeen.size()),
                     [&](int i) { isSeen[size_t(i)] = isSeenIn(p->blocks[size_t(i)].pixels); });
    });
    if (std::ranges::count(isSeen, 1) == 0)
        p->warnings.Add({}, "--importance: nothing of that name is seen",
                        Printable(important.name));
    std::vector<double> factors;
    for (const char seen : isSeen) factors.push_back(seen ? important.factor : 1);
    SetCautions(p->request.importance, factors, p);
}

void PrepareRule(PreparedRender* p) {
    RenderSettings& settings = p->settings;
    ScheduleOptions& schedule = settings.schedule;
    const std::string rule = p->request.Rule();
    // A fixed number of samples is its own cap; with --max-spp the smaller of both holds.
    if (settings.cap) schedule.cap = *settings.cap;
    if (const int spp = FixedSpp(rule))
        schedule.cap = settings.cap ? std::min(*settings.cap, spp) : spp;
    if (p->request.denoise) {
        p->DenoiseBlocks();
        p->denoiser->Grade(GradingsOf(p->grades));
    }
    p->rule = p->ReadRule("--stop", rule);
    if (p->request.gradedBy != 0 && p->rule.stopAt && !p->request.denoise)
        throw UsageError("--graded-by: {} does not judge the image; choose a rule that does",
                         p->rule.text);
    schedule.smallestSide = p->rule.smallestSide;
    p->blocks = MakeBlocks(p->region, schedule);
    schedule.passLength = PassLengthFor(p->rule, int(p->blocks.size()), schedule);
    if (p->request.importance.empty()) return;
    p->ReadRule("--importance", rule, 2 * settings.caution);  // has to be one that takes caution
    if (!ParseImportantObject(p->request.importance)) SetCautionsByMask(p);
}

void CheckBlocks(std::span<const Block> blocks, int smallestSide, Warnings& warnings) {
    for (const Block& block : blocks)
        if (!block.votes && block.leader < 0)
            warnings.Add({},
                         fmt::format("block of less than {} pixels a side continues to the cap, "
                                     "as it is too small to be judged",
                                     smallestSide));
}

bool LooksAtHalf(const Rule& rule, const ScheduleOptions& schedule) {
    const std::unique_ptr<Criterion> criterion = MakeCriterion(rule);
    for (int spp = 0; spp < schedule.cap;) {
        spp = int(std::min<int64_t>(int64_t(spp) + schedule.passLength, schedule.cap));
        if (criterion->Need(spp) >= ViewNeed::MeanAndHalf) return true;
    }
    return false;
}

// Without light groups yet. Whoever goes on from a checkpoint may look at the half.
FilmOptions FilmOf(const PreparedRender& p) {
    const RenderSettings& settings = p.settings;
    const LayerOptions layers = p.request.WantedLayers();
    return {.grid = GridOf(settings.schedule),
            .withHalf = p.clock || p.request.HasPage() || layers.features ||
                        !settings.checkpoint.file.empty() || LooksAtHalf(p.rule, settings.schedule),
            .layers = layers};
}

std::string NamesOf(const std::vector<Grade>& grades) {
    std::string text;
    for (const Grade& grade : grades) {
        const std::string own = TextOf(grade);
        text += (text.empty() ? "" : "; ") + (own.empty() ? "sRGB" : own);
    }
    return text;
}

void SetProvenance(const PreparedRender& p, Provenance* provenance) {
    if (provenance->sampler != p.scene->sampler && p.scene->sampler == SamplerKind::Random &&
        !p.request.render.sampler && !p.request.render.quiet && p.Leads())
        MessagesOf(p.request.render)
            .Note(
                "the samples are those of \"sobol-halves\", which has less noise than the scene's "
                "Sampler \"random\"; --sampler random keeps that");
    p.CheckSampler();
    provenance->criterion = p.rule.text;
    provenance->checksum = p.rule.checksum;
    provenance->clock = p.request.ClockText();
    provenance->grades = NamesOf(p.grades);
}

RenderFiles NameFilesOf(const RenderRequest& request, const FilmSettings& film) {
    std::string output = request.output, report = request.report;
    if (output.empty()) output = DefaultOutput(film.filename, request.render.scene.file);
    if (const int frame = request.frameNumber; frame > 0) {
        output = NumberedFile(output, frame);
        report = NumberedFile(report, frame);
    }
    const auto with = [&](const char* extension) {
        return std::filesystem::path(output).replace_extension(extension).string();
    };
    return {with(".exr"), with(".png"), with(".spp.png"), with(".thresholds.csv"), report};
}

std::vector<NamedFile> OutputsOf(const RenderFiles& files) {
    std::vector<NamedFile> outputs;
    for (const std::string& file : {files.exr, files.png, files.sppMap, files.thresholds})
        outputs.push_back({"-o", file});
    outputs.push_back({"--report", files.report});
    return outputs;
}

LightGroups ChooseLightGroups(const std::vector<std::string>& names, const Description& description,
                              const Scene& scene) {
    if (names.empty()) return {};
    try {
        return MakeLightGroups(names, description, scene);
    } catch (const Error& e) {
        throw Error(std::string("--light-groups: ") + e.what());
    }
}

// Returns the bytes per pixel of previews and of the denoiser's written inputs.
int64_t BytesBeside(const RenderRequest& request) {
    const bool hasPreviews = request.denoise && request.preview;
    return (hasPreviews ? kPreviewBytes : 0) + (request.denoiseLayers ? kHalfChannelsBytes : 0);
}

}  // namespace

std::unique_ptr<PreparedRender> Prepare(const RenderRequest& request, MpiJob* ranks) {
    auto p = std::make_unique<PreparedRender>(request, StartClock(request), ranks);
    const PixelRect& region = p->region;
    PrepareRule(p.get());
    CheckBlocks(p->blocks, p->settings.schedule.smallestSide, p->warnings);
    p->film = FilmOf(*p);
    CheckFilmFits(region, p->film, BytesBeside(request));
    p->files = NameFilesOf(request, p->filmSettings);
    std::vector<NamedFile> inputs;
    AddFileOfRule(request.Rule(), &inputs);
    inputs.push_back({"--importance", request.importance});
    p->CheckFiles(OutputsOf(p->files), std::move(inputs));
    p->LockResults(p->files.exr);
    p->display = MakeDisplay(request, std::filesystem::path(p->files.exr).filename(), region,
                             ranks->Count());
    p->Compile();
    if (const auto important = ParseImportantObject(request.importance))
        SetCautionsByObject(*important, p.get());
    p->film.layers.groups = ChooseLightGroups(request.lightGroups, p->description, *p->scene);
    CheckFilmFits(region, FilmFor(*p->scene, p->film), BytesBeside(request));
    SetProvenance(*p, &p->provenance);
    p->histories.resize(p->blocks.size());
    return p;
}

namespace {

std::string FirstDifference(const std::string& text, const std::string& other) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (("\n" + other).find("\n" + line + "\n") == std::string::npos) return line;
    return "";
}

bool IsWhole(const std::string& file) try {
    if (!IsThere(file)) return false;
    if (file.ends_with(".png")) return ReadImage(file).width > 0;
    const char* const end = file.ends_with(".json")   ? "\n}\n"
                            : file.ends_with(".html") ? "</html>\n"
                                                      : "\n";
    return ReadFile(file).View().ends_with(end);
} catch (const Error&) {
    return false;
}

bool AreWhole(const RenderFiles& files) {
    const std::initializer_list<std::string> others = {files.png, files.sppMap, files.thresholds,
                                                       files.report};
    return std::ranges::all_of(
        others, [](const std::string& file) { return file.empty() || IsWhole(file); });
}

}  // namespace

std::vector<Grading> GradingsOf(const std::vector<Grade>& grades) {
    std::vector<Grading> gradings;
    for (const Grade& grade : grades)
        gradings.push_back(grade.IsPlain() ? Grading() : [grade](std::span<float> rgb) {
            ApplyGrade(grade, rgb);
        });
    return gradings;
}

std::string SettingsOf(const PreparedRender& p) {
    const RenderRequest& request = p.request;
    const PictureFormat& format = request.pictures;
    RenderIdentity identity = p.Identity();
    identity["aov"] = TextOf(request.aovs);
    identity["light groups"] = NameOf(p.film.layers.groups);
    identity["denoise"] = request.denoise ? "yes" : "no";
    identity["denoise-layers"] = request.denoiseLayers ? "yes" : "no";
    identity["png-bits"] = std::to_string(format.pngBits);
    identity["tone-map"] = TextOf(format.grade);
    identity["transparent"] = format.isTransparent ? "yes" : "no";
    identity["exr-half"] = format.exrHalf ? "yes" : "no";
    return TextOf(identity);
}

bool IsFinished(const PreparedRender& p) {
    const RenderFiles& files = p.files;
    if (!IsThere(files.exr) || !AreWhole(files)) return false;
    std::string found;
    try {
        const ExrImage image = ReadExr(files.exr);
        const auto at = image.attributes.find(kSettingsAttribute);
        if (at == image.attributes.end()) return false;  // it was interrupted
        if (const auto* text = std::get_if<std::string>(&at->second)) found = *text;
    } catch (const Error&) {
        return false;
    }
    const std::string wanted = SettingsOf(p);
    if (found == wanted) return true;
    throw Error(
        "{}: was rendered with other settings ({} there, {} here); remove the frames to render "
        "them again, or name others by -o",
        files.exr, Printable(FirstDifference(found, wanted)),
        Printable(FirstDifference(wanted, found)));
}

}  // namespace lull::render
