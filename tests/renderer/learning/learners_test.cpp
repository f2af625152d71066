// Checks what all kinds of learners have in common: the same bits on any threads, for passes of any
// length and after interruptions; and that no damaged state is taken.
#include "renderer/learning/learners.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/learning/learning_render.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::learners_test {
namespace {

// A corner of a room with a ball of glass, a lamp, two more behind its walls, and, unless the lamps
// are alone, a sky.
std::unique_ptr<const Scene> MakeScene(const char* integrator, bool hasSky) {
    return SceneOf(WorldText(
        std::string(hasSky ? "LightSource \"infinite\" \"bool studio\" \"true\"\n" : "") + R"(
LightSource "point" "point from" [.5 .7 .5] "rgb I" [.3 .3 .3]
LightSource "point" "point from" [0 -1.2 .3] "rgb I" [3 3 3]
LightSource "point" "point from" [-1.5 0 .3] "rgb I" [3 3 3]
AttributeBegin
  Material "glass"
  Translate -.4 -.6 .3
  Shape "sphere" "float radius" [.2]
AttributeEnd
Material "matte" "rgb Kd" [.7 .6 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 -1 -1  -1 -1 1  -1 1 1  -1 1 -1])",
        fmt::format("LookAt 0 0 -.9  0 -.2 0  0 1 0\nCamera \"perspective\" \"float fov\" [80]\n"
                    "PixelFilter \"gaussian\"\n"
                    "Film \"image\" \"integer xresolution\" [24] \"integer yresolution\" [24]\n"
                    "Integrator \"{}\" \"integer maxdepth\" [6]",
                    integrator)));
}

// A way to learn.
struct Case {
    const char* name;
    const char* integrator;
    bool hasSky;
    LearningOptions how;
};

const Case kCases[] = {
    {"directions", "path", false, {.mode = GuideMode::On}},
    {"directions, on trial", "path", false, {.mode = GuideMode::Auto, .isShort = true}},
    {"lights", "path", false, {.mode = GuideMode::Off, .directLight = true}},
    {"lights and a sky", "path", true, {.mode = GuideMode::Off, .directLight = true}},
    {"all of them", "path", true, {.mode = GuideMode::On, .directLight = true}},
    {"strategies", "bdpt", true, {.mode = GuideMode::Off}}};

// Four blocks, which stop at different times, one of them within the first rounds.
RenderOptions BlocksThatStop(int threads) {
    RenderOptions options;
    options.schedule = {.blockSize = 12, .passLength = 20, .cap = 120};
    options.sampler = SamplerKind::Random;
    options.threads = threads;
    options.makeCriterion = [](const BlockInfo& block) {
        return std::make_unique<ScriptedCriterion>(20 + 20 * block.index * block.index);
    };
    return options;
}

TEST(Learners, AreTheSameOnAnyNumberOfThreads) {
    for (const Case& c : kCases) {
        const auto scene = MakeScene(c.integrator, c.hasSky);
        LearningRender one(*scene, BlocksThatStop(1), c.how);
        const RenderResult result = one.Run();
        EXPECT_EQ(result.progress.stoppedBlocks, 4) << c.name;
        EXPECT_EQ(result.blocks[2].block.spp, 100) << c.name;
        for (const int threads : {2, 4}) {
            LearningRender other(*scene, BlocksThatStop(threads), c.how);
            other.Run();
            EXPECT_TRUE(SamePixels(one.film, other.film)) << c.name << threads;
            EXPECT_TRUE(one.Learned() == other.Learned()) << c.name << threads;
        }
    }
}

// Nothing but the ends of rounds decides what a sample is: passes of any length end there, too.
// Those of strategies are passes.
TEST(Learners, DoNotDependOnPasses) {
    for (const Case& c : std::span(kCases).first(5)) {
        const auto scene = MakeScene(c.integrator, c.hasSky);
        const auto render = [&](int passLength, int blockSize) {
            RenderOptions options = BlocksThatStop(2);
            options.makeCriterion = {};
            options.schedule = {.blockSize = blockSize, .passLength = passLength, .cap = 70};
            LearningRender part(*scene, options, c.how);
            part.Run();
            return part.film;
        };
        const Film whole = render(20, 200);
        // A trial sees variances within passes: its decision needs more than one sample.
        const bool isTrial = c.how.mode == GuideMode::Auto || c.how.directLight;
        for (const int passLength : {isTrial ? 14 : 1, 7, 70})
            EXPECT_TRUE(SamePixels(whole, render(passLength, 8))) << c.name << passLength;
    }
}

