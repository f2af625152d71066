// What the denoiser needs of a picture goes through files.
#include "renderer/results/denoiser_channels.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/render/film_picture.h"
#include "tests/renderer/render/feature_render.h"

namespace lull {
namespace {

TEST(HalfChannels, AreReadAsTheyWere) {
    const FeatureRender render(1);
    const NoisyPicture picture = PictureOf(render.film, kPictureRegion);
    ExrImage exr;
    exr.width = 60;
    exr.height = 40;
    exr.channels = MakeHalfChannels(render.film, kPictureRegion);
    const NoisyPicture again = ReadPicture(exr, "a.exr");
    EXPECT_EQ(again.colour.a.values, picture.colour.a.values);
    EXPECT_EQ(again.features.values, picture.features.values);
    EXPECT_EQ(again.variance.values, picture.variance.values);
    EXPECT_EQ(again.emission.b.values, picture.emission.b.values);
    exr.channels.erase(exr.channels.begin());
    EXPECT_THROW(ReadPicture(exr, "a.exr"), Error);
}

}  // namespace
}  // namespace lull
