#include "renderer/commands/render_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "renderer/output/file_io.h"
#include "renderer/output/image_io.h"
#include "renderer/output/spp_map.h"
#include "renderer/pages/html_page.h"
#include "stopping/network/human_range.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

using std::filesystem::path;

// Makes the header of an image of a region of the film, with channels R, G, B and spp.
ExrImage MakeExr(const Scene& scene, const PixelRect& region, int64_t samples,
                 const Provenance& provenance, double seconds) {
    ExrImage exr;
    exr.width = region.Width();
    exr.height = region.Height();
    exr.origin = region.min;
    exr.displaySize = scene.film.resolution;
    for (const char* name : {"R", "G", "B", "spp"})
        exr.channels.push_back({.name = name, .values = {}});

    // Counts go in as text, since an EXR's integers end at 2^31.
    exr.attributes = {{"renderer", "lull"},
                      {"version", provenance.version},
                      {"seed", std::to_string(provenance.seed)},
                      {"sampler", NameOf(provenance.sampler)},
                      {"estimator", NameOf(provenance.estimator)},
                      {"samples", std::to_string(samples)},
                      {"criterion", provenance.criterion},
                      {"seconds", float(seconds)},
                      {"worldToCamera", WorldToCamera(scene.camera)}};
    if (const auto ndc = WorldToNdc(scene.camera, scene.film)) exr.attributes["worldToNDC"] = *ndc;
    if (scene.film.exposure != 0) exr.attributes["exposure"] = scene.film.exposure;
    if (!provenance.checksum.empty()) exr.attributes["modelChecksum"] = provenance.checksum;
    if (provenance.filtering != TextureFiltering::Bilinear)
        exr.attributes["filtering"] = NameOf(provenance.filtering);
    if (provenance.guide != GuideMode::Off)
        exr.attributes["guide"] = fmt::format("{}: {}", NameOf(provenance.guide),
                                              provenance.guideFigures.isUsed ? "used" : "not used");
    return exr;
}

ExrImage MakeExr(const Scene& scene, const Film& film, const Provenance& provenance,
                 const RenderResult& result) {
    ExrImage exr =
        MakeExr(scene, film.Region(), film.SampleCount(), provenance, result.progress.seconds);
    exr.attributes["rejectedSamples"] = std::to_string(film.RejectedCount());
    if (result.cancelled)
        exr.attributes["note"] = "interrupted: blocks had not all stopped; see the spp channel";
    if (!provenance.clock.empty()) exr.attributes["clock"] = provenance.clock;
    if (result.timeUp)
        exr.attributes["note"] = fmt::format(
            "the time was up when {} of {} blocks had stopped: the samples of the others depend on "
            "the machine; --stop thresholds: with the file beside the image repeats it",
            result.progress.stoppedBlocks, result.progress.blocks);
    return exr;
}

// Writes means R, G, B as those of an EXR, with the samples of each pixel, and the values of the
// channels after these four.
void WriteExr(const std::string& file, const ExrImage& exr, const RowSource& means,
              const RowSource& spp) {
    const size_t stride = exr.channels.size();
    std::vector<float> rgb(size_t(exr.width) * 3), counts(size_t(exr.width));
    WriteExr(file, exr, [&](int y, std::span<float> row) {
        means(y, rgb);
        spp(y, counts);
        for (size_t x = 0; x < counts.size(); ++x) {
            std::copy_n(&rgb[3 * x], 3, &row[stride * x]);
            row[stride * x + 3] = counts[x];
            for (size_t c = 4; c < stride; ++c)
                row[stride * x + c] = exr.channels[c].values[size_t(y) * counts.size() + x];
        }
    });
}

// Returns the rows of the image, which is never held as a whole beside its sums.
RowSource MeansOf(const Film& film) {
    return [&film, view = std::make_shared<FilmView>()](int y, std::span<float> row) {
        const PixelRect& all = film.Region();
        film.Extract({{all.min.x(), all.min.y() + y}, {all.max.x(), all.min.y() + y + 1}}, false,
                     view.get());
        std::ranges::copy(view->mean, row.begin());
    };
}

RowSource SppOf(const Film& film) {
    return [&film](int y, std::span<float> row) {
        for (size_t x = 0; x < row.size(); ++x)
            row[x] = float(film.At(film.Region().min + Vec2i(int(x), y)).count);
    };
}

RowSource MeansOf(const RgbImage& image) {
    return [&image](int y, std::span<float> row) {
        std::copy_n(&image.values[size_t(y) * row.size()], row.size(), row.begin());
    };
}

