#include "renderer/results/layer_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "renderer/base/error.h"
#include "renderer/results/channel_names.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

template <typename Visit>
void ForEachPixel(const PixelRect& region, const Visit& visit) {
    size_t i = 0;
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x) visit(i++, Vec2i(x, y));
}

template <typename Value>
ExrChannel MakeChannel(const std::string& name, const PixelRect& region, const Value& value) {
    ExrChannel channel{.name = name, .values = std::vector<float>(size_t(region.Area()))};
    ForEachPixel(region, [&](size_t i, const Vec2i& p) { channel.values[i] = float(value(p)); });
    return channel;
}

std::string NamesOf(const FirstHitLayer& hits, uint32_t NearestHit::*number,
                    const PixelRect& region, const std::function<std::string(uint32_t)>& name) {
    std::set<uint32_t> numbers;
    ForEachPixel(region,
                 [&](size_t, const Vec2i& p) { numbers.insert(hits.NearestAt(p).*number); });
    numbers.erase(0);
    nlohmann::ordered_json names = nlohmann::ordered_json::object();
    for (const uint32_t n : numbers) names[std::to_string(n)] = name(n);
    return names.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

double Noise(double squares, double mean, double count) {
    constexpr double kUnknown = 100;  // from black to white
    if (count < 2) return kUnknown;
    const double variance = std::max(0., squares / count - mean * mean) / (count - 1);
    const double noise = LightnessAt(mean).slope * std::sqrt(variance);
    return std::min(noise, double(std::numeric_limits<float>::max()));
}

std::vector<float> MeansOf(const LightGroupLayer& layer, int group, const Film& film) {
    std::vector<float> rgb(size_t(film.Region().Area()) * 3);
    ForEachPixel(film.Region(), [&](size_t i, const Vec2i& p) {
        const FilmPixel pixel = layer.At(group, p, film.At(p).count);
        const bool showsLook = pixel.count == 0 && layer.HasFirstLook(group);
        const Rgb mean = showsLook ? film.MeanAt(p) : pixel.Mean();
        std::copy_n(mean.data(), 3, &rgb[3 * i]);
    });
    return rgb;
}

void LeaveOutBackground(const LightGroupLayer& layer, int group, const FinishedFilm& finished,
                        std::vector<float>* rgb) {
    const Film& film = finished.film;
    const MatteLayer& mattes = *film.layers.Find<MatteLayer>();
    ForEachPixel(film.Region(), [&](size_t i, const Vec2i& p) {
        RemoveBackground(layer.At(group, p, film.At(p).count), layer.BackgroundAt(group, p),
                         mattes.AlphaAt(p).covered, finished.denoised != nullptr, &(*rgb)[3 * i]);
    });
}

// Returns names of layers that differ, in UTF-8: an EXR cuts those of channels off, silently.
std::vector<std::string> LayerNames(const std::vector<std::string>& groups) {
    constexpr size_t kLongest = 240;  // bytes; 255 with "light." and ".R"
    std::vector<std::string> names;
    for (const std::string& group : groups) {
        const std::string whole = ToUtf8(group);
        std::string name = whole;
        bool isLong = whole.size() > kLongest;
        for (int number = 1; isLong || std::ranges::count(names, name) > 0; ++number) {
            const std::string end = fmt::format("~{}", number);
            name = BeginningOf(whole, kLongest - end.size()) + end;
            isLong = false;
        }
        names.push_back(name);
    }
    return names;
}

}  // namespace

void LayerChannels::Append(LayerChannels more) {
    std::ranges::move(more.channels, std::back_inserter(channels));
    attributes.merge(more.attributes);
    if (!more.colours.empty()) colours = std::move(more.colours);
}

void RemoveBackground(const FilmPixel& pixel, const std::array<double, 3>& background,
                      double covered, bool isDenoised, float* rgb) {
    for (size_t c = 0; c < 3 && pixel.count > 0; ++c) {
        const double mean = pixel.sum[c] / pixel.count, removed = background[c] / pixel.count;
        if (covered == 0)
            rgb[c] = 0;
        else if (isDenoised)
            rgb[c] *= mean > 0 ? float(std::clamp((mean - removed) / mean, 0.0, 1.0)) : 0;
        else
            rgb[c] -= float(removed);
    }
}

