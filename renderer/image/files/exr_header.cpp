#include "renderer/image/files/exr_header.h"

#include <fmt/core.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>

#include "renderer/files/file_io.h"
#include "renderer/formats/formats.h"

namespace lull {
namespace {

const Primaries kRec709 = {{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3127f, 0.329f}};

Eigen::Vector3d XyzOf(const Vec2f& xy) {
    return {double(xy.x()), double(xy.y()), 1 - double(xy.x()) - double(xy.y())};
}

// Of luminance 1.
Eigen::Vector3d WhiteOf(const Primaries& p) { return XyzOf(p.white) / double(p.white.y()); }

Eigen::Matrix3d XyzFrom(const Primaries& p) {
    Eigen::Matrix3d columns;
    columns << XyzOf(p.red), XyzOf(p.green), XyzOf(p.blue);
    return columns * Eigen::Vector3d(columns.inverse() * WhiteOf(p)).asDiagonal();
}

}  // namespace

Eigen::Matrix3f Rec709From(const Primaries& primaries) {
    Eigen::Matrix3d cones;  // Bradford's
    cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
    const Eigen::Vector3d gain =
        (cones * WhiteOf(kRec709)).cwiseQuotient(cones * WhiteOf(primaries));
    const Eigen::Matrix3d adapted = cones.inverse() * gain.asDiagonal() * cones;
    return (XyzFrom(kRec709).inverse() * adapted * XyzFrom(primaries)).cast<float>();
}

namespace {

// Names with their position; those that nobody gives a meaning come last.
constexpr const char* kColours[] = {"r",    "red",  "g",  "green", "b",     "blue", "y",
                                    "real", "imag", "a",  "alpha", "ar",    "ra",   "ag",
                                    "ga",   "ab",   "ba", "z",     "depth", "zback"};
constexpr const char* kVectors[] = {"r",  "red", "g",    "green", "b",  "blue",  "x",
                                    "y",  "z",   "real", "imag",  "a",  "alpha", "ar",
                                    "ra", "ag",  "ga",   "ab",    "ba", "depth", "zback"};

struct Channel {
    std::string layer, name, lower;
    std::string full;

    explicit Channel(const std::string& full) : full(full) {
        const size_t dot = full.rfind('.');
        if (dot != std::string::npos) layer = full.substr(0, dot);
        name = lower = full.substr(dot + 1);  // npos + 1 is 0
        std::ranges::transform(lower, lower.begin(), [](char c) {
            return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
        });
    }
};

struct LayerColours {
    std::string layer;
    std::array<std::string, 4> names;
    bool hasLuma = false, hasChroma = false;

