// Checks the parts of Cryptomattes.
#include "renderer/results/channel_names.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace lull {
namespace {

// Well-known values of the function's 32-bit variant with seed 0.
TEST(Cryptomatte, HashesAsMurmurHash3) {
    EXPECT_EQ(MurmurHash3(""), 0u);
    EXPECT_EQ(MurmurHash3("hello"), 0x248bfa47u);
    EXPECT_EQ(MurmurHash3("hello, world"), 0x149bbb7fu);
    EXPECT_EQ(MurmurHash3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, MakesIdsThatAreUsualFloats) {
    EXPECT_EQ(CryptomatteId("hello"), 0x248bfa47u);
    EXPECT_EQ(CryptomatteId(""), 0x00800000u);
    int changed = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::string name = std::to_string(i);
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(CryptomatteId(name))));
        changed += CryptomatteId(name) != MurmurHash3(name);
    }
    EXPECT_GT(changed, 0);
}

TEST(Cryptomatte, RanksSharesOfNames) {
    MatteLayer mattes({{0, 0}, {1, 1}}, {.aovs = {.cryptomatte = true}});
    const auto add = [&](uint32_t object, int count) {
        for (int i = 0; i < count; ++i)
            mattes.Add({0, 0}, {.hit = {.object = object, .found = object > 0}});
    };
    add(1, 2);
    add(2, 1);
    add(3, 3);
    add(0, 2);
    // The first two are parts of one thing.
    const LayerChannels layers =
        MakeCryptomatte("CryptoObject", mattes, &CryptoPixel::objects,
                        [](uint32_t n) { return n == 3 ? "a \"b\"\xff" : "whole"; });
    ASSERT_EQ(layers.channels.size(), 12u);
    EXPECT_EQ(layers.channels[0].name, "CryptoObject00.R");
    EXPECT_EQ(layers.channels[11].name, "CryptoObject02.A");
    const std::string odd = "a \"b\"\xef\xbf\xbd";  // what is not UTF-8 is replaced
    for (const size_t rank : {0, 1}) EXPECT_EQ(layers.channels[2 * rank + 1].values[0], 3 / 8.f);
    const auto idAt = [&](size_t i) {
        return std::bit_cast<uint32_t>(layers.channels[i].values[0]);
    };
    EXPECT_EQ(std::min(idAt(0), idAt(2)), std::min(CryptomatteId("whole"), CryptomatteId(odd)));
    EXPECT_EQ(std::max(idAt(0), idAt(2)), std::max(CryptomatteId("whole"), CryptomatteId(odd)));
    EXPECT_EQ(layers.channels[4].values[0], 0);
    const std::string prefix =
        "cryptomatte/" + fmt::format("{:08x}", CryptomatteId("CryptoObject")).substr(0, 7);
    EXPECT_EQ(std::get<std::string>(layers.attributes.at(prefix + "/name")), "CryptoObject");
    EXPECT_EQ(std::get<std::string>(layers.attributes.at(prefix + "/manifest")),
              fmt::format("{{\"a \\\"b\\\"\xef\xbf\xbd\":\"{:08x}\",\"whole\":\"{:08x}\"}}",
                          CryptomatteId(odd), CryptomatteId("whole")));
}

}  // namespace
}  // namespace lull
