#include "renderer/commands/render_files.h"

#include <filesystem>

#include "renderer/measure/block_files.h"
#include "renderer/measure/report.h"
#include "renderer/output/file_io.h"
#include "renderer/pages/html_page.h"

namespace lull {

namespace {

using std::filesystem::path;

path Normal(const std::string& file) { return std::filesystem::absolute(file).lexically_normal(); }

}  // namespace

bool HasImageExtension(const std::string& output) {
    const path extension = path(output).extension();
    return extension == ".exr" || extension == ".png";
}

RenderFiles NameFiles(const std::string& output, const std::string& report, bool withRanges) {
    auto with = [&](const char* extension) {
        return path(output).replace_extension(extension).string();
    };
    return {with(".exr"),
            with(".png"),
            with(".spp.png"),
            with(".thresholds.csv"),
            withRanges ? with(".ranges.csv") : "",
            report};
}

void CheckWritable(const RenderFiles& files, const std::string& scene) {
    for (const std::string& file :
         {files.exr, files.png, files.sppMap, files.thresholds, files.ranges, scene})
        if (!files.report.empty() && !file.empty() && Normal(file) == Normal(files.report))
            throw Error("--report " + files.report + ": would replace " + file);
    for (const std::string& file :
         {files.exr, files.png, files.sppMap, files.thresholds, files.ranges, files.report})
        if (!file.empty()) CheckWritable(file);
}

void WriteFiles(const RenderFiles& files, const FinishedRender& render) {
    const auto& [origin, film, result, histories, warnings, aovs, denoised, halves, description,
                 pictures] = render;
    const Provenance& provenance = origin.provenance;
    ExtraLayers extra =
        aovs ? MakeExtraLayers(*aovs, film, description, origin.scene) : ExtraLayers();
    extra.channels.insert(extra.channels.end(), halves.begin(), halves.end());
    WriteImage({files.exr, files.png}, origin, film, denoised, result, std::move(extra), pictures);
    WriteSppMap(files.sppMap, provenance, result);
    // Of an interrupted render nobody knows at which spp its blocks would have stopped.
    if (!result.cancelled)
        WriteThresholdsOf(files.thresholds, provenance.scene, ThresholdsOf(provenance, result));
    if (!result.cancelled && !files.ranges.empty()) WriteRanges(files.ranges, provenance, result);
    if (files.report.ends_with(".html"))
        WriteFileAtomically(files.report, MakeRenderPage(provenance, result, film, histories,
                                                         warnings.Counts(), denoised));
    else if (!files.report.empty())
        WriteFileAtomically(files.report, MakeReport(provenance, result, film.RejectedCount(),
                                                     warnings.Counts(), denoised));
}

}  // namespace lull
