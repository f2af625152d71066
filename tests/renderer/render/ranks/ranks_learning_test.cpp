// Checks that learning and light paths are the same with any number of ranks.
#include <gtest/gtest.h>

#include <atomic>

#include "renderer/learning/learners.h"
#include "tests/renderer/render/ranks/shared_render.h"
#include "tests/renderer/scene_of.h"

namespace lull::ranks_test {
namespace {

// A lamp that shines at the top of the sphere around it.
std::unique_ptr<const Scene> MakeSphere() {
    return SceneOf(R"(
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
)");
}

// The first learns alone and tells the others, who take part from then on; also where one of them
// has been given up before, and where the first went on from a checkpoint.
TEST(Ranks, LearnTheSame) {
    const auto scene = MakeSphere();
    const auto render = [&](int ranks, const Shared* before, std::vector<std::byte>* learned,
                            const Habits& how = {}, int64_t tilesOfFirst = 1 << 30) {
        std::vector<std::unique_ptr<Learners>> learners;
        for (int rank = 0; rank < std::max(1, ranks); ++rank)
            learners.push_back(std::make_unique<Learners>(*scene, LearningOptions{.isShort = true},
                                                          kImage.Area()));
        if (before) learners[0]->Take(*learned, *before->film);
        std::atomic<int64_t> left = tilesOfFirst;
        const auto change = [&](RenderSetup* o, int rank) {
            o->learners = learners[size_t(rank)].get();
            o->rankPatience = 1;
            o->schedule.cap = 120;
            if (rank == 0) o->isCancelled = [&] { return --left < 0; };
        };
        Shared shared = RenderShared(
            ranks, change, before,
            [&](int rank) { return SamplesOf(*scene, *learners[size_t(rank)]); }, how);
        if (learned) *learned = learners[0]->Save();
        return shared;
    };
    const Shared reference = render(0, nullptr, nullptr);
    ASSERT_FALSE(reference.result.cancelled);
    for (const int ranks : {1, 2, 3})
        EXPECT_TRUE(SamePixels(*render(ranks, nullptr, nullptr).film, *reference.film)) << ranks;
    const Shared fewer = render(3, nullptr, nullptr, {.sleeper = 1, .messagesBefore = 0});
    EXPECT_TRUE(SamePixels(*fewer.film, *reference.film));

    std::vector<std::byte> learned;
    Shared part = render(0, nullptr, &learned, {}, 300);
    EXPECT_TRUE(part.result.cancelled);
    const Shared rest = render(3, &part, &learned);
    EXPECT_FALSE(rest.result.cancelled);
    EXPECT_TRUE(SamePixels(*rest.film, *reference.film));
}

// A ball under a lamp, seen from outside.
std::unique_ptr<const Scene> MakeLamp() {
    return SceneOf(R"(
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
}

// Each traces a part of the light of a round; also where one of them has been given up in a round,
// or while light is traced, and where the render goes on from a checkpoint within a round.
TEST(Ranks, ShareLightPaths) {
    const auto scene = MakeLamp();
    const Film whole(kImage);
    const auto render = [&](int ranks, const Shared* before = nullptr,
                            std::vector<std::byte>* learned = nullptr, const Habits& how = {},
                            int64_t tilesOfFirst = 1 << 30) {
        std::vector<std::unique_ptr<LightRounds>> lights;
        std::vector<std::unique_ptr<Learners>> learners;
        for (int rank = 0; rank < std::max(1, ranks); ++rank) {
            lights.push_back(std::make_unique<LightRounds>(*scene, whole, SamplerKind::Random, 0));
            learners.push_back(std::make_unique<Learners>(
                *scene, LearningOptions{.mode = GuideMode::Off}, kImage.Area()));
        }
        if (before) learners[0]->Take(*learned, *before->film);
        std::atomic<int64_t> left = tilesOfFirst;
        const auto change = [&](RenderSetup* o, int rank) {
            o->light = lights[size_t(rank)].get();
            o->learners = learners[size_t(rank)].get();
            o->rankPatience = 1;
            if (rank == 0) o->isCancelled = [&] { return --left < 0; };
        };
        Shared shared = RenderShared(
            ranks, change, before,
            [&](int rank) {
                return SamplesOf(*scene, *learners[size_t(rank)], lights[size_t(rank)].get());
            },
            how, true);
        if (learned) *learned = learners[0]->Save();
        return shared;
    };
    const Shared reference = render(0);
    ASSERT_FALSE(reference.result.cancelled);
    for (const int ranks : {1, 2, 3})
        EXPECT_TRUE(SameSums(*render(ranks).film, *reference.film)) << ranks;
    for (const int messages : {0, 1, 2, 9})
        EXPECT_TRUE(
            SameSums(*render(3, nullptr, nullptr, {.sleeper = 1, .messagesBefore = messages}).film,
                     *reference.film))
            << messages;

    std::vector<std::byte> learned;
    Shared part = render(2, nullptr, &learned, {}, 400);
    EXPECT_TRUE(part.result.cancelled);
    const Shared rest = render(3, &part, &learned);
    EXPECT_FALSE(rest.result.cancelled);
    EXPECT_TRUE(SameSums(*rest.film, *reference.film));
}

}  // namespace
}  // namespace lull::ranks_test
