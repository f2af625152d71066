// Layers of light groups, where pixels have samples, none, or a background that is left out.
#include "renderer/results/light_layers.h"

#include <gtest/gtest.h>

namespace lull::light_layers_test {
namespace {

const PixelRect kRegion = {{2, 3}, {4, 4}};  // two pixels

// Four samples of the first pixel, one of which sees past everything; none of the second.
struct Lights {
    Film film{kRegion, {}};
    MatteFilm mattes{kRegion, false};
    LightGroupFilm lights{kRegion, {{"lamp", "sky"}, {0, 1}}, {.withBackground = true}};

    Lights() {
        film.SetFirstLook({.spacing = 1, .colours = {Rgb::Constant(9), Rgb::Constant(3)}});
        FilmTile tile = film.Tile({{2, 3}, {3, 4}});
        FilmPixel pixel = tile.At({2, 3});
        for (uint32_t k = 0; k < 4; ++k) {
            GroupRadiance groups(lights.Groups());
            groups.Clear();
            if (k > 0) groups.Add(0, Rgb(4, 8, 12));
            groups.Add(1, Rgb(2, 2, 2));
            const Rgb radiance = groups.All()[0] + groups.All()[1];
            const Layers layers{.mattes = &mattes, .lights = &lights};
            layers.Add({2, 3}, k, {.found = k > 0, .weight = 1}, radiance, &groups);
            pixel.Add(radiance, false);
        }
        tile.Set({2, 3}, pixel);
    }
    ExtraLayers Make(const DenoisedImage* denoised, bool isTransparent) const {
        ExtraLayers extra;
        AddLightLayers(lights, film, denoised, isTransparent ? &mattes : nullptr, &extra);
        return extra;
    }
};

TEST(AddLightLayers, NamesMeansOfTheSamples) {
    const ExtraLayers extra = Lights().Make(nullptr, false);
    ASSERT_EQ(extra.channels.size(), 6u);
    EXPECT_EQ(extra.channels[1].name, "light.lamp.G");
    EXPECT_EQ(extra.channels[1].values, (std::vector<float>{6, 0}));
    EXPECT_EQ(extra.channels[3].name, "light.sky.R");
    EXPECT_EQ(extra.channels[3].values, (std::vector<float>{2, 3}));  // the first look
    EXPECT_EQ(std::get<std::string>(extra.attributes.at("lightGroups")), "lamp,sky");
    EXPECT_TRUE(extra.colours.empty());
}

TEST(AddLightLayers, LeavesOutTheBackground) {
    const ExtraLayers extra = Lights().Make(nullptr, true);
    EXPECT_EQ(extra.channels[1].values[0], 6);
    EXPECT_EQ(extra.channels[3].values[0], 1.5f);
}

TEST(AddLightLayers, SplitsDenoisedLightAsThatOfTheSamples) {
    DenoisedImage denoised{{2, 1, {}}, {}, {}};
    denoised.lights = {{3, 7, 9, 0, 0, 0}, {4, 4, 4, 3, 3, 3}};
    EXPECT_EQ(Lights().Make(&denoised, false).channels[1].values, (std::vector<float>{7, 0}));
    const ExtraLayers extra = Lights().Make(&denoised, true);
    EXPECT_EQ(extra.channels[1].values[0], 7);
    EXPECT_EQ(extra.channels[3].values[0], 3);
    EXPECT_EQ(extra.colours, (std::vector<float>{6, 10, 12, 3, 3, 3}));
}

}  // namespace
}  // namespace lull::light_layers_test
