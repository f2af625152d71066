#include "renderer/render/film_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "renderer/base/error.h"

namespace lull {

namespace {

constexpr std::array<const char*, kColours> kColourNames = {"R", "G", "B"};
constexpr std::array<const char*, kFeatures> kFeatureNames = {
    "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "disparity"};
constexpr const char* kVarianceName = "variance.Y";

Halves MakeHalves(int width, int height, int count) {
    return {Planes(width, height, count), Planes(width, height, count)};
}

// Returns the variance of the mean luminance, from the sum of the samples' squares; finite.
float VarianceOfMean(double squares, double mean, double count) {
    const double variance = std::max(0.0, squares / count - mean * mean) / (count - 1);
    return float(std::min(variance, double(std::numeric_limits<float>::max())));
}

// Says how sums over both halves of a pixel's samples become means.
struct Split {
    bool isSplit;  // otherwise there are too few samples, and both have the mean of all
    double inA, inB;

    void Put(double a, double b, int channel, const Vec2i& p, Halves* to) const {
        const double both = (a + b) / (inA + inB);
        to->a.Row(channel, p.y())[p.x()] = float(isSplit ? a / inA : both);
        to->b.Row(channel, p.y())[p.x()] = float(isSplit ? b / inB : both);
    }
};

// Calls use(split, pixel, p) for each pixel p that has samples.
template <typename Use>
void ForEachSampled(const Film& film, const PixelRect& rect, const Use& use) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x) {
            const FilmPixel pixel = film.At({x, y});
            if (pixel.count == 0) continue;
            const double inA = HalfCount(pixel.count);
            use(Split{pixel.count >= leastDenoisedSpp, inA, pixel.count - inA}, pixel, Vec2i(x, y));
        }
}

Halves FeatureRows(const Film& film, const FeatureFilm& features, const PixelRect& rect) {
    Halves halves = MakeHalves(rect.Width(), rect.Height(), kFeatures);
    ForEachSampled(film, rect, [&](const Split& split, const FilmPixel&, const Vec2i& p) {
        const FeaturePixel& feature = features.At(p);
        for (int f = 0; f < kFeatures; ++f)
            split.Put(feature.sums[0][size_t(f)], feature.sums[1][size_t(f)], f, p - rect.min,
                      &halves);
    });
    return halves;
}

Planes VarianceOfMeans(const Film& film, const FeatureFilm& features, const PixelRect& rect) {
    Planes variance(rect.Width(), rect.Height(), 1);
    ForEachSampled(film, rect, [&](const Split& split, const FilmPixel& pixel, const Vec2i& p) {
        if (split.isSplit)
            variance.Row(0, p.y() - rect.min.y())[p.x() - rect.min.x()] =
                VarianceOfMean(features.At(p).squares, Luminance(pixel.Mean()), pixel.count);
    });
    return variance;
}

template <size_t N>
void AddChannels(const std::string& layer, const Planes& planes,
                 const std::array<const char*, N>& names, std::vector<ExrChannel>* channels) {
    for (size_t c = 0; c < N; ++c)
        channels->push_back(
            {layer + names[c], {planes.Plane(int(c)), planes.Plane(int(c)) + planes.Area()}});
}

// The values of channels; null where there are none.
template <size_t N>
using ChannelsOf = std::array<const float*, N>;

// Returns channels that must be there.
template <size_t N>
ChannelsOf<N> Channels(const ExrImage& image, const std::string& file, const std::string& layer,
                       const std::array<const char*, N>& names) {
    ChannelsOf<N> channels;
    for (size_t c = 0; c < N; ++c) {
        const ExrChannel* found = image.Find(layer + names[c]);
        if (!found)
            throw Error(
                fmt::format("{}: it has no channel '{}'; `lull render --denoise-layers` writes "
                            "all that is needed to denoise a picture later",
                            file, layer + names[c]));
        channels[c] = found->values.data();
    }
    return channels;
}

void Copy(const ChannelsOf<kColours>& channels, Planes* to) {
    for (int c = 0; c < kColours; ++c) std::copy_n(channels[size_t(c)], to->Area(), to->Plane(c));
}

// Filters the features of an image, of which the last becomes what `disparityOf` makes of it.
Planes ReadFeatures(
    const ExrImage& image, const ChannelsOf<kFeatures>& a, const ChannelsOf<kFeatures>& b,
    float (*disparityOf)(float) = [](float d) { return d; }) {
    const size_t width = size_t(image.width);
    return FilterFeatures(image.width, image.height, [&](int y0, int y1) {
        Halves rows = MakeHalves(image.width, y1 - y0, kFeatures);
        const auto copy = [&](const ChannelsOf<kFeatures>& from, Planes* to) {
            for (int f = 0; f < kFeatures; ++f)
                if (const float* values = from[size_t(f)])
                    std::copy_n(values + size_t(y0) * width, to->Area(), to->Plane(f));
            float* disparity = to->Plane(kFeatures - 1);
            std::transform(disparity, disparity + to->Area(), disparity, disparityOf);
        };
        copy(a, &rows.a);
        copy(b, &rows.b);
        return rows;
    });
}

}  // namespace