// Returns the samples of pixels of blocks that have spp[i] each.
RowSource SppOf(const PixelRect& region, const std::vector<Block>& blocks,
                const std::vector<int>& spp) {
    return [&](int y, std::span<float> row) {
        y += region.min.y();
        for (size_t i = 0; i < blocks.size(); ++i) {
            const PixelRect& r = blocks[i].pixels;
            if (y < r.min.y() || y >= r.max.y()) continue;
            std::fill_n(row.begin() + (r.min.x() - region.min.x()), r.Width(), float(spp[i]));
        }
    };
}

void WriteSppMap(const std::string& file, const Film& film, const ScheduleOptions& schedule,
                 const RenderResult& result) {
    std::vector<SppBlock> blocks;
    for (const BlockResult& b : result.blocks) blocks.push_back({b.block.pixels, b.block.spp});
    const int lowest = std::min(schedule.passLength, schedule.cap);
    const SppMap map = DrawSppMap(film.Region(), blocks, lowest, schedule.cap);
    WritePng(file, map.srgb, map.width, map.height);
}

void WriteThresholdsRow(const std::string& file, const Provenance& provenance,
                        const RenderResult& result) {
    ThresholdsRow row{SceneName(provenance.scene), {}};
    for (const BlockResult& b : result.blocks)
        row.spp.push_back(b.block.stoppedByVote || !b.block.stopped ? b.block.spp
                                                                    : provenance.schedule.cap);
    std::ostringstream text;
    WriteThresholds(text, {row});
    WriteFileAtomically(file, text.str());
}

// Says of each block between which spp people would have stopped to see noise; an upper end that is
// not known is left empty.
void WriteRanges(const std::string& file, const Provenance& provenance,
                 const RenderResult& result) {
    std::string csv = "block,x,y,width,height,spp,stopped,people_from,people_to\n";
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        const Block& block = result.blocks[i].block;
        const PixelRect& r = block.pixels;
        const HumanRange people =
            RangeOfPeople(block.spp, block.stoppedByVote, provenance.logRatios);
        csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", i, r.min.x(), r.min.y(), r.Width(),
                           r.Height(), block.spp, int(block.stoppedByVote), people.low,
                           people.high ? std::to_string(*people.high) : "");
    }
    WriteFileAtomically(file, csv);
}

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

std::string SceneName(const std::string& file) {
    const path absolute = Normal(file);
    std::string name = absolute.stem().string();
    if (name == "scene" && absolute.has_parent_path() && absolute.parent_path().has_filename())
        name = absolute.parent_path().filename().string();
    for (char& c : name)
        if (c == ';' || c == '\n' || c == '\r') c = '_';
    return name.empty() ? "scene" : name;
}

void WriteFiles(const RenderFiles& files, const Scene& scene, const Film& film,
                const Provenance& provenance, const RenderResult& result, const Warnings& warnings,
                const std::vector<BlockHistory>& histories, ExtraLayers extra,
                const PictureOptions& pictures) {
    ExrImage exr = MakeExr(scene, film, provenance, result);
    std::ranges::move(extra.channels, std::back_inserter(exr.channels));
    exr.attributes.insert(extra.attributes.begin(), extra.attributes.end());
    ApplyTo(&exr, pictures);
    WriteExr(files.exr, exr, MeansOf(film), SppOf(film));
    WritePng(files.png, MeansOf(film), film.Region().Width(), film.Region().Height(),
             MakePngFormat(pictures, scene.film.exposure));
    WriteSppMap(files.sppMap, film, provenance.schedule, result);
    // Of an interrupted render nobody knows at which spp its blocks would have stopped.
    if (!result.cancelled) WriteThresholdsRow(files.thresholds, provenance, result);
    if (!result.cancelled && !files.ranges.empty()) WriteRanges(files.ranges, provenance, result);
    if (files.report.ends_with(".html"))
        WriteFileAtomically(files.report,
                            MakeRenderPage(provenance, result, film, histories, warnings.Counts()));
    else if (!files.report.empty())
        WriteFileAtomically(
            files.report, MakeReport(provenance, result, film.RejectedCount(), warnings.Counts()));
}

void WriteImage(const std::string& exr, const std::string& png, const Scene& scene,
                const RgbImage& image, const std::vector<Block>& blocks,
                const std::vector<int>& spp, const Provenance& provenance, double seconds) {
    const PixelRect& region = provenance.crop;
    int64_t samples = 0;
    for (size_t i = 0; i < blocks.size(); ++i) samples += blocks[i].pixels.Area() * spp[i];
    WriteExr(exr, MakeExr(scene, region, samples, provenance, seconds), MeansOf(image),
             SppOf(region, blocks, spp));
    WritePng(png, MeansOf(image), image.width, image.height);
}

}  // namespace lull
