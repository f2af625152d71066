// Lets the program learn where light comes from, as a user would.
#include <nlohmann/json.hpp>

#include "renderer/image/image_io.h"
#include "tests/integration/run_and_signal.h"

namespace lull::guide_test {
namespace {

// A room that a lamp lights by way of its ceiling.
constexpr const char* kRoom = R"(
LookAt 0 0 -0.9  0 0 0  0 1 0
Camera "perspective" "float fov" [80]
Film "image" "integer xresolution" [60] "integer yresolution" [50]
Integrator "path" "integer maxdepth" [20]
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [90 80 60]
  Translate .6 .6 .6  Rotate -90 1 0 0
  Shape "disk" "float radius" [.12]
AttributeEnd
ReverseOrientation
Shape "sphere" "float radius" [1]
WorldEnd
)";

struct SceneDirectory : TemporaryDirectory {
    SceneDirectory() { Write("room.pbrt", kRoom); }
};

auto Texels(const TemporaryDirectory& directory, const std::string& name) {
    return ReadImage(directory.File(name)).texels;
}

TEST(GuideOption, KilledWhileLearningComesToTheSameBits) {
    const SceneDirectory directory;
    const std::string render = "LULL render room.pbrt --spp 128 --guide on --quiet ";
    ExpectSuccess(RunShell(directory, render + "-o whole.exr --threads 1"));
    const std::string parts =
        render + "-o parts.exr --threads 2 --checkpoint c.h5 --checkpoint-interval 0.1 --resume";
    // After the first checkpoint, and then at several moments.
    Outcome outcome = RunAndSignal(directory, parts, SIGKILL, "c.h5");
    EXPECT_EQ(outcome.exitCode, 137) << outcome.err;
    for (int kill = 0; kill < 3 && outcome.exitCode == 137; ++kill)
        outcome =
            RunShell(directory, fmt::format("timeout -s KILL {:.2f} {}", 0.3 + 0.15 * kill, parts));
    if (outcome.exitCode == 137) outcome = RunShell(directory, parts);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(Texels(directory, "parts.exr") == Texels(directory, "whole.exr"));
}

TEST(GuideOption, ReportSaysWhatWasDecided) {
    const SceneDirectory directory;
    const auto guideOf = [&](const std::string& options) {
        const Outcome outcome =
            ExpectSuccess(directory, "render room.pbrt -o a.exr --report r.json " + options);
        const auto made = nlohmann::json::parse(ReadBytes(directory.File("r.json")))["provenance"];
        const bool isSaid = Contains(outcome.err, "lull: guide: ");
        EXPECT_EQ(isSaid, made.contains("guide")) << outcome.err;
        return made.value("guide", nlohmann::json());
    };
    const auto on = guideOf("--spp 16 --guide on --guide-memory 8");
    EXPECT_EQ(on["mode"], "on");
    EXPECT_EQ(on["used"], true);
    EXPECT_EQ(on["memory"], 8);
    EXPECT_EQ(on["from"], 4);
    EXPECT_EQ(on["spp"], 4);  // the round that ends with the image teaches nobody
    EXPECT_EQ(on["rounds"], 1);
    EXPECT_LE(on["bytes"], 4 << 20);
    EXPECT_FALSE(on.contains("variance"));
    // A render of few samples is not worth learning for.
    const auto few = guideOf("--spp 16 --guide auto");
    EXPECT_EQ(few["used"], false);
    EXPECT_EQ(few["rounds"], 0);
    EXPECT_TRUE(guideOf("--spp 4").is_null());
}

TEST(GuideOption, RefusesWhatItCannotGuide) {
    const SceneDirectory directory;
    ExpectFailure(directory, "render room.pbrt -o out.exr --spp 4 --guide on --estimator pbrt-v3",
                  {"--guide on", "pbrt-v3"});
    EXPECT_EQ(RunLull(directory, "render room.pbrt --guide perhaps").exitCode, 2);
    EXPECT_EQ(RunLull(directory, "render room.pbrt --guide-memory 8").exitCode, 2);
    EXPECT_EQ(RunLull(directory, "render room.pbrt --guide on --guide-memory 0").exitCode, 2);
    // Where auto finds that nothing can be guided, the image is that without.
    ExpectSuccess(directory, "render room.pbrt -o a.exr --spp 4 --estimator pbrt-v3");
    ExpectSuccess(directory, "render room.pbrt -o b.exr --spp 4 --estimator pbrt-v3 --guide auto");
    EXPECT_TRUE(Texels(directory, "a.exr") == Texels(directory, "b.exr"));
}

TEST(GuideOption, GoesOnOnlyWithTheSameGuide) {
    const SceneDirectory directory;
    const std::string render = "LULL render room.pbrt -o a.exr --spp 4000 --checkpoint c.h5 ";
    RunAndSignal(directory, render + "--checkpoint-interval 0.1 --guide on", SIGKILL, "c.h5");
    const auto errorOf = [&](const std::string& more) {
        const Outcome outcome = RunShell(directory, render + "--resume " + more);
        EXPECT_EQ(outcome.exitCode, 1) << more;
        EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
        return outcome.err;
    };
    EXPECT_TRUE(Contains(errorOf(""), "another guide (on of 64 MB there, none here)"));
    EXPECT_TRUE(Contains(errorOf("--guide auto"), "another guide"));
    EXPECT_TRUE(Contains(errorOf("--guide on --guide-memory 32"), "another guide"));
}

}  // namespace
}  // namespace lull::guide_test