NoisyPicture PictureOf(const Film& film, const FeatureFilm& features, const PixelRect& rect) {
    NoisyPicture picture = FeaturesOf(film, features, rect);
    picture.colour = ColoursOf(film, rect);
    return picture;
}

NoisyPicture FeaturesOf(const Film& film, const FeatureFilm& features, const PixelRect& rect) {
    const auto read = [&](int y0, int y1) {
        return FeatureRows(film, features,
                           {rect.min + Vec2i(0, y0), {rect.max.x(), rect.min.y() + y1}});
    };
    return {{},
            FilterFeatures(rect.Width(), rect.Height(), read),
            VarianceOfMeans(film, features, rect)};
}

Halves ColoursOf(const Film& film, const PixelRect& rect) {
    Halves colour = MakeHalves(rect.Width(), rect.Height(), kColours);
    ForEachSampled(film, rect, [&](const Split& split, const FilmPixel& pixel, const Vec2i& p) {
        for (int c = 0; c < kColours; ++c) {
            const double half = pixel.halfSum[size_t(c)];
            split.Put(half, pixel.sum[size_t(c)] - half, c, p - rect.min, &colour);
        }
    });
    return colour;
}

std::vector<ExrChannel> MakeHalfChannels(const Film& film, const FeatureFilm& features,
                                         const PixelRect& rect) {
    std::vector<ExrChannel> channels;
    const auto add = [&](const Halves& halves, const auto& names) {
        AddChannels("halfA.", halves.a, names, &channels);
        AddChannels("halfB.", halves.b, names, &channels);
    };
    add(ColoursOf(film, rect), kColourNames);
    add(FeatureRows(film, features, rect), kFeatureNames);
    channels.push_back({kVarianceName, VarianceOfMeans(film, features, rect).values});
    return channels;
}

NoisyPicture ReadPicture(const ExrImage& image, const std::string& name) {
    NoisyPicture picture{MakeHalves(image.width, image.height, kColours),
                         ReadFeatures(image, Channels(image, name, "halfA.", kFeatureNames),
                                      Channels(image, name, "halfB.", kFeatureNames)),
                         {}};
    Copy(Channels(image, name, "halfA.", kColourNames), &picture.colour.a);
    Copy(Channels(image, name, "halfB.", kColourNames), &picture.colour.b);
    if (const ExrChannel* variance = image.Find(kVarianceName)) {
        picture.variance = Planes(image.width, image.height, 1);
        picture.variance.values = variance->values;
    }
    return picture;
}

NoisyPicture ReadPicture(const ExrImage& a, const std::string& nameOfA, const ExrImage& b,
                         const std::string& nameOfB) {
    if (a.width != b.width || a.height != b.height)
        throw Error(
            fmt::format("{} has {}x{} pixels and {} has {}x{}: they are to be of the same "
                        "picture",
                        nameOfA, a.width, a.height, nameOfB, b.width, b.height));
    NoisyPicture picture{MakeHalves(a.width, a.height, kColours), {}, {}};
    Copy(Channels(a, nameOfA, "", kColourNames), &picture.colour.a);
    Copy(Channels(b, nameOfB, "", kColourNames), &picture.colour.b);
    ChannelsOf<kFeatures> featuresOfA = {}, featuresOfB = {};
    for (size_t f = 0; f < kFeatures; ++f) {
        const std::string name = f == kFeatures - 1 ? "Z" : kFeatureNames[f];
        if (!a.Find(name) || !b.Find(name)) continue;
        featuresOfA[f] = a.Find(name)->values.data();
        featuresOfB[f] = b.Find(name)->values.data();
    }
    picture.features = ReadFeatures(a, featuresOfA, featuresOfB, DisparityOf);
    return picture;
}

}  // namespace lull