    void Add(const Channel& c) {
        constexpr const char* kNames[4][2] = {
            {"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}};
        for (size_t i = 0; i < 4; ++i)
            if ((c.lower == kNames[i][0] || c.lower == kNames[i][1]) && names[i].empty())
                names[i] = c.full;
        hasLuma |= c.lower == "y";
        hasChroma |= c.lower == "ry" || c.lower == "by";
    }
    size_t Count() const {
        return size_t(std::count_if(names.begin(), names.begin() + 3,
                                    [](const std::string& name) { return !name.empty(); }));
    }
    // Channels that the file lacks are read as 0.
    std::vector<std::string> Channels() const {
        std::vector<std::string> channels(names.begin(), names.end());
        for (size_t i = 0; i < 3; ++i)
            if (channels[i].empty())
                channels[i] = (layer.empty() ? "" : layer + ".") + std::string(1, "RGB"[i]);
        if (channels[3].empty()) channels.pop_back();
        return channels;
    }
};

std::vector<LayerColours> ColoursOf(const std::vector<std::string>& sorted) {
    std::vector<LayerColours> layers;
    for (const std::string& name : sorted) {
        const Channel channel(name);
        if (layers.empty() || layers.back().layer != channel.layer)
            layers.push_back({channel.layer, {}});
        layers.back().Add(channel);
    }
    return layers;
}

bool IsCombined(const LayerColours& colours) {
    return colours.layer == "Combined" || colours.layer.ends_with(".Combined");
}

void SortLayer(std::span<Channel> layer) {
    const auto has = [&](const char* lower) {
        return std::ranges::find(layer, lower, &Channel::lower) != layer.end();
    };
    const auto order = has("x") && (has("y") || has("z")) ? std::span<const char* const>(kVectors)
                                                          : std::span<const char* const>(kColours);
    std::ranges::sort(layer, {}, [&](const Channel& c) {
        return std::tuple(std::ranges::find(order, c.lower) - order.begin(), c.name);
    });
}

}  // namespace

void SortChannels(std::vector<std::string>* names) {
    std::vector<Channel> channels(names->begin(), names->end());
    std::ranges::stable_sort(channels, {}, &Channel::layer);
    for (auto begin = channels.begin(); begin != channels.end();) {
        const auto end = std::find_if(begin, channels.end(),
                                      [&](const Channel& c) { return c.layer != begin->layer; });
        SortLayer({begin, end});
        begin = end;
    }
    std::ranges::transform(channels, names->begin(), &Channel::full);
}

bool IsAlpha(const std::string& name) {
    const std::string lower = Channel(name).lower;
    return lower == "a" || lower == "alpha";
}

bool HasPlainColours(const std::vector<std::string>& names) {
    return std::ranges::all_of(std::array{"R", "G", "B"}, [&](const char* name) {
        return std::ranges::find(names, name) != names.end();
    });
}

std::vector<std::string> PictureChannels(const std::vector<std::string>& sorted) {
    std::vector<LayerColours> layers = ColoursOf(sorted);
    for (const LayerColours& l : layers)
        if (l.layer.empty() && l.Count() >= 2) return l.Channels();
    std::erase_if(layers, [](const LayerColours& l) {
        if (l.Count() == 0 && l.hasLuma && l.hasChroma)
            throw std::runtime_error(
                "its colours are luminance and chroma; convert it to R, G and B");
        return l.Count() < 3;
    });
    if (std::ranges::any_of(layers, IsCombined))
        std::erase_if(layers, [](const LayerColours& l) { return !IsCombined(l); });
    if (layers.size() == 1) return layers[0].Channels();
    if (layers.size() > 1)
        throw std::runtime_error("its colours are in several layers, such as " + layers[0].layer +
                                 " and " + layers[1].layer +
                                 "; keep one of them, or call its channels R, G and B");
    const auto alpha = std::ranges::find_if(sorted, IsAlpha);
    const int at = alpha == sorted.end() ? -1 : int(alpha - sorted.begin());
    const int count = CountChannels(int(sorted.size()), at);
    return {sorted.begin(), sorted.begin() + (count == 2 && at != 1 ? 1 : count)};
}

namespace {

class HeaderBytes {
  public:
    explicit HeaderBytes(std::span<const std::byte> file) : rest(file) {}

    size_t Rest() const { return rest.size(); }
    std::span<const std::byte> Take(size_t count) {
        if (count > rest.size()) throw std::runtime_error("it is cut short");
        const std::span<const std::byte> taken = rest.first(count);
        rest = rest.subspan(count);
        return taken;
    }
    // Little endian.
    uint32_t Integer() {
        uint32_t value = 0;
        const std::span<const std::byte> bytes = Take(4);
        for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[i]) << (8 * i);
        return value;
    }
    // Ends with a zero.
    std::string Text() {
        const size_t length = size_t(std::ranges::find(rest, std::byte{0}) - rest.begin());
        const char* text = reinterpret_cast<const char*>(Take(length + 1).data());
        return {text, length};
    }

  private:
    std::span<const std::byte> rest;
};

// The library reads the list to its end, wherever its attribute has its own.
void CheckChannels(std::span<const std::byte> list) {
    HeaderBytes bytes(list);
    while (!bytes.Text().empty()) bytes.Take(16);
    if (bytes.Rest() > 0) throw std::runtime_error("its list of channels is damaged");
}

}  // namespace

void CheckExrHeader(std::span<const std::byte> file) {
    HeaderBytes bytes(file);
    bytes.Take(4);  // the signature
    constexpr uint32_t kHasManyParts = 0x1000;
    const bool hasMany = bytes.Integer() & kHasManyParts;
    bool isEmpty = false;
    do {
        isEmpty = true;
        for (std::string name; !(name = bytes.Text()).empty(); isEmpty = false) {
            const std::string type = bytes.Text();
            const uint32_t size = bytes.Integer();
            if (size > bytes.Rest())
                throw std::runtime_error(
                    fmt::format("its attribute '{}' has {} bytes, of which {} are there",
                                Printable(name), size, bytes.Rest()));
            const std::span<const std::byte> value = bytes.Take(size);
            if (type == "chlist") CheckChannels(value);
        }
    } while (hasMany && !isEmpty);
}

}  // namespace lull
