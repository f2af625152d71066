#include "renderer/results/cryptomatte.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "renderer/base/utf8.h"

namespace lull {
namespace {

constexpr int kLayers = 3;  // of two ranks each

// The ids of the names of all numbers that occur.
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
