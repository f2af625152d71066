#include "renderer/results/channel_names.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <initializer_list>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"

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
            "{}: colours are in several layers; keep one of them, or call its channels R, G and B. "
            "Its channels are {}",
            file, ListOfChannels(*image));
    ExrChannel* grey = Find(image, "Y");
    if (!grey)
        throw Error("{}: it has no channels R, G and B, nor Y; its channels are {}", file,
                    ListOfChannels(*image));
    const std::vector<float> values = grey->values;
    grey->name = "R";
    image->channels.push_back({"G", values});
    image->channels.push_back({"B", values});
}

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
            "{}: its colours have other primaries than those of Rec. 709; convert it to linear "
            "Rec. 709. Its channels are {}",
            file, ListOfChannels(image));
    if (HasAll(image, "", "RGB") || !image.Find("Y")) return;
    for (const char* channel : kBesideY)
        if (image.Find(channel))
            throw Error(
                "{}: Y and {} are colours of another space; convert it to R, G and B. Its channels "
                "are {}",
                file, channel, ListOfChannels(image));
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

namespace {

constexpr int kLayers = 3;  // of two ranks each

using Ids = std::map<uint32_t, uint32_t>;

// Returns the shares of a pixel by ids, the largest first.
std::vector<std::pair<float, float>> RanksOf(const std::array<MatteShare, kMatteShares>& shares,
                                             double weight, const Ids& ids) {
    std::map<uint32_t, double> byId;
    for (const MatteShare& share : shares)
        if (share.number != 0 && weight != 0)
            byId[ids.at(share.number)] += double(share.weight) / weight;
    std::vector<std::pair<float, float>> ranks;
    for (const auto& [id, coverage] : byId)
        if (coverage > 0)
            ranks.emplace_back(std::bit_cast<float>(id), float(std::min(coverage, 1.)));
    std::stable_sort(ranks.begin(), ranks.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return ranks;
}

}  // namespace

uint32_t MurmurHash3(std::string_view name) {
    constexpr uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
    const auto mixed = [](uint32_t k) { return std::rotl(k * c1, 15) * c2; };
    uint32_t h = 0;
    size_t i = 0;
    for (; i + 4 <= name.size(); i += 4) {
        uint32_t k = 0;
        for (size_t b = 0; b < 4; ++b) k |= uint32_t(uint8_t(name[i + b])) << (8 * b);
        h = std::rotl(h ^ mixed(k), 13) * 5 + 0xe6546b64;
    }
    uint32_t tail = 0;
    for (size_t b = 0; i + b < name.size(); ++b) tail |= uint32_t(uint8_t(name[i + b])) << (8 * b);
    h ^= mixed(tail);
    h ^= uint32_t(name.size());
    h = (h ^ h >> 16) * 0x85ebca6b;
    h = (h ^ h >> 13) * 0xc2b2ae35;
    return h ^ h >> 16;
}

uint32_t CryptomatteId(std::string_view name) {
    const uint32_t hash = MurmurHash3(name), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

LayerChannels MakeCryptomatte(const std::string& layer, const MatteLayer& mattes,
                              std::array<MatteShare, kMatteShares> CryptoPixel::*shares,
                              const std::function<std::string(uint32_t number)>& nameOf) {
    Ids ids;
    nlohmann::json manifest = nlohmann::json::object();
    for (const CryptoPixel& pixel : mattes.Crypto().Pixels())
        for (const MatteShare& share : pixel.*shares) {
            if (share.number == 0 || ids.contains(share.number)) continue;
            const std::string name = ToUtf8(nameOf(share.number));
            ids[share.number] = CryptomatteId(name);
            manifest[name] = fmt::format("{:08x}", ids[share.number]);
        }

    LayerChannels extra;
    for (int i = 0; i < kLayers; ++i)
        for (const char component : {'R', 'G', 'B', 'A'})
            extra.channels.push_back(
                {.name = fmt::format("{}{:02}.{}", layer, i, component),
                 .values = std::vector<float>(mattes.Alpha().Pixels().size())});
    for (size_t p = 0; p < mattes.Alpha().Pixels().size(); ++p) {
        const auto ranks =
            RanksOf(mattes.Crypto().Pixels()[p].*shares, mattes.Alpha().Pixels()[p].weight, ids);
        for (size_t i = 0; i < std::min(ranks.size(), size_t(2 * kLayers)); ++i) {
            extra.channels[2 * i].values[p] = ranks[i].first;
            extra.channels[2 * i + 1].values[p] = ranks[i].second;
        }
    }
    const std::string prefix =
        fmt::format("cryptomatte/{}/", fmt::format("{:08x}", CryptomatteId(layer)).substr(0, 7));
    extra.attributes = {{prefix + "name", layer},
                        {prefix + "hash", "MurmurHash3_32"},
                        {prefix + "conversion", "uint32_to_float32"},
                        {prefix + "manifest", manifest.dump()}};
    return extra;
}

}  // namespace lull