TEST(Learners, GoOnToTheSameBits) {
    for (const Case& c : kCases) {
        const auto scene = MakeScene(c.integrator, c.hasSky);
        LearningRender whole(*scene, BlocksThatStop(1), c.how);
        whole.Run();
        int parts = 0;
        const auto last = RenderInParts(
            [&] { return std::make_unique<LearningRender>(*scene, BlocksThatStop(2), c.how); },
            &parts);
        EXPECT_TRUE(SamePixels(last->film, whole.film)) << c.name;
        EXPECT_TRUE(last->Learned() == whole.Learned()) << c.name;
        EXPECT_GT(parts, 3) << c.name;
    }
}

// Walks through trees, as paths do.
void Walk(const PathOptions& paths) {
    for (int k = 0; k < 50; ++k) {
        const float u = float(k) / 50;
        const Vec3f p(u, -u, u);
        if (paths.guide) {
            const GuideLeaf& leaf = paths.guide->Leaf(paths.guide->Find(p));
            float pdf;
            const Vec3f w = paths.guide->Sample(leaf, {u, 1 - 0.9f * u}, &pdf);
            EXPECT_TRUE(paths.guide->Pdf(leaf, w) >= 0);
        }
        if (paths.learned.environment) {
            Vec2f place(u, 1 - u);
            place = place.cwiseMin(kOneMinusEpsilon);
            const int tile = paths.learned.environment->Find(p, k % 7).Choose(&place);
            EXPECT_TRUE(tile >= 0 && tile < TileShares::kCount);
        }
    }
    EXPECT_TRUE(paths.shares.lightPaths >= 0 && paths.shares.connections > 0);
}

// Learns until no round has ended that is the last, and returns the state.
std::vector<std::byte> StateOf(const Scene& scene, const LearningOptions& how) {
    RenderOptions options = BlocksThatStop(2);
    options.makeCriterion = {};
    options.schedule.cap = 20;
    LearningRender render(scene, options, how);
    render.Run();
    return render.learner.Save();
}

TEST(Learners, CheckSavedStates) {
    for (const Case& c : kCases) {
        const auto scene = MakeScene(c.integrator, c.hasSky);
        const std::vector<std::byte> bytes = StateOf(*scene, c.how);
        const Film film(RegionOf(*scene), {.grid = GridOf(BlocksThatStop(1).schedule)});
        Learners learners(*scene, c.how, RegionOf(*scene).Area());
        EXPECT_NO_THROW(learners.Take(bytes, film)) << c.name;
        for (const size_t size :
             {size_t(0), size_t(3), size_t(9), bytes.size() / 2, bytes.size() - 1})
            EXPECT_THROW(learners.Take(std::span(bytes).first(size), film), std::runtime_error)
                << c.name << size;
        // What is taken nevertheless can be walked through.
        uint64_t random = 1;
        int refused = 0;
        for (int i = 0; i < 100; ++i) {
            std::vector<std::byte> damaged = bytes;
            for (int k = 0; k < 4; ++k) {
                random = random * 6364136223846793005ull + 1442695040888963407ull;
                damaged[(random >> 20) % damaged.size()] = std::byte(random >> 56);
            }
            Learners taking(*scene, c.how, RegionOf(*scene).Area());
            try {
                taking.Take(damaged, film);
                Walk(taking.Paths());
            } catch (const std::runtime_error&) {
                ++refused;
            }
        }
        EXPECT_GT(refused, 0) << c.name;
    }
}

// A state is taken by a render alone that learns the same, of the same scene.
TEST(Learners, TakeNoStateOfOthers) {
    const Film film(RegionOf(*MakeScene("path", true)),
                    {.grid = GridOf(BlocksThatStop(1).schedule)});
    for (const Case& of : kCases) {
        const std::vector<std::byte> bytes = StateOf(*MakeScene(of.integrator, of.hasSky), of.how);
        for (const Case& by : kCases) {
            if (&of == &by) continue;
            const auto scene = MakeScene(by.integrator, by.hasSky);
            Learners learners(*scene, by.how, RegionOf(*scene).Area());
            EXPECT_THROW(learners.Take(bytes, film), std::runtime_error)
                << of.name << " by " << by.name;
        }
    }
}

}  // namespace
}  // namespace lull::learners_test
