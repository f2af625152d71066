// Sessions go on where they were interrupted, to the same bits, and say what there is to say.
#include "renderer/render/session.h"

#include <gtest/gtest.h>

#include <atomic>

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
