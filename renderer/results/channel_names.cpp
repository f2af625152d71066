#include "renderer/results/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/files/file_contents.h"

namespace lull {

namespace {

ExrChannel* Find(ExrImage* image, const std::string& name) {
    const auto found = std::ranges::find(image->channels, name, &ExrChannel::name);
    return found == image->channels.end() ? nullptr : &*found;
}

bool HasAll(const ExrImage& image, const std::string& layer, std::string_view channels) {
    return std::ranges::all_of(channels, [&](char c) { return image.Find(layer + c) != nullptr; });
}

// Returns what comes before `channel` in the names of all channels that end so: "" and "A.B.".
std::vector<std::string> LayersWith(const ExrImage& image, const std::string& channels) {
    std::vector<std::string> layers;
    for (const ExrChannel& c : image.channels) {
        if (!c.name.ends_with(channels[0])) continue;
        const std::string layer = c.name.substr(0, c.name.size() - 1);
        if ((layer.empty() || layer.ends_with('.')) && HasAll(image, layer, channels))
            layers.push_back(layer);
    }
    return layers;
}

void Rename(const std::string& layer, const std::string& to, std::string_view channels,
            ExrImage* image) {
    for (const char c : channels)
        if (ExrChannel* channel = Find(image, layer + c); channel && !Find(image, to + c))
            channel->name = to + c;
}

bool IsPass(const std::string& layer, const std::string& pass) {
    return layer == pass + "." || layer.ends_with("." + pass + ".");
}

// Channels with which Y is no grey value.
constexpr std::array kBesideY = {"X", "RY", "BY", "U", "V", "Cb", "Cr", "Co", "Cg", "C", "M", "K"};

void UseColours(const std::string& file, ExrImage* image) {
    if (HasAll(*image, "", "RGB")) return;
    std::vector<std::string> layers = LayersWith(*image, "RGB");
    std::vector<std::string> combined;
    for (const std::string& layer : layers)
        if (IsPass(layer, "Combined")) combined.push_back(layer);
    if (!combined.empty()) layers = combined;
    if (layers.size() == 1) return Rename(layers[0], "", "RGBA", image);
    if (layers.size() > 1)
        throw Error(
            fmt::format("{}: colours are in several layers; keep one of them, or call its "
                        "channels R, G and B. Its channels are {}",
                        file, ListOfChannels(*image)));
    ExrChannel* grey = Find(image, "Y");
    if (!grey)
        throw Error(fmt::format("{}: it has no channels R, G and B, nor Y; its channels are {}",
                                file, ListOfChannels(*image)));
    const std::vector<float> values = grey->values;
    grey->name = "R";
    image->channels.push_back({"G", values});
    image->channels.push_back({"B", values});
}

// Takes the first of the passes that is there.
void UsePass(std::initializer_list<const char*> passes, const std::string& to,
             std::string_view channels, ExrImage* image) {
    if (HasAll(*image, to, channels)) return;
    for (const char* pass : passes)
        for (const std::string& layer : LayersWith(*image, std::string(channels)))
            if (IsPass(layer, pass)) return Rename(layer, to, channels, image);
}

}  // namespace

void CheckColours(const std::string& file, const ExrImage& image) {
    if (image.attributes.contains("chromaticities"))
        throw Error(
            fmt::format("{}: its colours have other primaries than those of Rec. 709; "
                        "convert it to linear Rec. 709. Its channels are {}",
                        file, ListOfChannels(image)));
    if (HasAll(image, "", "RGB") || !image.Find("Y")) return;
    for (const char* channel : kBesideY)
        if (image.Find(channel))
            throw Error(
                fmt::format("{}: Y and {} are colours of another space; convert it to R, G "
                            "and B. Its channels are {}",
                            file, channel, ListOfChannels(image)));
}

void UseOwnNames(const std::string& file, ExrImage* image) {
    CheckColours(file, *image);
    UseColours(file, image);
    UsePass({"Denoising Albedo"}, "albedo.", "RGB", image);
    UsePass({"Denoising Normal", "Normal"}, "N.", "XYZ", image);
    UsePass({"Denoising Depth", "Depth"}, "", "Z", image);
}

std::string ListOfChannels(const ExrImage& image) {
    constexpr size_t kMost = 20;
    std::string list;
    for (size_t i = 0; i < std::min(image.channels.size(), kMost); ++i)
        list += (i == 0 ? "" : ", ") + Printable(image.channels[i].name);
    if (image.channels.size() > kMost)
        list += fmt::format(" and {} others", image.channels.size() - kMost);
    return list;
}

}  // namespace lull
