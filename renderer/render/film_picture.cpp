#include "renderer/render/film_picture.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "renderer/denoise/denoise.h"
#include "renderer/denoise/planes.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

float VarianceOfMean(double squares, double mean, double count) {
    const double variance = std::max(0.0, squares / count - mean * mean) / (count - 1);
    return float(std::min(variance, double(std::numeric_limits<float>::max())));
}

// The light of all samples. At() returns the sums of a pixel, SquaresAt() the sum of the squares of
// its samples' luminance, and Look() its colour where it has no samples.
struct WholeLight {
    const Film& film;

    FilmPixel At(const Vec2i& p) const { return film.At(p); }
    double SquaresAt(const Vec2i& p) const { return film.layers.Find<SquareLayer>()->At(p); }
    Rgb Look(const Vec2i& p) const { return film.MeanAt(p); }
};

struct GroupLight {
    const Film& film;
    const LightGroupLayer& layer;
    int group;

    FilmPixel At(const Vec2i& p) const { return layer.At(group, p, film.At(p).count); }
    double SquaresAt(const Vec2i& p) const { return layer.SquaresAt(group, p); }
    Rgb Look(const Vec2i& p) const {
        return layer.HasFirstLook(group) ? film.MeanAt(p) : Rgb(Rgb::Zero());
    }
};

// Returns the mean of the four neighbours within `rect`, without empty ones; nothing if all are.
template <typename Light>
std::optional<Rgb> NeighbourMean(const Light& light, const PixelRect& rect, const Vec2i& p) {
    Rgb sum(0, 0, 0);
    int count = 0;
    for (const Vec2i& step : {Vec2i(-1, 0), Vec2i(1, 0), Vec2i(0, -1), Vec2i(0, 1)}) {
        const Vec2i q = p + step;
        if ((q.array() < rect.min.array()).any() || (q.array() >= rect.max.array()).any()) continue;
        const FilmPixel pixel = light.At(q);
        if (pixel.count == 0) continue;
        sum += pixel.Mean();
        ++count;
    }
    return count > 0 ? std::optional<Rgb>(sum / float(count)) : std::nullopt;
}

struct Split {
    bool isSplit;  // otherwise there are too few samples, and both have the mean of all
    double inA, inB;

    void Put(double a, double b, int channel, const Vec2i& p, Halves* to) const {
        const double both = (a + b) / (inA + inB);
        to->a.Row(channel, p.y())[p.x()] = float(isSplit ? a / inA : both);
        to->b.Row(channel, p.y())[p.x()] = float(isSplit ? b / inB : both);
    }
};

constexpr auto kSkip = [](const Vec2i&) {};

// Calls use(split, pixel, p) for pixels p with samples, useEmpty(p) for others, on all threads.
template <typename Light, typename Use, typename UseEmpty = decltype(kSkip)>
void ForEachPixel(const Light& light, const PixelRect& rect, const Use& use,
                  const UseEmpty& useEmpty = kSkip) {
    const auto doRow = [&](int y) {
        for (int x = rect.min.x(); x < rect.max.x(); ++x) {
            const FilmPixel pixel = light.At({x, y});
            if (pixel.count == 0) {
                useEmpty({x, y});
                continue;
            }
            const double inA = HalfCount(pixel.count);
            use(Split{pixel.count >= kLeastDenoisedSpp, inA, pixel.count - inA}, pixel,
                Vec2i(x, y));
        }
    };
    // Isolated, so that a thread that waits here takes up no other task of a render.
    tbb::this_task_arena::isolate(
        [&] { ForEachIndex(rect.Height(), [&](int i) { doRow(rect.min.y() + i); }); });
}

template <typename Light>
Halves ColoursOfLight(const Light& light, const PixelRect& rect) {
    Halves colour = MakeHalves(rect.Width(), rect.Height(), kColours);
    const auto put = [&](const Split& split, const FilmPixel& pixel, const Vec2i& p) {
        for (int c = 0; c < kColours; ++c) {
            const double half = pixel.halfSum[size_t(c)];
            split.Put(half, pixel.sum[size_t(c)] - half, c, p - rect.min, &colour);
        }
        if (split.isSplit) return;
        // Pixels take turns, as the fields of a chessboard, in which half is theirs; the other has
        // their neighbours'. So both halves are of different samples everywhere.
        const std::optional<Rgb> neighbours = NeighbourMean(light, rect, p);
        Planes& other = (p.x() + p.y()) % 2 == 0 ? colour.b : colour.a;
        for (int c = 0; c < kColours && neighbours; ++c)
            other.Row(c, p.y() - rect.min.y())[p.x() - rect.min.x()] = (*neighbours)[c];
    };
    const auto putFirstLook = [&](const Vec2i& p) {
        const Rgb look = light.Look(p);
        for (Planes* half : {&colour.a, &colour.b})
            for (int c = 0; c < kColours; ++c)
                half->Row(c, p.y() - rect.min.y())[p.x() - rect.min.x()] = look[c];
    };
    ForEachPixel(light, rect, put, putFirstLook);
    return colour;
}

