#include "renderer/commands/render_files.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>

#include "renderer/files/file_io.h"
#include "renderer/image/image_io.h"
#include "renderer/pages/html_page.h"
#include "renderer/render/provenance.h"
#include "renderer/results/report.h"
#include "renderer/scene/light_groups.h"

namespace lull {

namespace {

using std::filesystem::path;

// Returns whether a file is there and was not cut short.
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

}  // namespace

bool HasImageExtension(const std::string& output) {
    const path extension = path(output).extension();
    return extension == ".exr" || extension == ".png";
}

std::string DefaultOutput(const std::string& filename, const std::string& scene) {
    const path given = filename;
    if (!given.stem().empty() && given.stem() != "scene") return filename;
    return path(given).replace_filename(SceneName(scene) + ".exr").string();
}

RenderFiles NameFiles(const std::string& output, const std::string& report) {
    auto with = [&](const char* extension) {
        return path(output).replace_extension(extension).string();
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

bool AreWhole(const RenderFiles& files) {
    const std::initializer_list<std::string> others = {files.png, files.sppMap, files.thresholds,
                                                       files.report};
    return std::ranges::all_of(
        others, [](const std::string& file) { return file.empty() || IsWhole(file); });
}

ResultFiles WriteFiles(const RenderFiles& files, const FinishedRender& render) {
    const PictureOrigin& origin = render.origin;
    const Provenance& provenance = origin.provenance;
    const Film& film = render.film;
    const RenderResult& result = render.result;
    LayerChannels layers =
        ChannelsOf({film, render.denoised, render.pictures.isTransparent,
                    [&](uint32_t n) { return NameOfObject(n, render.description, origin.scene); },
                    [&](uint32_t n) { return NameOfMaterial(n, render.description); }});
    layers.channels.insert(layers.channels.end(), render.halves.begin(), render.halves.end());
    if (!render.settings.empty()) layers.attributes[kSettingsAttribute] = render.settings;
    ResultFiles results;
    const int64_t clamped =
        WriteImage({files.exr, files.png}, origin,
                   {film, render.denoised, result, std::move(layers), render.pictures}, &results);
    if (clamped > 0)
        render.warnings.Add({}, "values clamped to 65504",
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
        results.WriteText(files.report, MakeRenderPage(provenance, result, film, render.histories,
                                                       render.warnings.Counts(), render.denoised));
    else if (!files.report.empty())
        results.WriteText(files.report, MakeReport(provenance, result, film.RejectedCount(),
                                                   render.warnings.Counts(), render.denoised));
    return results;
}

std::vector<NamedFile> InputsOf(const SceneOptions& options, const Description& description) {
    std::vector<NamedFile> inputs = {{"the scene", options.file},
                                     {"--environment", options.environment}};
    for (const std::string& file : FilesOf(description))
        inputs.push_back({"a file of the scene", file});
    return inputs;
}

void AddFileOfRule(const std::string& rule, std::vector<NamedFile>* inputs) {
    const size_t colon = rule.find(':');
    if (colon == std::string::npos) return;
    const std::string rest = rule.substr(colon + 1);
    // A name may follow the file's, whose own may have colons.
    for (const std::string& file : {rest, rest.substr(0, rest.rfind(':'))}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(file, error))
            return inputs->push_back({"the file of the rule,", file});
    }
}

}  // namespace lull
