#include "renderer/film/layer.h"

#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

TEST(AovSet, HasNames) {
    EXPECT_EQ(
        NameOf(ParseAovs({"noise", "albedo", "normal", "depth", "position", "object", "material"})),
        "albedo,normal,depth,position,object,material,noise");
    EXPECT_TRUE(ParseAovs({"depth"}).Hits());
    EXPECT_FALSE(ParseAovs({"noise"}).Hits());
    EXPECT_TRUE(ParseAovs({"noise"}).Any());
    EXPECT_FALSE(AovSet().Any());
    for (const char* bad : {"", "Albedo", "albedo normal", "albedo,noise"})
        EXPECT_TRUE(Contains(ErrorOf([&] {
                                 ParseAovs({"depth", bad});
                             }),
                             "there is no layer"))
            << bad;
}

}  // namespace
}  // namespace lull
