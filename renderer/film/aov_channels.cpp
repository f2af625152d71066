#include "renderer/film/aov_channels.h"

#include "stopping/signals/lightness.h"

namespace lull {

namespace {

// Returns the standard error in lightness of a pixel whose mean luminance is `mean`.
float Noise(const AovPixel& pixel, double mean, double count) {
    constexpr float kUnknown = 100;  // from black to white
    if (count < 2) return kUnknown;
    const double variance = std::max(0., pixel.squares / count - mean * mean) / (count - 1);
    const double noise = LightnessAt(mean).slope * std::sqrt(variance);
    return float(std::min(noise, double(std::numeric_limits<float>::max())));
}

// Makes a channel of `value(pixel, i)`.
template <typename Value>
ExrChannel MakeChannel(const std::string& name, const AovFilm& film, const Value& value) {
    ExrChannel channel{.name = name, .values = {}};
    channel.values.reserve(film.Pixels().size());
    size_t i = 0;
    for (const AovPixel& pixel : film.Pixels()) channel.values.push_back(float(value(pixel, i++)));
    return channel;
}

}  // namespace

std::vector<ExrChannel> MakeAovChannels(const AovFilm& aovs, const Film& film) {
    const AovSet& wanted = aovs.Wanted();
    const std::vector<float> counts = film.SppImage();
    std::vector<ExrChannel> channels;
    const auto add = [&](const std::string& name, const auto& value) {
        channels.push_back(MakeChannel(name, aovs, value));
    };
    const auto addMeans = [&](const std::string& layer, const char* components, auto member) {
        for (int c = 0; c < 3; ++c)
            add(layer + "." + components[c], [&, c](const AovPixel& pixel, size_t i) {
                return counts[i] > 0 ? (pixel.*member)[size_t(c)] / double(counts[i]) : 0.;
            });
    };
    if (wanted.albedo) addMeans("albedo", "RGB", &AovPixel::albedo);
    if (wanted.normal) addMeans("N", "XYZ", &AovPixel::normal);
    if (wanted.depth)
        add("Z", [](const AovPixel& pixel, size_t) {
            return pixel.hits > 0 ? pixel.depth / pixel.hits : double(kAovFarAway);
        });
    if (wanted.position)
        for (int c = 0; c < 3; ++c)
            add(std::string("P.") + "XYZ"[c], [c](const AovPixel& pixel, size_t) {
                return pixel.hits > 0 ? pixel.position[size_t(c)] / pixel.hits : 0.;
            });
    if (wanted.object) add("objectID", [](const AovPixel& pixel, size_t) { return pixel.object; });
    if (wanted.material)
        add("materialID", [](const AovPixel& pixel, size_t) { return pixel.material; });
    if (wanted.noise) {
        const std::vector<float> mean = film.MeanImage();
        add("noise", [&](const AovPixel& pixel, size_t i) {
            return Noise(pixel, Luminance(Rgb(mean[3 * i], mean[3 * i + 1], mean[3 * i + 2])),
                         counts[i]);
        });
    }
    return channels;
}

}  // namespace lull