template <typename Light>
Planes VarianceOfLight(const Light& light, const PixelRect& rect) {
    Planes variance(rect.Width(), rect.Height(), 1);
    ForEachPixel(light, rect, [&](const Split& split, const FilmPixel& pixel, const Vec2i& p) {
        float& v = variance.Row(0, p.y() - rect.min.y())[p.x() - rect.min.x()];
        if (split.isSplit)
            v = VarianceOfMean(light.SquaresAt(p), Luminance(pixel.Mean()), pixel.count);
        else if (const auto neighbours = NeighbourMean(light, rect, p))
            v = Sqr(Luminance(pixel.Mean() - *neighbours)) / 4;  // as of halves that differ so
    });
    return variance;
}

// Returns all but the colours. Calls forget(end), if given, when rows above `end` have been read.
NoisyPicture FeaturesOf(const Film& film, const PixelRect& rect,
                        const std::function<void(int end)>& forget = {}) {
    const auto read = [&](int y0, int y1) {
        return FeatureHalvesOf(film, {rect.min + Vec2i(0, y0), {rect.max.x(), rect.min.y() + y1}});
    };
    return {{},
            FilterFeatures(rect.Width(), rect.Height(), read, forget),
            VarianceOf(film, rect),
            EmissionOf(film, rect)};
}

NoisyPicture TakeFeatures(Film* film) {
    const int top = film->Region().min.y();
    int forgotten = 0;
    NoisyPicture picture = FeaturesOf(*film, film->Region(), [&](int end) {
        film->layers.ForgetFeatures(top + forgotten, top + end);
        forgotten = end;
    });
    film->layers.ForgetFeatures();
    return picture;
}

GroupedPicture GroupsOf(const Film& film, const PixelRect& rect, NoisyPicture all) {
    const LightGroupLayer& layer = *film.layers.Find<LightGroupLayer>();
    const auto light = [&film, &layer, rect](int group) -> NoisyPicture {
        const GroupLight own{film, layer, group};
        return {ColoursOfLight(own, rect), {}, VarianceOfLight(own, rect)};
    };
    return {layer.Count(), std::move(all.features), std::move(all.variance), light};
}

}  // namespace

NoisyPicture PictureOf(const Film& film, const PixelRect& rect) {
    NoisyPicture picture = FeaturesOf(film, rect);
    picture.colour = ColoursOf(film, rect);
    return picture;
}

NoisyPicture ReducedPictureOf(const Film& film, const PixelRect& region, int halvings) {
    const int scale = 1 << halvings;
    const auto reduced = [&](Planes image) {
        for (int i = 0; i < halvings; ++i) image = Halved(image);
        return image;
    };
    const auto reducedHalves = [&](const Halves& halves) {
        return Halves{reduced(halves.a), reduced(halves.b)};
    };
    // Returns the pixels of the film that rows of the result are made of.
    const auto rowsOf = [&](int y0, int y1) -> PixelRect {
        const int top = region.min.y();
        return {{region.min.x(), top + y0 * scale},
                {region.max.x(), std::min(region.max.y(), top + y1 * scale)}};
    };
    const int width = (region.Width() + scale - 1) / scale,
              height = (region.Height() + scale - 1) / scale;
    NoisyPicture picture{
        MakeHalves(width, height, kColours),
        FilterFeatures(
            width, height,
            [&](int y0, int y1) { return reducedHalves(FeatureHalvesOf(film, rowsOf(y0, y1))); }),
        Planes(width, height, 1),
        {}};
    constexpr int kRows = 16;
    for (int y = 0; y < height; y += kRows) {
        const PixelRect rows = rowsOf(y, std::min(height, y + kRows));
        const Halves colour = reducedHalves(ColoursOf(film, rows));
        Planes variance = reduced(VarianceOf(film, rows));
        for (float& v : variance.values) v /= float(scale * scale);
        const ImageTile tile{0, 0, width, colour.a.height};
        Paste(colour.a, tile, 0, y, &picture.colour.a);
        Paste(colour.b, tile, 0, y, &picture.colour.b);
        Paste(variance, tile, 0, y, &picture.variance);
    }
    return picture;
}

GroupedPicture GroupedPictureOf(const Film& film, const PixelRect& rect) {
    return GroupsOf(film, rect, FeaturesOf(film, rect));
}

NoisyPicture TakePicture(Film* film, const PixelRect& rect) {
    if (!(rect == film->Region())) return PictureOf(*film, rect);
    NoisyPicture picture = TakeFeatures(film);
    picture.colour = ColoursOf(*film, film->Region());
    film->DropHalf();
    return picture;
}

