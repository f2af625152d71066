// Compares bidirectional path tracing with pbrt-v3's own, of its random sampler: means of blocks of
// pixels, R + G + B, and their standard errors over pictures of different seeds.
#include <gtest/gtest.h>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/bdpt_image.h"
#include "tests/shared_folder.h"

namespace lull::bdpt_reference_test {
namespace {

struct Reference {
    double mean, error;
};

void Compare(const Scene& scene, const BdptShares& shares, int spp, int pictures, int side,
             std::span<const Reference> reference) {
    const BlockMeans ours = MeasureBlocks(scene, shares, spp, pictures, side);
    ASSERT_EQ(ours.mean.size(), reference.size());
    int out = 0;
    double difference = 0, variance = 0;
    for (size_t i = 0; i < reference.size(); ++i) {
        const double scale = double(scene.film.scale);
        const double d = scale * ours.mean[i].sum() - reference[i].mean;
        const double e = std::hypot(scale * ours.error[i].sum(), reference[i].error);
        difference += d;
        variance += e * e;
        // Half of a 16-bit float's last place is what the reference itself may be off by.
        out += std::abs(d) > 3.5 * e + 5e-4 * reference[i].mean;
    }
    EXPECT_LE(out, 1);
    EXPECT_LT(std::abs(difference), 4 * std::sqrt(variance)) << std::sqrt(variance);
}

constexpr BdptShares kWays[] = {{1, 1}, {0.3f, 0.1f}};

// 8 pictures of 512 spp.
TEST(BdptReference, LampInAGlassBall) {
    constexpr Reference kPbrt[] = {{0.05461, 0.00032}, {0.81948, 0.00116}, {1.15419, 0.00208},
                                   {0.10091, 0.00037}, {0.00000, 0.00000}, {0.63151, 0.00160},
                                   {0.67024, 0.00112}, {0.00000, 0.00000}, {0.05272, 0.00028},
                                   {0.52436, 0.00130}, {0.61689, 0.00139}, {0.07255, 0.00034}};
    const auto scene = SceneOf(R"(
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [45]
Film "image" "integer xresolution" [32] "integer yresolution" [24]
PixelFilter "box"
Integrator "bdpt" "integer maxdepth" [6]
WorldBegin
LightSource "point" "point from" [.2 .3 0] "rgb I" [3 2 1]
AttributeBegin
Material "glass" Translate .2 .3 0 Shape "sphere" "float radius" [.2]
AttributeEnd
Material "matte" "rgb Kd" [.7 .5 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 3 2 6 3 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 1 -1  1 1 -1  1 1 1  -1 1 1]
WorldEnd
)");
    for (const BdptShares& shares : kWays) Compare(*scene, shares, 32, 16, 8, kPbrt);
}

// 4 pictures of 40 spp, of at most 20 bounces.
TEST(BdptReference, CausticGlass) {
    constexpr Reference kPbrt[] = {
        {0.50965, 0.00101}, {0.83875, 0.00203}, {1.23039, 0.00311}, {1.09774, 0.00195},
        {0.68682, 0.00078}, {0.64467, 0.00268}, {0.64623, 0.00362}, {0.80414, 0.00134},
        {0.39788, 0.00191}, {1.11408, 0.00590}, {0.55299, 0.00305}, {0.62758, 0.00172},
        {0.54695, 0.00517}, {0.79440, 0.00363}, {0.33447, 0.00176}, {0.55139, 0.00123}};
    LULL_SHARED_FILE(file, "pbrt-scenes/caustic-glass/scene.pbrt");
    Warnings warnings;
    Description description = ParsePbrt(file.string(), warnings);
    description.integrator.name = "bdpt";
    CompileOptions options;
    options.film.resolution = Vec2i(96, 96);
    options.maxDepth = 20;
    const auto scene = Compile(description, options, warnings);
    for (const BdptShares& shares : kWays) Compare(*scene, shares, 4, 16, 24, kPbrt);
}

}  // namespace
}  // namespace lull::bdpt_reference_test
