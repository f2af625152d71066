#include "renderer/film/matte_layer.h"

#include <gtest/gtest.h>

namespace lull {
namespace {

FirstHit HitOf(uint32_t object, float weight = 1) {
    return {.object = object, .material = object + 10, .found = true, .weight = weight};
}

TEST(MatteLayer, CountsWhatIsCoveredByWeight) {
    AlphaPixel pixel;
    EXPECT_EQ(pixel.Alpha(), 0);
    pixel.Add(HitOf(1, 2), Rgb(1, 1, 1));
    EXPECT_EQ(pixel.Alpha(), 1);
    pixel.Add({.weight = 6}, Rgb(0.25f, 0.5f, 1));
    pixel.Add({.weight = -1}, Rgb(-0.25f, 0, 0));  // of a filter with negative lobes
    EXPECT_FLOAT_EQ(pixel.Alpha(), 2 / 7.f);
    EXPECT_EQ(pixel.background, (std::array<double, 3>{0, 0.5, 1}));
    // Never beyond 1.
    pixel.Add({.weight = -6}, Rgb::Zero());
    EXPECT_EQ(pixel.Alpha(), 1);
}

TEST(MatteLayer, SharesPixelsAmongObjects) {
    CryptoPixel pixel;
    for (const uint32_t object : {4u, 7u, 4u, 0u}) pixel.Add({.object = object, .material = 1});
    EXPECT_EQ(pixel.objects[0], (MatteShare{4, 2}));
    EXPECT_EQ(pixel.objects[1], (MatteShare{7, 1}));
    EXPECT_EQ(pixel.objects[2], MatteShare());
    EXPECT_EQ(pixel.materials[0], (MatteShare{1, 4}));
    // Those that come when all places are taken are left out.
    for (uint32_t object = 100; object < 120; ++object) pixel.Add(HitOf(object));
    EXPECT_EQ(pixel.objects.back().number, 105u);
}

}  // namespace
}  // namespace lull
