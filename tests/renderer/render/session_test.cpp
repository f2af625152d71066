// Sessions go on where they were interrupted, to the same bits, and say what there is to say.
#include "renderer/render/session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

// A box that is open to the camera, with a lamp that shines at its ceiling.
std::unique_ptr<const Scene> MakeBox() {
    return SceneOf(R"(
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [45]
Film "image" "integer xresolution" [32] "integer yresolution" [24]
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [30 25 20]
  Translate .4 .5 0  Rotate -90 1 0 0
  Shape "disk" "float radius" [.2]
AttributeEnd
Material "matte" "rgb Kd" [.7 .5 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 3 2 6 3 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 1 -1  1 1 -1  1 1 1  -1 1 1]
WorldEnd
)");
}

const PixelRect kBoxRegion = {{0, 0}, {32, 24}};

SessionOptions OptionsFor(const std::string& checkpoint) {
    SessionOptions options;
    options.render.schedule = {.blockSize = 16, .passLength = 20, .cap = 100};
    options.render.threads = 1;
    options.render.makeCriterion = [](const BlockInfo& block) {
        return std::make_unique<ScriptedCriterion>(40 + 20 * block.index);
    };
    options.film.grid = GridOf(options.render.schedule);
    options.film.layers.aovs = {.albedo = true, .depth = true, .noise = true};
    options.checkpoint = {.file = checkpoint, .interval = 1e6, .resume = true};
    options.identity = {{"scene", "box"}};
    return options;
}

// What a session has said.
struct Said {
    std::vector<std::string> resume, warnings;

    void Hear(SessionOptions* options) {
        RenderEvents& events = options->render.events;
        events.onResume = [this](const std::string& line) { resume.push_back(line); };
        events.onWarning = [this](const std::string& line) { warnings.push_back(line); };
    }
};

TEST(Session, GoesOnFromWhereverItWasInterrupted) {
    const auto scene = MakeBox();
    Session whole(*scene, kBoxRegion, OptionsFor(""));
    ASSERT_FALSE(whole.Run().cancelled);

    const TemporaryDirectory directory;
    const std::string file = directory.File("c.h5");
    int interruptions = 0, resumed = 0;
    for (bool isDone = false; !isDone;) {
        // Gets further than the last time, by as many tiles.
        int left = 4 * (1 + interruptions);
        Said said;
        SessionOptions options = OptionsFor(file);
        options.render.isCancelled = [&] { return left-- <= 0; };
        said.Hear(&options);
        Session session(*scene, kBoxRegion, options);
        session.Resume();
        resumed += said.resume == std::vector<std::string>{"going on from " + file};
        isDone = !session.Run().cancelled;
        interruptions += !isDone;
        EXPECT_TRUE(said.warnings.empty());
        if (!isDone) continue;
        EXPECT_TRUE(SameSums(session.GetFilm(), whole.GetFilm()));
    }
    EXPECT_GT(interruptions, 2);
    EXPECT_EQ(resumed, interruptions);
}

TEST(Session, TakesLightGroupsUpAgain) {
    const auto scene = MakeBox();
    const TemporaryDirectory directory;
    SessionOptions options = OptionsFor("");
    options.film.layers.groups = {{"lamp", "rest"}, {0}};
    options.film.layers.groupNoise = true;
    Session whole(*scene, kBoxRegion, options);
    whole.Run();
    options.checkpoint.file = directory.File("c.h5");
    int left = 15;
    options.render.isCancelled = [&] { return left-- <= 0; };
    EXPECT_TRUE(Session(*scene, kBoxRegion, options).Run().cancelled);
    options.render.isCancelled = nullptr;
    SessionOptions others = options;
    others.film.layers.groups.ofLight = {1};
    Session other(*scene, kBoxRegion, others), same(*scene, kBoxRegion, options);
    EXPECT_THROW(other.Resume(), Error);
    same.Resume();
    EXPECT_FALSE(same.Run().cancelled);
    EXPECT_TRUE(SameSums(same.GetFilm(), whole.GetFilm()));
    const FilmPixel pixel = same.GetFilm().At({16, 20});
    EXPECT_GT(pixel.sum[0], 0);
    const FilmPixel lamp =
        same.GetFilm().layers.Find<LightGroupLayer>()->At(0, {16, 20}, pixel.count);
    EXPECT_EQ(lamp.sum, pixel.sum);
    EXPECT_EQ(lamp.halfSum, pixel.halfSum);
}

TEST(Session, CountsTheBytesOfLightGroups) {
    LayerOptions layers = {.groups = {{"a", "b", "rest"}, {}}};
    EXPECT_EQ(BytesOfLayers(layers), 3 * 48);
    layers.groupNoise = true;
    EXPECT_EQ(BytesOfLayers(layers), 3 * 80);
    layers.groupBackground = true;
    EXPECT_EQ(BytesOfLayers(layers), 3 * 104);
}

// The denoiser's inputs take the place of its sums.
TEST(Session, CountsTheBytesOfDenoising) {
    LayerOptions layers = {.features = true};
    const int64_t alone = BytesOfLayers(layers);
    EXPECT_GE(alone, 56 + 4 + 24);
    EXPECT_LE(alone, 56 + 4 + 24 + 20);
    layers.groups = {{"a", "rest"}, {}};
    layers.groupNoise = true;
    EXPECT_GE(BytesOfLayers(layers), alone - 24 + 2 * 80);
}

// A disk stays full for more than one attempt.
TEST(Session, WarnsOnceOfCheckpointsThatCannotBeWritten) {
    const auto scene = MakeBox();
    const TemporaryDirectory directory;
    Said said;
    SessionOptions options = OptionsFor(directory.File("missing/c.h5"));
    options.checkpoint.interval = 1e-6;
    said.Hear(&options);
    Session session(*scene, kBoxRegion, options);
    session.Resume();
    EXPECT_FALSE(session.Run().cancelled);
    ASSERT_EQ(said.resume.size(), 1u);
    EXPECT_TRUE(said.resume[0].starts_with("there is no "));
    ASSERT_EQ(said.warnings.size(), 1u);
    EXPECT_TRUE(said.warnings[0].starts_with("no checkpoint: "));
}

// The files of the image take a part of the time.
TEST(Session, HeedsTheClock) {
    const auto scene = MakeBox();
    std::atomic<int> asked = 0;
    SessionOptions options = OptionsFor("");
    options.render.makeCriterion = nullptr;
    options.clock = [&] { return 60 - 0.01 * ++asked; };
    Session session(*scene, kBoxRegion, options);
    const RenderResult result = session.Run();
    ASSERT_TRUE(session.Options().secondsLeft);
    EXPECT_LT(session.Options().secondsLeft(), options.clock());
    EXPECT_FALSE(result.timeUp);
    asked = 100000;
    Session late(*scene, kBoxRegion, options);
    EXPECT_TRUE(late.Run().timeUp);
}

}  // namespace
}  // namespace lull
