#include "renderer/image/files/exr_channels.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <tuple>

namespace lull {

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

}  // namespace lull
