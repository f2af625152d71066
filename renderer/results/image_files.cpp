#include "renderer/results/image_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/results/report.h"

namespace lull {

namespace {

// Returns whether a channel is a colour or a direction, to which 11 bits do no harm.
bool MayBeHalf(const std::string& name) {
    return name == "R" || name == "G" || name == "B" || name.starts_with("albedo.") ||
           name.starts_with("N.") || name.starts_with("noisy.") || name.starts_with("light.");
}

ExrImage MakeExr(const PictureOrigin& origin, const PixelRect& region, int64_t samples,
                 double seconds) {
    const auto& [scene, provenance] = origin;
    ExrImage exr;
    exr.width = region.Width();
    exr.height = region.Height();
    exr.origin = region.min;
    exr.displaySize = scene.film.resolution;
    for (const char* name : {"R", "G", "B", "spp"})
        exr.channels.push_back({.name = name, .values = {}});

    // Counts go in as text, since an EXR's integers end at 2^31.
    exr.attributes = {{"samples", std::to_string(samples)},
                      {"seconds", float(seconds)},
                      {"worldToCamera", WorldToCamera(scene.camera)}};
    for (const NamedProvenance& part : PartsOf(provenance))
        if (part.exr) exr.attributes[part.exr] = TextOf(part);
    if (const auto ndc = WorldToNdc(scene.camera, scene.film)) exr.attributes["worldToNDC"] = *ndc;
    if (scene.film.exposure != 0) exr.attributes["exposure"] = scene.film.exposure;
    return exr;
}

ExrImage MakeExr(const PictureOrigin& origin, const Film& film, const RenderResult& result) {
    const Provenance& provenance = origin.provenance;
    ExrImage exr = MakeExr(origin, film.Region(), film.SampleCount(), result.progress.seconds);
    const int atCap = result.progress.blocksAtCap, stopped = result.progress.stoppedBlocks - atCap;
    exr.attributes["rejectedSamples"] = std::to_string(film.RejectedCount());
    exr.attributes["blocks"] = std::to_string(result.progress.blocks);
    exr.attributes["cleanBlocks"] = std::to_string(stopped);
    exr.attributes["blocksAtCap"] = std::to_string(atCap);
    if (result.cancelled)
        exr.attributes["note"] = "interrupted: not all blocks were clean; see the spp channel";
    if (result.timeUp)
        exr.attributes["note"] = fmt::format(
            "the time was up when {} of {} blocks were clean and {} were at the cap: the samples "
            "of the others depend on the machine; --stop thresholds: with the file beside the "
            "image repeats it",
            stopped, result.progress.blocks, atCap);
    else if (atCap > 0 && result.trend.kind != RuleTrend::Samples)
        exr.attributes["note"] =
            fmt::format("{} of {} blocks went to the cap of {} spp, and were not clean there",
                        atCap, result.progress.blocks, provenance.schedule.cap);
    return exr;
}

void ApplyTo(ExrImage* exr, const PictureFormat& wanted) {
    if (const std::string tones = TextOf(wanted.grade); !tones.empty())
        exr->attributes["pngToneMap"] = tones;
    if (!wanted.exrHalf) return;
    for (ExrChannel& channel : exr->channels) channel.isHalf |= MayBeHalf(channel.name);
}

// Its header tells of a tone map and of the scene's exposure, in stops.
PngFormat MakePngFormat(const PictureFormat& wanted, double exposure) {
    PngFormat format{.bits = wanted.pngBits, .grade = wanted.grade, .text = {}};
    if (const std::string tones = TextOf(wanted.grade); !tones.empty())
        format.text["ToneMap"] = tones;
    format.hasAlpha = wanted.isTransparent;
    if (exposure != 0) format.text["Exposure"] = fmt::format("{:+g} stops", exposure);
    return format;
}

// Returns means R, G, B as rows of an EXR, with the samples of each pixel, and the values of the
// channels after these four. The EXR must be there, and not move.
RowSource ChannelsOf(const ExrImage& exr, const RowSource& means, const RowSource& spp) {
    const size_t stride = exr.channels.size();
    return [&exr, means, spp, stride](int y, std::span<float> row) {
        std::vector<float> rgb(size_t(exr.width) * 3), counts(size_t(exr.width));
        means(y, rgb);
        spp(y, counts);
        for (size_t x = 0; x < counts.size(); ++x) {
            std::copy_n(&rgb[3 * x], 3, &row[stride * x]);
            row[stride * x + 3] = counts[x];
            for (size_t c = 4; c < stride; ++c)
                row[stride * x + c] = exr.channels[c].values[size_t(y) * counts.size() + x];
        }
    };
}

RowSource MeansOf(const Film& film) {
    return [&film](int y, std::span<float> row) {
        const PixelRect& all = film.Region();
        FilmView view;
        film.Extract({{all.min.x(), all.min.y() + y}, {all.max.x(), all.min.y() + y + 1}}, false,
                     &view);
        std::ranges::copy(view.mean, row.begin());
    };
}

// Returns the rows without the light of samples that hit nothing, premultiplied by alpha therefore.
RowSource WithoutBackground(const RowSource& rows, bool isDenoised, const Film& film) {
    return [&film, &mattes = *film.layers.Find<MatteLayer>(), rows, isDenoised](
               int y, std::span<float> row) {
        rows(y, row);
        for (size_t x = 0; x < row.size() / 3; ++x) {
            const Vec2i p = film.Region().min + Vec2i(int(x), y);
            const AlphaPixel& matte = mattes.AlphaAt(p);
            RemoveBackground(film.At(p), matte.background, matte.covered, isDenoised, &row[3 * x]);
        }
    };
}

std::vector<float> ValuesOf(const RowSource& rows, const ExrImage& exr) {
    const size_t stride = 3 * size_t(exr.width);
    std::vector<float> values(stride * size_t(exr.height));
    for (int y = 0; y < exr.height; ++y)
        rows(y, std::span(values).subspan(size_t(y) * stride, stride));
    return values;
}

// Adds alpha to rows of R, G, B, which are moved apart for it from the last pixel on.
RowSource WithAlpha(const RowSource& rows, const Film& film) {
    return [&film, &mattes = *film.layers.Find<MatteLayer>(), rows](int y, std::span<float> row) {
        rows(y, row.first(row.size() / 4 * 3));
        for (size_t x = row.size() / 4; x-- > 0;) {
            for (size_t c = 3; c-- > 0;) row[4 * x + c] = row[3 * x + c];
            row[4 * x + 3] = mattes.AlphaAt(film.Region().min + Vec2i(int(x), y)).Alpha();
        }
    };
}

RowSource SppOf(const Film& film) {
    return [&film](int y, std::span<float> row) {
        for (size_t x = 0; x < row.size(); ++x)
            row[x] = float(film.At(film.Region().min + Vec2i(int(x), y)).count);
    };
}

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

}  // namespace

RowSource MeansOf(const RgbImage& image) {
    return [&image](int y, std::span<float> row) {
        std::copy_n(&image.values[size_t(y) * row.size()], row.size(), row.begin());
    };
}

namespace {

std::string FileOfEye(const std::string& file, const std::string& eye) {
    const std::filesystem::path path(file);
    return (path.parent_path() / (path.stem().string() + "." + eye + path.extension().string()))
        .string();
}

RowSource HalfOf(const RowSource& rows, int width, int values, bool isRight) {
    return [=](int y, std::span<float> row) {
        std::vector<float> whole(size_t(2 * width * values));
        rows(y, whole);
        std::copy_n(whole.begin() + (isRight ? std::ptrdiff_t(row.size()) : 0), row.size(),
                    row.begin());
    };
}

ExrImage ImageOfEye(const ExrImage& pair, const Camera& camera, const FilmSettings& film,
                    bool isRight) {
    ExrImage eye = pair;
    eye.width = pair.width / 2;
    for (size_t c = 4; c < eye.channels.size(); ++c) {
        const std::vector<float>& values = pair.channels[c].values;
        std::vector<float> own(size_t(eye.width) * size_t(eye.height));
        for (int y = 0; y < eye.height; ++y)
            std::copy_n(values.begin() + (2 * y + isRight) * eye.width, eye.width,
                        own.begin() + y * eye.width);
        eye.channels[c].values = std::move(own);
    }
    eye.attributes["view"] = isRight ? "right" : "left";
    eye.attributes["worldToCamera"] = WorldToCamera(camera);
    if (const auto ndc = WorldToNdc(camera, film)) eye.attributes["worldToNDC"] = *ndc;
    return eye;
}

int64_t WritePair(const PictureFiles& files, const Scene& scene, const ExrImage& exr,
                  const RowSource& colours, const RowSource& spp, const RowSource& shown,
                  const PngFormat& png, ResultFiles* results) {
    const int width = exr.width / 2, channels = png.hasAlpha ? 4 : 3;
    std::vector<ExrImage> eyes;
    std::vector<RowSource> rows;
    int64_t clamped = 0;
    eyes.reserve(2);  // rows refer to them
    for (const bool isRight : {false, true}) {
        eyes.push_back(
            ImageOfEye(exr, isRight ? *scene.rightEye : scene.camera, scene.film, isRight));
        rows.push_back(ChannelsOf(eyes.back(), HalfOf(colours, width, 3, isRight),
                                  HalfOf(spp, width, 1, isRight)));
    }
    std::vector<ResultFiles::File> all = {
        {files.exr, [&](const std::string& file) { clamped = WriteExr(file, eyes, rows); }},
        {files.png,
         [&](const std::string& file) { WritePng(file, shown, exr.width, exr.height, png); }}};
    for (const bool isRight : {false, true})
        all.push_back({FileOfEye(files.png, isRight ? "right" : "left"),
                       [&, isRight](const std::string& file) {
                           WritePng(file, HalfOf(shown, width, channels, isRight), width,
                                    exr.height, png);
                       }});
    results->WriteAll(all);
    return clamped;
}

}  // namespace

int64_t WriteImage(const PictureFiles& files, const PictureOrigin& origin, Picture picture,
                   ResultFiles* results) {
    const Film& film = picture.film;
    const DenoisedImage* denoised = picture.denoised;
    const PictureFormat& format = picture.format;
    ExrImage exr = MakeExr(origin, film, picture.result);
    if (denoised) {
        const RowSource noisy =
            format.isTransparent ? WithoutBackground(MeansOf(film), false, film) : MeansOf(film);
        std::ranges::move(MakeDenoisedChannels(*denoised, ValuesOf(noisy, exr)),
                          std::back_inserter(exr.channels));
        exr.attributes["denoised"] = kDenoisedNote;
    }
    std::ranges::move(picture.layers.channels, std::back_inserter(exr.channels));
    exr.attributes.insert(picture.layers.attributes.begin(), picture.layers.attributes.end());
    ApplyTo(&exr, format);
    RowSource colours = denoised ? MeansOf(denoised->image) : MeansOf(film);
    const RgbImage foreground{exr.width, exr.height, std::move(picture.layers.colours)};
    if (format.isTransparent) {
        colours = foreground.values.empty() ? WithoutBackground(colours, denoised != nullptr, film)
                                            : MeansOf(foreground);
        exr.attributes["background"] = "left out of R, G and B, which are multiplied by A";
    }
    const RowSource shown = format.isTransparent ? WithAlpha(colours, film) : colours;
    const PngFormat png = MakePngFormat(format, origin.scene.film.exposure);
    if (origin.scene.rightEye)
        return WritePair(files, origin.scene, exr, colours, SppOf(film), shown, png, results);
    int64_t clamped = 0;
    results->WriteAll({{files.exr,
                        [&](const std::string& file) {
                            clamped = WriteExr(file, exr, ChannelsOf(exr, colours, SppOf(film)));
                        }},
                       {files.png, [&](const std::string& file) {
                            WritePng(file, shown, film.Region().Width(), film.Region().Height(),
                                     png);
                        }}});
    return clamped;
}

void WriteImage(const PictureFiles& files, const PictureOrigin& origin,
                const ImageOfBlocks& picture, ResultFiles* results) {
    const RgbImage& image = picture.image;
    const PixelRect& region = origin.provenance.crop;
    int64_t samples = 0;
    for (size_t i = 0; i < picture.blocks.size(); ++i)
        samples += picture.blocks[i].pixels.Area() * picture.spp[i];
    const ExrImage exr = MakeExr(origin, region, samples, picture.seconds);
    const RowSource means = MeansOf(image), spp = SppOf(region, picture.blocks, picture.spp);
    if (origin.scene.rightEye) {
        WritePair(files, origin.scene, exr, means, spp, means, {}, results);
        return;
    }
    results->Write(files.exr, [&](const std::string& file) {
        WriteExr(file, exr, ChannelsOf(exr, means, spp));
    });
    results->Write(files.png, [&](const std::string& file) {
        WritePng(file, means, image.width, image.height);
    });
}

PixelRect DataWindow(const ExrImage& image) {
    return {image.origin, image.origin + Vec2i(image.width, image.height)};
}

PixelRect ShownWindow(const ExrImage& image, const std::string& file) {
    const bool isOwn = image.attributes.contains("criterion");
    if (isOwn || image.displaySize.minCoeff() < 1) return DataWindow(image);
    constexpr int kMostSide = 1 << 16;
    const PixelRect window{{0, 0}, image.displaySize};
    const std::string size = fmt::format("{}x{}", window.Width(), window.Height());
    if (image.displaySize.maxCoeff() > kMostSide)
        throw Error("{}: its display window of {} pixels is absurd", file, size);
    CheckMemory(window.Area() * int64_t(image.channels.size() * sizeof(float)),
                fmt::format("{}, whose display window has {} pixels,", file, size),
                "use a smaller version of it");
    return window;
}

std::vector<float> MovedTo(const PixelRect& window, const PixelRect& data, int channels,
                           const std::vector<float>& values) {
    if (window == data) return values;
    std::vector<float> moved(size_t(window.Area()) * size_t(channels));
    const Vec2i least = window.min.cwiseMax(data.min), most = window.max.cwiseMin(data.max);
    if ((least.array() >= most.array()).any()) return moved;
    const auto at = [&](const PixelRect& rect, int y) {
        return (int64_t(y - rect.min.y()) * rect.Width() + least.x() - rect.min.x()) * channels;
    };
    for (int y = least.y(); y < most.y(); ++y)
        std::copy_n(values.begin() + at(data, y), (most.x() - least.x()) * channels,
                    moved.begin() + at(window, y));
    return moved;
}

void MoveTo(const PixelRect& window, ExrImage* image) {
    const PixelRect data = DataWindow(*image);
    if (window == data) return;
    for (ExrChannel& channel : image->channels)
        channel.values = MovedTo(window, data, 1, channel.values);
    image->origin = window.min;
    image->width = window.Width();
    image->height = window.Height();
}

}  // namespace lull
