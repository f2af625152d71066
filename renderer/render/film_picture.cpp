#include "renderer/render/film_picture.h"

#include <fmt/format.h>

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

// Returns the variance of the mean luminance, from the sum of the samples' squares.
float VarianceOfMean(double squares, double mean, double count) {
    return float(std::max(0.0, squares / count - mean * mean) / (count - 1));
}

template <size_t N>
void AddChannels(const std::string& layer, const Planes& planes,
                 const std::array<const char*, N>& names, std::vector<ExrChannel>* channels) {
    for (size_t c = 0; c < N; ++c)
        channels->push_back(
            {layer + names[c], {planes.Plane(int(c)), planes.Plane(int(c)) + planes.Area()}});
}

// Copies a channel, which must be there.
void Copy(const ExrImage& image, const std::string& file, const std::string& channel, float* to) {
    const ExrChannel* found = image.Find(channel);
    if (!found)
        throw Error(
            fmt::format("{}: it has no channel '{}'; `lull render --denoise-layers` writes "
                        "all that is needed to denoise a picture later",
                        file, channel));
    std::ranges::copy(found->values, to);
}

template <size_t N>
void CopyAll(const ExrImage& image, const std::string& file, const std::string& layer,
             const std::array<const char*, N>& names, Planes* to) {
    for (size_t c = 0; c < N; ++c) Copy(image, file, layer + names[c], to->Plane(int(c)));
}

}  // namespace

NoisyPicture PictureOf(const Film& film, const FeatureFilm& features, const PixelRect& rect) {
    const int width = rect.Width(), height = rect.Height();
    NoisyPicture picture{MakeHalves(width, height, kColours), MakeHalves(width, height, kFeatures),
                         Planes(width, height, 1)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2i p = rect.min + Vec2i(x, y);
            const FilmPixel pixel = film.At(p);
            const FeaturePixel& feature = features.At(p);
            if (pixel.count == 0) continue;
            const bool isSplit = pixel.count >= leastDenoisedSpp;
            const double all = pixel.count, inA = HalfCount(pixel.count), inB = all - inA;
            for (int c = 0; c < kColours; ++c) {
                const double sum = pixel.sum[size_t(c)], half = pixel.halfSum[size_t(c)];
                picture.colour.a.Row(c, y)[x] = float(isSplit ? half / inA : sum / all);
                picture.colour.b.Row(c, y)[x] = float(isSplit ? (sum - half) / inB : sum / all);
            }
            for (int f = 0; f < kFeatures; ++f) {
                const double a = feature.sums[0][size_t(f)], b = feature.sums[1][size_t(f)];
                picture.features.a.Row(f, y)[x] = float(isSplit ? a / inA : (a + b) / all);
                picture.features.b.Row(f, y)[x] = float(isSplit ? b / inB : (a + b) / all);
            }
            if (isSplit)
                picture.variance.Row(0, y)[x] =
                    VarianceOfMean(feature.squares, Luminance(pixel.Mean()), all);
        }
    return picture;
}

std::vector<ExrChannel> MakeHalfChannels(const NoisyPicture& picture) {
    std::vector<ExrChannel> channels;
    AddChannels("halfA.", picture.colour.a, kColourNames, &channels);
    AddChannels("halfB.", picture.colour.b, kColourNames, &channels);
    AddChannels("halfA.", picture.features.a, kFeatureNames, &channels);
    AddChannels("halfB.", picture.features.b, kFeatureNames, &channels);
    if (picture.variance.count > 0) channels.push_back({kVarianceName, picture.variance.values});
    return channels;
}

NoisyPicture ReadPicture(const ExrImage& image, const std::string& name) {
    NoisyPicture picture{MakeHalves(image.width, image.height, kColours),
                         MakeHalves(image.width, image.height, kFeatures),
                         Planes(image.width, image.height, 1)};
    CopyAll(image, name, "halfA.", kColourNames, &picture.colour.a);
    CopyAll(image, name, "halfB.", kColourNames, &picture.colour.b);
    CopyAll(image, name, "halfA.", kFeatureNames, &picture.features.a);
    CopyAll(image, name, "halfB.", kFeatureNames, &picture.features.b);
    if (image.Find(kVarianceName))
        Copy(image, name, kVarianceName, picture.variance.Plane(0));
    else
        picture.variance = {};
    return picture;
}

NoisyPicture ReadPicture(const ExrImage& a, const std::string& nameOfA, const ExrImage& b,
                         const std::string& nameOfB) {
    if (a.width != b.width || a.height != b.height)
        throw Error(
            fmt::format("{} has {}x{} pixels and {} has {}x{}: they are to be of the same "
                        "picture",
                        nameOfA, a.width, a.height, nameOfB, b.width, b.height));
    NoisyPicture picture{
        MakeHalves(a.width, a.height, kColours), MakeHalves(a.width, a.height, kFeatures), {}};
    const auto read = [](const ExrImage& image, const std::string& name, const ExrImage& other,
                         Planes* colour, Planes* features) {
        CopyAll(image, name, "", kColourNames, colour);
        for (int f = 0; f < kFeatures - 1; ++f) {
            const std::string channel = kFeatureNames[size_t(f)];
            if (image.Find(channel) && other.Find(channel))
                Copy(image, name, channel, features->Plane(f));
        }
        if (!image.Find("Z") || !other.Find("Z")) return;
        float* disparity = features->Plane(kFeatures - 1);
        Copy(image, name, "Z", disparity);
        std::transform(disparity, disparity + features->Area(), disparity, DisparityOf);
    };
    read(a, nameOfA, b, &picture.colour.a, &picture.features.a);
    read(b, nameOfB, a, &picture.colour.b, &picture.features.b);
    return picture;
}

}  // namespace lull
