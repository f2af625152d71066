// Checks that light paths, and what is learned of them, are the same with any number of ranks.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/renderer/render/ranks/shared_render.h"
#include "tests/renderer/scene_of.h"

namespace lull::ranks_test {
namespace {

// A render that is interrupted, goes on, or loses a rank.
struct Part {
    const Shared* before = nullptr;  // goes on from there
    Habits how = {};
    int64_t tiles = 1 << 30;  // of the first rank, which is then interrupted
    int checkpoints = 0;      // after which it is interrupted; 0: it is not
};

Shared RenderPart(const Scene& scene, int ranks, const Part& part = {}) {
    const Film whole(kImage);
    std::vector<std::unique_ptr<LightRounds>> lights(size_t(std::max(1, ranks)));
    for (std::unique_ptr<LightRounds>& light : lights)
        light = std::make_unique<LightRounds>(scene, whole, Sampler(SamplerKind::Random, 0));
    std::atomic<int64_t> left = part.tiles;
    int written = 0;
    const auto change = [&](RenderOptions* o, int rank) {
        o->lightRounds = lights[size_t(rank)].get();
        o->rankPatience = 1;
        o->schedule.cap = 90;
        if (rank > 0) return;
        o->isCancelled = [&] { return --left < 0; };
        if (part.checkpoints == 0) return;
        o->checkpoints.interval = 0;
        o->checkpoints.write = [&, write = o->checkpoints.write](const RenderState& state) {
            write(state);
            if (++written == part.checkpoints) left = 0;
        };
    };
    return RenderShared(
        ranks, change, part.before,
        [&](int rank) { return SamplesOf(scene, Estimator::Combined, lights[size_t(rank)].get()); },
        part.how);
}

// Each traces a part of the light of a round; one of them is given up in a round, or while light is
// traced, and three go on, within a round, from what two had. A ball under a lamp is seen from
// outside.
TEST(Ranks, ShareLightPaths) {
    const auto scene = SceneOf(R"(
Integrator "bdpt" "integer maxdepth" [3]
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [60]
Film "image" "integer xresolution" [80] "integer yresolution" [60]
WorldBegin
LightSource "infinite" "rgb L" [.2 .3 .4]
LightSource "point" "point from" [1 2 -2] "rgb I" [3 3 3]
Shape "sphere" "float radius" [1]
WorldEnd
)");
    const Shared reference = RenderPart(*scene, 0);
    ASSERT_FALSE(reference.result.cancelled);
    for (const int count : {1, 2, 3})
        EXPECT_TRUE(SameSums(*RenderPart(*scene, count).film, *reference.film)) << count;
    for (const int before : {0, 1, 2, 9}) {
        const Shared fewer =
            RenderPart(*scene, 3, {.how = {.sleeper = 1, .messagesBefore = before}});
        EXPECT_TRUE(SameSums(*fewer.film, *reference.film)) << before;
    }
    // Some of these checkpoints are written as a round ends.
    for (int i = 2; i < 40; i += 3) {
        const Shared begun = RenderPart(*scene, 3, {.checkpoints = i});
        const Shared rest = RenderPart(*scene, 2, {.before = &begun});
        EXPECT_TRUE(SameSums(*rest.film, *reference.film)) << i;
    }
    const Shared part = RenderPart(*scene, 2, {.tiles = 400});
    EXPECT_TRUE(part.result.cancelled);
    EXPECT_TRUE(part.state.shares);
    const Shared rest = RenderPart(*scene, 3, {.before = &part});
    EXPECT_FALSE(rest.result.cancelled);
    EXPECT_TRUE(SameSums(*rest.film, *reference.film));
}

}  // namespace
}  // namespace lull::ranks_test
