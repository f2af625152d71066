// Checks that learning and light paths are the same with any number of ranks.
#include <gtest/gtest.h>

#include <atomic>

#include "renderer/learning/learners.h"
#include "tests/renderer/render/ranks/shared_render.h"
#include "tests/renderer/scene_of.h"

namespace lull::ranks_test {
namespace {

// A scene, and how much is learned there.
struct Learning {
    std::unique_ptr<const Scene> scene;
    LearningOptions options;
    int cap;
};

// A render that is interrupted, goes on, or loses a rank.
struct Part {
    const Shared* before = nullptr;             // goes on from there
    std::vector<std::byte>* learned = nullptr;  // until then, and in the end
    Habits how = {};
    int64_t tiles = 1 << 30;  // of the first rank, which is then interrupted
};

Shared RenderPart(const Learning& learning, int ranks, const Part& part = {}) {
    const Scene& scene = *learning.scene;
    const Film whole(kImage);
    std::vector<std::unique_ptr<LightRounds>> lights(size_t(std::max(1, ranks)));
    std::vector<std::unique_ptr<Learners>> learners;
    for (std::unique_ptr<LightRounds>& light : lights) {
        if (IsBidirectional(scene.integrator))
            light = std::make_unique<LightRounds>(scene, whole, SamplerKind::Random, 0);
        learners.push_back(std::make_unique<Learners>(scene, learning.options, kImage.Area()));
    }
    if (part.before) learners[0]->Take(*part.learned, *part.before->film);
    std::atomic<int64_t> left = part.tiles;
    const auto change = [&](RenderSetup* o, int rank) {
        o->lightRounds = lights[size_t(rank)].get();
        o->learners = learners[size_t(rank)].get();
        o->rankPatience = 1;
        o->schedule.cap = learning.cap;
        if (rank == 0) o->isCancelled = [&] { return --left < 0; };
    };
    Shared shared = RenderShared(
        ranks, change, part.before,
        [&](int rank) {
            return SamplesOf(scene, *learners[size_t(rank)], lights[size_t(rank)].get());
        },
        part.how, true);
    if (part.learned) *part.learned = learners[0]->Save();
    return shared;
}

// Expects the same sums of any number of ranks, where one of them is given up after some messages,
// and where three go on from what `ranks` had after some tiles of the first.
void ExpectTheSame(const Learning& learning, std::initializer_list<int> messages, int ranks,
                   int64_t tiles) {
    const Shared reference = RenderPart(learning, 0);
    ASSERT_FALSE(reference.result.cancelled);
    for (const int count : {1, 2, 3})
        EXPECT_TRUE(SameSums(*RenderPart(learning, count).film, *reference.film)) << count;
    for (const int before : messages) {
        const Shared fewer =
            RenderPart(learning, 3, {.how = {.sleeper = 1, .messagesBefore = before}});
        EXPECT_TRUE(SameSums(*fewer.film, *reference.film)) << before;
    }

    std::vector<std::byte> learned;
    const Shared part = RenderPart(learning, ranks, {.learned = &learned, .tiles = tiles});
    EXPECT_TRUE(part.result.cancelled);
    const Shared rest = RenderPart(learning, 3, {.before = &part, .learned = &learned});
    EXPECT_FALSE(rest.result.cancelled);
    EXPECT_TRUE(SameSums(*rest.film, *reference.film));
}

// The first learns alone and tells the others, who take part from then on. A lamp shines at the top
// of the sphere around it.
TEST(Ranks, LearnTheSame) {
    ExpectTheSame({SceneOf(R"(
Camera "perspective" "float fov" [80]
Film "image" "integer xresolution" [80] "integer yresolution" [60]
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [90 80 60]
  Rotate -90 1 0 0
  Shape "disk" "float radius" [.1] "float height" [.5]
AttributeEnd
ReverseOrientation
Shape "sphere" "float radius" [1]
WorldEnd
)"),
                   {.isShort = true},
                   120},
                  {0}, 0, 300);
}

// Each traces a part of the light of a round; one of them is given up in a round, or while light is
// traced, and the render goes on within a round. A ball under a lamp is seen from outside.
TEST(Ranks, ShareLightPaths) {
    ExpectTheSame({SceneOf(R"(
Integrator "bdpt" "integer maxdepth" [3]
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [60]
Film "image" "integer xresolution" [80] "integer yresolution" [60]
WorldBegin
LightSource "infinite" "rgb L" [.2 .3 .4]
LightSource "point" "point from" [1 2 -2] "rgb I" [3 3 3]
Shape "sphere" "float radius" [1]
WorldEnd
)"),
                   {.mode = GuideMode::Off},
                   90},
                  {0, 1, 2, 9}, 2, 400);
}

}  // namespace
}  // namespace lull::ranks_test