GroupedPicture TakeGroups(Film* film, const PixelRect& rect) {
    if (!(rect == film->Region())) return GroupedPictureOf(*film, rect);
    film->DropHalf();
    return GroupsOf(*film, film->Region(), TakeFeatures(film));
}

Halves ColoursOf(const Film& film, const PixelRect& rect) {
    return ColoursOfLight(WholeLight{film}, rect);
}

Halves FeatureHalvesOf(const Film& film, const PixelRect& rect) {
    const FirstHitLayer& hits = *film.layers.Find<FirstHitLayer>();
    Halves halves = MakeHalves(rect.Width(), rect.Height(), kFeatures);
    ForEachPixel(WholeLight{film}, rect, [&](const Split& split, const FilmPixel&, const Vec2i& p) {
        const auto& [a, b] = hits.FeaturesAt(p).halves;
        for (int f = 0; f < kFeatures; ++f)
            split.Put(a[size_t(f)], b[size_t(f)], f, p - rect.min, &halves);
    });
    return halves;
}

Halves EmissionOf(const Film& film, const PixelRect& rect) {
    const auto* layer = film.layers.Find<EmissionLayer>();
    if (!layer) return {};
    Halves emission = MakeHalves(rect.Width(), rect.Height(), kColours);
    ForEachPixel(WholeLight{film}, rect, [&](const Split& split, const FilmPixel&, const Vec2i& p) {
        if (!split.isSplit) return;
        const auto& [a, b] = layer->At(p).halves;
        // Zeros that are not written take no memory.
        for (int c = 0; c < kColours && layer->At(p) != EmissionSums(); ++c)
            split.Put(a[size_t(c)], b[size_t(c)], c, p - rect.min, &emission);
    });
    return emission;
}

Planes VarianceOf(const Film& film, const PixelRect& rect) {
    return VarianceOfLight(WholeLight{film}, rect);
}

namespace {

constexpr int kSpacing = 4;  // pixels

bool HasAllSamples(const Film& film) {
    const PixelRect& region = film.Region();
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x)
            if (film.At({x, y}).count == 0) return false;
    return true;
}

}  // namespace

void TakeFirstLook(const SampleSource& source, const RenderOptions& options, Film* film) {
    if (HasAllSamples(*film)) return;
    const std::vector<PixelRect> eyes = EyesOf(film->Region(), options.schedule.eyeWidth);
    const int perEye = (eyes[0].Width() + kSpacing - 1) / kSpacing;
    const int columns = perEye * int(eyes.size());
    const int rows = (eyes[0].Height() + kSpacing - 1) / kSpacing;
    FirstLook look{kSpacing, std::vector<Rgb>(size_t(columns) * size_t(rows), Rgb(0, 0, 0)),
                   options.schedule.eyeWidth};
    const auto isCancelled = [&] { return options.isCancelled && options.isCancelled(); };
    const auto takeRow = [&](int row) {
        Sampler sampler = options.sampler;
        PathSample sample;
        for (int column = 0; column < columns && !isCancelled(); ++column) {
            const PixelRect& eye = eyes[size_t(column / perEye)];
            const Vec2i middle =
                kSpacing * Vec2i(column % perEye, row) + Vec2i(kSpacing, kSpacing) / 2;
            const Vec2i pixel = (eye.min + middle).cwiseMin(eye.max - Vec2i(1, 1));
            source(sampler, pixel, 0, &sample);
            look.colours[size_t(row) * size_t(columns) + size_t(column)] = sample.radiance;
        }
    };
    RunWithThreads(options.threads, [&] { ForEachIndex(rows, takeRow); });
    if (!isCancelled()) film->SetFirstLook(std::move(look));
}

DenoisedImage BlockDenoiser::Run(const PixelRect& pixels) const {
    const PixelRect whole{{0, 0}, {pixels.Width(), pixels.Height()}};
    // The picture in the end is a little better than that which is judged.
    const DenoiserOptions options{
        .effort = Effort::Quick, .withDeviation = false, .gradings = gradings};
    if (film->layers.Find<LightGroupLayer>())
        return RunDenoiser(GroupedPictureOf(*film, pixels), {&whole, 1}, options);
    return RunDenoiser(PictureOf(*film, pixels), {&whole, 1}, options);
}

VisibleError BlockDenoiser::MeasureBlock(int block) const {
    const PixelRect& pixels = blocks.at(size_t(block)).pixels;
    const DenoisedImage result = Run(pixels);
    if (showPicture) showPicture(pixels, result.image.values);
    return result.blocks.front().value();
}

SignalMeasure MeasureOf(std::shared_ptr<const BlockDenoiser> denoiser) {
    return [denoiser](const BlockView&, const BlockInfo& block) -> Signals {
        return denoiser->MeasureBlock(block.index).estimate;
    };
}

}  // namespace lull
