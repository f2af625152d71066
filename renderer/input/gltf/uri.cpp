#include "renderer/input/gltf/uri.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace lull {
namespace {

constexpr std::string_view kScheme = "data:", kEncoding = "base64";
constexpr std::string_view kData = "data:application/octet-stream;base64,";

bool EqualsInLowerCase(std::string_view text, std::string_view lower) {
    return std::ranges::equal(text, lower, {},
                              [](char c) { return std::tolower(static_cast<unsigned char>(c)); });
}

bool IsHexDigit(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::string DecodeUri(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0'
                                    : std::tolower(static_cast<unsigned char>(c)) - 'a' + 10;
    };
    std::string decoded;
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool isCode =
            uri[i] == '%' && i + 2 < uri.size() && IsHexDigit(uri[i + 1]) && IsHexDigit(uri[i + 2]);
        decoded += isCode ? char(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
        if (isCode) i += 2;
    }
    return decoded;
}

bool IsDataUri(std::string_view uri) {
    return EqualsInLowerCase(uri.substr(0, kScheme.size()), kScheme);
}

std::optional<std::string> Base64Of(std::string_view dataUri) {
    const size_t comma = dataUri.find(',');
    if (comma == dataUri.npos || comma < kScheme.size()) return {};
    // Some leave out the semicolon along with the type.
    std::string_view type = dataUri.substr(kScheme.size(), comma - kScheme.size());
    if (const size_t start = type.rfind(';'); start != type.npos) type = type.substr(start + 1);
    if (!EqualsInLowerCase(type, kEncoding)) return {};
    std::string data(dataUri.substr(comma + 1));
    if (data.find('%') != data.npos) data = DecodeUri(data);
    std::erase_if(data, [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); });
    return data;
}

bool UnifyDataUris(nlohmann::json* root) {
    bool hasChanged = false;
    for (const char* owners : {"buffers", "images"}) {
        if (!root->contains(owners)) continue;
        for (nlohmann::json& owner : root->at(owners)) {
            if (!owner.contains("uri")) continue;
            auto& uri = owner.at("uri").get_ref<std::string&>();
            if (!IsDataUri(uri)) continue;
            std::string data = Base64Of(uri).value_or("");
            const bool isKnown = std::ranges::any_of(
                std::initializer_list<std::string_view>{
                    kData, "data:application/gltf-buffer;base64,", "data:image/png;base64,",
                    "data:image/jpeg;base64,"},
                [&](std::string_view known) {
                    return uri.starts_with(known) && uri.size() == known.size() + data.size();
                });
            if (isKnown) continue;
            uri = std::string(kData) + data;
            hasChanged = true;
        }
    }
    return hasChanged;
}

}  // namespace lull