LayerChannels ChannelsOf(const FirstHitLayer& hits, const FinishedFilm& finished) {
    const Film& film = finished.film;
    const PixelRect& region = film.Region();
    const AovSet& wanted = film.layers.Options().aovs;
    LayerChannels made;
    const auto add = [&](const std::string& name, const auto& value) {
        made.channels.push_back(MakeChannel(name, region, value));
    };
    const auto addMeans = [&](const std::string& layer, const char* components, auto member) {
        for (size_t c = 0; c < 3; ++c)
            add(layer + "." + components[c], [&, c](const Vec2i& p) {
                const uint32_t count = film.At(p).count;
                return count > 0 ? (hits.SurfaceAt(p).*member)[c] / double(count) : 0.;
            });
    };
    if (wanted.albedo) addMeans("albedo", "RGB", &SurfaceSums::albedo);
    if (wanted.normal) addMeans("N", "XYZ", &SurfaceSums::normal);
    if (wanted.depth)
        add("Z", [&](const Vec2i& p) {
            const PlaceSums& place = hits.PlaceAt(p);
            return place.hits > 0 ? place.depth / double(place.hits) : double(kAovFarAway);
        });
    for (size_t c = 0; c < 3 && wanted.position; ++c)
        add(std::string("P.") + "XYZ"[c], [&, c](const Vec2i& p) {
            const PlaceSums& place = hits.PlaceAt(p);
            return place.hits > 0 ? place.position[c] / double(place.hits) : 0.;
        });
    if (wanted.object) {
        add("objectID", [&](const Vec2i& p) { return hits.NearestAt(p).object; });
        made.attributes["objectNames"] =
            NamesOf(hits, &NearestHit::object, region, finished.nameOfObject);
    }
    if (wanted.material) {
        add("materialID", [&](const Vec2i& p) { return hits.NearestAt(p).material; });
        made.attributes["materialNames"] =
            NamesOf(hits, &NearestHit::material, region, finished.nameOfMaterial);
    }
    return made;
}

LayerChannels ChannelsOf(const SquareLayer& squares, const FinishedFilm& finished) {
    const Film& film = finished.film;
    LayerChannels made;
    if (film.layers.Options().aovs.noise)
        made.channels.push_back(MakeChannel("noise", film.Region(), [&](const Vec2i& p) {
            return Noise(squares.At(p), double(Luminance(film.MeanAt(p))), film.At(p).count);
        }));
    return made;
}

LayerChannels ChannelsOf(const MatteLayer& mattes, const FinishedFilm& finished) {
    const AovSet& wanted = finished.film.layers.Options().aovs;
    LayerChannels made;
    if (wanted.alpha)
        made.channels.push_back(MakeChannel("A", finished.film.Region(), [&](const Vec2i& p) {
            return mattes.AlphaAt(p).Alpha();
        }));
    if (wanted.cryptomatte) {
        made.Append(
            MakeCryptomatte("CryptoObject", mattes, &CryptoPixel::objects, finished.nameOfObject));
        made.Append(MakeCryptomatte("CryptoMaterial", mattes, &CryptoPixel::materials,
                                    finished.nameOfMaterial));
    }
    return made;
}

LayerChannels ChannelsOf(const LightGroupLayer& layer, const FinishedFilm& finished) {
    const Film& film = finished.film;
    const LightGroups& groups = film.layers.Options().groups;
    const DenoisedImage* denoised = finished.denoised;
    LayerChannels made;
    const std::vector<std::string> names = LayerNames(groups.names);
    made.attributes["lightGroups"] = fmt::format("{}", fmt::join(names, ","));
    if (finished.isTransparent && denoised) made.colours.resize(size_t(film.Region().Area()) * 3);
    for (int group = 0; group < layer.Count(); ++group) {
        std::vector<float> rgb =
            denoised ? denoised->groups[size_t(group)] : MeansOf(layer, group, film);
        if (finished.isTransparent) LeaveOutBackground(layer, group, finished, &rgb);
        std::ranges::transform(made.colours, rgb, made.colours.begin(), std::plus());
        std::ranges::move(ColourChannels("light." + names[size_t(group)] + ".", rgb),
                          std::back_inserter(made.channels));
    }
    return made;
}

LayerChannels ChannelsOf(const FinishedFilm& finished) {
    const Layers& layers = finished.film.layers;
    LayerChannels made;
    if (layers.Options().aovs.Any()) made.attributes["aov"] = TextOf(layers.Options().aovs);
    layers.ForEach([&](const auto& layer) { made.Append(ChannelsOf(layer, finished)); });
    return made;
}

}  // namespace lull
