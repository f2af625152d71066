#include "renderer/results/denoised_image.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/denoise/denoise.h"
#include "renderer/denoise/visible_error.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/channel_names.h"

namespace lull {

std::vector<PixelRect> PlacesOf(const std::vector<Block>& blocks, const PixelRect& region) {
    std::vector<PixelRect> places;
    for (const Block& block : blocks)
        places.push_back({block.pixels.min - region.min, block.pixels.max - region.min});
    return places;
}

std::vector<float> RowsBeside(const std::vector<float>& left, const std::vector<float>& right,
                              size_t row) {
    std::vector<float> both;
    both.reserve(left.size() + right.size());
    for (size_t i = 0; i < left.size(); i += row)
        for (const std::vector<float>* side : {&left, &right})
            both.insert(both.end(), side->begin() + std::ptrdiff_t(i),
                        side->begin() + std::ptrdiff_t(i + row));
    return both;
}

namespace {

DenoisedImage Beside(const DenoisedImage& left, const DenoisedImage& right) {
    const int width = left.image.width;
    const auto join = [&](const std::vector<float>& a, const std::vector<float>& b, int channels) {
        return RowsBeside(a, b, size_t(width * channels));
    };
    DenoisedImage both{
        {2 * width, left.image.height, join(left.image.values, right.image.values, 3)},
        join(left.error, right.error, 1),
        left.blocks};
    both.blocks.insert(both.blocks.end(), right.blocks.begin(), right.blocks.end());
    for (size_t i = 0; i < left.groups.size(); ++i)
        both.groups.push_back(join(left.groups[i], right.groups[i], 3));
    return both;
}

}  // namespace

DenoisedImage DenoiseEyes(
    const PixelRect& region, const std::vector<Block>& blocks, int eyeWidth,
    const std::function<DenoisedImage(const PixelRect&, const std::vector<Block>&)>& denoise) {
    if (eyeWidth == 0) return denoise(region, blocks);
    const std::vector<PixelRect> eyes = EyesOf(region, eyeWidth);
    const auto middle = blocks.begin() + std::ptrdiff_t(blocks.size() / 2);
    const DenoisedImage left = denoise(eyes[0], {blocks.begin(), middle});
    return Beside(left, denoise(eyes[1], {middle, blocks.end()}));
}

DenoisedImage DenoisePreview(const Film& film, const PixelRect& region, int64_t mostPixels) {
    std::vector<Vec2i> sizes = {{region.Width(), region.Height()}};
    while (int64_t(sizes.back().x()) * sizes.back().y() > mostPixels)
        sizes.push_back((sizes.back() + Vec2i(1, 1)) / 2);
    if (sizes.size() == 1)
        return DenoiseImage(PictureOf(film, region), region, {}, {.effort = Effort::Quick});
    Planes picture =
        Denoise(ReducedPictureOf(film, region, int(sizes.size()) - 1), Effort::Quick).picture;
    for (size_t i = sizes.size() - 1; i-- > 0;)
        picture = Doubled(picture, sizes[i].x(), sizes[i].y());
    return {{picture.width, picture.height, Interleaved(picture)},
            std::vector<float>(picture.Area(), kUnknownError),
            {}};
}

std::string TextOf(const std::vector<std::optional<VisibleError>>& blocks, double accepted) {
    std::vector<double> estimate;
    double upper = 0;
    int64_t worstPixels = 0;
    double worst = 0;
    for (const auto& error : blocks) {
        if (!error) continue;
        estimate.push_back(error->estimate);
        upper = std::max(upper, error->upper);
        worstPixels += error->worstPixels;
        worst = std::max(worst, error->worst);
    }
    if (estimate.empty())
        return fmt::format(
            "visible difference unknown: blocks have less than {} pixels a side, or few samples",
            kSmallestMeasuredSide);
    std::ranges::sort(estimate);
    const bool isKnown = estimate.size() == blocks.size();
    std::string text = fmt::format(
        "visible difference from the true image at most about {:.2g} in half of the {}blocks{} and "
        "{:.2g} in all, probably nowhere above {:.2g} (threshold: {:.2g})",
        estimate[estimate.size() / 2], isKnown ? "" : fmt::format("{} ", estimate.size()),
        isKnown ? "" : " of which it is known", estimate.back(), upper, accepted);
    if (worstPixels == 1)
        text += fmt::format(", except for a pixel that may be wrong by {:.0f} in L*", worst);
    if (worstPixels > 1)
        text += fmt::format(", except for {} pixels that may be wrong by up to {:.0f} in L*",
                            worstPixels, worst);
    return text;
}

std::vector<ExrChannel> ColourChannels(const std::string& layer, std::span<const float> rgb) {
    std::vector<ExrChannel> channels;
    for (size_t c = 0; c < 3; ++c) {
        ExrChannel& channel = channels.emplace_back(ExrChannel{layer + "RGB" [c], {}});
        channel.values.reserve(rgb.size() / 3);
        for (size_t i = c; i < rgb.size(); i += 3) channel.values.push_back(rgb[i]);
    }
    return channels;
}

std::vector<ExrChannel> MakeDenoisedChannels(const DenoisedImage& image,
                                             std::span<const float> noisy) {
    std::vector<ExrChannel> channels = ColourChannels("noisy.", noisy);
    channels.push_back({"error", image.error});
    return channels;
}

namespace {

constexpr std::array<const char*, kColours> kColourNames = {"R", "G", "B"};
constexpr std::array<const char*, kFeatures> kFeatureNames = {
    "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "disparity"};
constexpr std::array<const char*, kColours> kEmissionNames = {"emission.R", "emission.G",
                                                              "emission.B"};
constexpr const char* kVarianceName = "variance.Y";

template <size_t N>
void AddChannels(const std::string& layer, const Planes& planes,
                 const std::array<const char*, N>& names, std::vector<ExrChannel>* channels) {
    for (size_t c = 0; c < N; ++c)
        channels->push_back(
            {layer + names[c], {planes.Plane(int(c)), planes.Plane(int(c)) + planes.Area()}});
}

// The values of channels; null where there are none.
template <size_t N>
using FoundChannels = std::array<const float*, N>;

template <size_t N>
FoundChannels<N> Channels(const ExrImage& image, const std::string& file, const std::string& layer,
                          const std::array<const char*, N>& names) {
    FoundChannels<N> channels;
    for (size_t c = 0; c < N; ++c) {
        const ExrChannel* found = image.Find(layer + names[c]);
        if (!found)
            throw Error(
                "{}: it has no channel '{}'; `lull render --denoise-layers` writes all that is "
                "needed to denoise a picture later, and images of other programs need a second "
                "render (--half). Its channels are {}",
                file, layer + names[c], ListOfChannels(image));
        channels[c] = found->values.data();
    }
    return channels;
}

void Copy(const FoundChannels<kColours>& channels, Planes* to) {
    for (int c = 0; c < kColours; ++c) std::copy_n(channels[size_t(c)], to->Area(), to->Plane(c));
}

Planes ReadFeatures(
    const ExrImage& image, const FoundChannels<kFeatures>& a, const FoundChannels<kFeatures>& b,
    float (*disparityOf)(float) = [](float d) { return d; }) {
    const size_t width = size_t(image.width);
    return FilterFeatures(image.width, image.height, [&](int y0, int y1) {
        Halves rows = MakeHalves(image.width, y1 - y0, kFeatures);
        const auto copy = [&](const FoundChannels<kFeatures>& from, Planes* to) {
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

std::vector<ExrChannel> MakeHalfChannels(const Film& film, const PixelRect& rect) {
    std::vector<ExrChannel> channels;
    const auto add = [&](const Halves& halves, const auto& names) {
        AddChannels("halfA.", halves.a, names, &channels);
        AddChannels("halfB.", halves.b, names, &channels);
    };
    add(ColoursOf(film, rect), kColourNames);
    add(FeatureHalvesOf(film, rect), kFeatureNames);
    if (const Halves emission = EmissionOf(film, rect); emission.a.count > 0)
        add(emission, kEmissionNames);
    AddChannels("", VarianceOf(film, rect), std::array{kVarianceName}, &channels);
    return channels;
}

NoisyPicture ReadPicture(const ExrImage& image, const std::string& name) {
    NoisyPicture picture{MakeHalves(image.width, image.height, kColours),
                         ReadFeatures(image, Channels(image, name, "halfA.", kFeatureNames),
                                      Channels(image, name, "halfB.", kFeatureNames)),
                         {},
                         {}};
    Copy(Channels(image, name, "halfA.", kColourNames), &picture.colour.a);
    Copy(Channels(image, name, "halfB.", kColourNames), &picture.colour.b);
    // Images of former versions have none.
    if (image.Find("halfA." + std::string(kEmissionNames[0]))) {
        picture.emission = MakeHalves(image.width, image.height, kColours);
        Copy(Channels(image, name, "halfA.", kEmissionNames), &picture.emission.a);
        Copy(Channels(image, name, "halfB.", kEmissionNames), &picture.emission.b);
    }
    if (const ExrChannel* variance = image.Find(kVarianceName)) {
        picture.variance = Planes(image.width, image.height, 1);
        std::ranges::copy(variance->values, picture.variance.values.begin());
    }
    return picture;
}

NoisyPicture ReadPicture(const ExrImage& a, const std::string& nameOfA, const ExrImage& b,
                         const std::string& nameOfB) {
    if (a.width != b.width || a.height != b.height)
        throw Error("{} has {}x{} pixels and {} has {}x{}: they are to be of the same picture",
                    nameOfA, a.width, a.height, nameOfB, b.width, b.height);
    if (a.origin != b.origin)
        throw Error("{} and {} show different parts of the picture", nameOfA, nameOfB);
    NoisyPicture picture{MakeHalves(a.width, a.height, kColours), {}, {}, {}};
    Copy(Channels(a, nameOfA, "", kColourNames), &picture.colour.a);
    Copy(Channels(b, nameOfB, "", kColourNames), &picture.colour.b);
    FoundChannels<kFeatures> featuresOfA = {}, featuresOfB = {};
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
