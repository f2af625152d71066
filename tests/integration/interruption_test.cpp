// Interrupts renders in all ways and compares what they come to in the end.
#include <fmt/format.h>

#include <chrono>
#include <random>

#include "renderer/image/image_io.h"
#include "tests/integration/run_and_signal.h"

namespace lull::interruption_test {
namespace {

// Blocks stop at 420 to 900 spp.
constexpr const char* kOptions =
    "scene.pbrt --resolution 100x90 --block 40 --stop dammertz:0.0075 --cap 900 --quiet";

std::string RenderCommand(const std::string& more) {
    return fmt::format("LULL render {} {}", kOptions, more);
}

// Returns the image, the thresholds and the map as one text.
std::string Results(const TemporaryDirectory& directory, const std::string& name) {
    return directory.Bytes(name + ".png") + directory.Bytes(name + ".thresholds.csv") +
           directory.Bytes(name + ".spp.png");
}

// Returns whether both linear images have the same bits.
bool SameImages(const TemporaryDirectory& directory, const std::string& a, const std::string& b) {
    return ReadImage(directory.File(a + ".exr")).texels ==
           ReadImage(directory.File(b + ".exr")).texels;
}

TEST(Interruption, KilledRendersComeToTheSameBits) {
    const SceneDirectory directory;
    const auto begin = std::chrono::steady_clock::now();
    ExpectSuccess(RunShell(directory, RenderCommand("-o whole.exr --threads 2")));
    const double whole =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

    std::mt19937 random(1);
    int kills = 0;
    Outcome outcome;
    for (int run = 0; run < 200; ++run) {
        // At first at random moments, some tenth of the whole apart, then as long as it takes.
        const double share = 0.06 + 0.1 * std::generate_canonical<double, 32>(random);
        const double seconds = kills < 8 ? share * whole : 600;
        outcome = RunShell(
            directory, fmt::format("timeout -s KILL {:.3f} ", seconds) +
                           RenderCommand(fmt::format("-o parts.exr --threads {} --checkpoint c.h5 "
                                                     "--checkpoint-interval 0.1 --resume",
                                                     1 + run % 3)));
        if (outcome.exitCode == 0) break;
        ASSERT_EQ(outcome.exitCode, 137) << outcome.err;
        ++kills;
    }
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_GE(kills, 5);
    EXPECT_EQ(Results(directory, "parts"), Results(directory, "whole"));
    EXPECT_TRUE(SameImages(directory, "parts", "whole"));
    EXPECT_FALSE(directory.Has("c.h5"));
}

TEST(Interruption, SignalsLeaveImageAndCheckpoint) {
    const SceneDirectory directory;
    const Outcome interrupted = RunAndSignal(
        directory, RenderCommand("-o parts.exr --checkpoint c.h5 --checkpoint-interval 0.1"),
        SIGTERM, "c.h5");
    ASSERT_EQ(interrupted.exitCode, 130) << interrupted.err;
    EXPECT_TRUE(directory.Has("parts.png"));
    const std::string good = directory.Bytes("c.h5");
    ASSERT_GT(good.size(), 1u << 16);

    // Without --resume the file is in the way.
    const Outcome refused = RunShell(directory, RenderCommand("-o x.exr --checkpoint c.h5"));
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_HAS(refused.err, "--resume");

    // A limit on the size of files stands for a disk that is full.
    const Outcome full =
        RunShell(directory, "trap '' XFSZ; ulimit -f 16; " +
                                RenderCommand("-o parts.exr --checkpoint c.h5 --resume "
                                              "--checkpoint-interval 0.1"));
    EXPECT_EQ(full.exitCode, 1) << full.err;
    EXPECT_EQ(CountErrorLines(full.err), 1) << full.err;
    EXPECT_HAS(full.err, "no checkpoint: cannot write \"c.h5\"");
    EXPECT_EQ(directory.Bytes("c.h5"), good);

    // Nor does another render go on from there.
    const auto errorOf = [&](const std::string& more) {
        const Outcome outcome =
            RunShell(directory, RenderCommand("--checkpoint c.h5 --resume " + more));
        EXPECT_EQ(outcome.exitCode, 1) << more;
        EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
        return outcome.err;
    };
    EXPECT_HAS(errorOf("--seed 1"), "another seed (0 there, 1 here)");
    EXPECT_HAS(errorOf("--pass 10"), "another pass");
    EXPECT_HAS(errorOf("--crop 0,0.5,0,1"), "another crop");
    EXPECT_HAS(errorOf("--estimator pbrt-v3"), "another estimator");
    EXPECT_HAS(errorOf("--sampler sobol"), "another sampler");
    directory.Write("scene.pbrt", SceneText("Shape \"sphere\" \"float radius\" [.9]"));
    EXPECT_HAS(errorOf(""), "another scene");
    directory.Write("c.h5", "rubbish");
    EXPECT_HAS(errorOf(""), "c.h5");
}

// What was rendered is there for more samples, another rule, and more caution.
TEST(Interruption, GoesOnToMore) {
    const SceneDirectory directory;
    const auto render = [&](const std::string& more) {
        return RunShell(directory,
                        "LULL render scene.pbrt --resolution 100x90 --block 40 --quiet " + more);
    };
    const std::string keep = "--checkpoint c.h5 --resume --keep-checkpoint -o parts.exr ";
    const auto expectSame = [&](const std::string& before, const std::string& after) {
        std::filesystem::remove(directory.File("c.h5"));
        ExpectSuccess(render(keep + before));
        ASSERT_TRUE(directory.Has("c.h5"));
        const Outcome more = ExpectSuccess(render(keep + after));
        ExpectSuccess(render("-o whole.exr " + after));
        EXPECT_EQ(Results(directory, "parts"), Results(directory, "whole")) << after;
        EXPECT_TRUE(SameImages(directory, "parts", "whole")) << after;
    };
    expectSame("--spp 30", "--spp 70");
    expectSame("--stop dammertz:0.04 --cap 100", "--stop dammertz:0.02 --cap 100");
    expectSame("--stop lnoise:0.8 --cap 150", "--stop lnoise:0.8 --cap 150 --caution 3");

    // The rule that looks at passes in a row begins anew, with what there is.
    EXPECT_HAS(ExpectSuccess(render("--checkpoint c.h5 --resume -o parts.exr --cap 200")).err,
               "going on from c.h5, with another rule");
    EXPECT_FALSE(directory.Has("c.h5"));

    ExpectSuccess(render(keep + "--spp 30"));
    const Outcome fewer = render(keep + "--spp 20");
    EXPECT_EQ(fewer.exitCode, 1);
    EXPECT_HAS(fewer.err, "blocks of 30 spp, more than the cap of 20");
    // With nothing left to do the files are written again.
    std::filesystem::remove(directory.File("parts.exr"));
    ExpectSuccess(render(keep + "--spp 30"));
    EXPECT_TRUE(directory.Has("parts.exr"));
}

TEST(Interruption, SaysHowToGoOn) {
    const SceneDirectory directory;
    const std::string render =
        "LULL render scene.pbrt --resolution 100x90 --block 40 --spp 100000 -o 'the parts.exr'";
    const Outcome interrupted = RunAndSignal(
        directory, render + " --checkpoint c.h5 --checkpoint-interval 0.1", SIGINT, "c.h5");
    EXPECT_EQ(interrupted.exitCode, 130);
    EXPECT_HAS(interrupted.err,
               "-o 'the parts.exr' --checkpoint c.h5 "
               "--checkpoint-interval 0.1 --resume\n");
    const size_t at = interrupted.err.find("to resume: ");
    ASSERT_NE(at, std::string::npos);
    const std::string command =
        interrupted.err.substr(at + 11, interrupted.err.find('\n', at) - at - 11);
    const Outcome resumed = ExpectSuccess(RunShell(directory, command + " --time 1s"));
    EXPECT_HAS(resumed.err, "going on from c.h5");
}

TEST(Interruption, RecordingsComeToTheSameBits) {
    const SceneDirectory directory;
    const std::string record =
        "LULL record scene.pbrt --name a --resolution 400x200 --cap 40 --quiet";
    ExpectSuccess(RunShell(directory, record + " -o whole.h5"));
    for (int kill = 0; kill < 2; ++kill) {
        const Outcome killed =
            RunAndSignal(directory, record + " -o parts.h5 --checkpoint-interval 0.1", SIGKILL,
                         "parts.h5.a.checkpoint");
        ASSERT_EQ(killed.exitCode, 137) << killed.err;
    }
    ExpectSuccess(RunShell(directory, record + " -o parts.h5"));
    // The same but for the notes of what it cost, which are attributes of a few characters.
    const std::string whole = directory.Bytes("whole.h5"), parts = directory.Bytes("parts.h5");
    ASSERT_EQ(whole.size(), parts.size());
    size_t different = 0;
    for (size_t i = 0; i < whole.size(); ++i) different += whole[i] != parts[i];
    EXPECT_LT(different, 100u);

    // What is there already is not recorded again.
    EXPECT_HAS(ExpectSuccess(RunShell(directory, record + " -o whole.h5")).err, "already");
    EXPECT_EQ(directory.Bytes("whole.h5"), whole);
}

}  // namespace
}  // namespace lull::interruption_test
