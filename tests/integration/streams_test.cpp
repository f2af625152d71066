// Takes the streams from the program that it talks to: no render is lost by that, and no result
// without a word.
#include "renderer/image/image_io.h"
#include "tests/integration/run_and_signal.h"

namespace lull {
namespace {

constexpr const char* kRender = "LULL render scene.pbrt --spp 20 --block 8";

// Runs the command, and expects the image to be what it is anyhow.
void ExpectImage(const SceneDirectory& directory, const std::string& command, int exitCode) {
    ExpectSuccess(RunShell(directory, kRender + std::string(" -o whole.exr --quiet")));
    const Outcome outcome = RunShell(directory, command);
    EXPECT_EQ(outcome.exitCode, exitCode) << command << outcome.err;
    ASSERT_TRUE(directory.Has("out.exr")) << command;
    EXPECT_EQ(ReadImage(directory.File("out.exr")).texels,
              ReadImage(directory.File("whole.exr")).texels);
}

TEST(Streams, RendersEndWhereNothingCanBeSaid) {
    const SceneDirectory directory;
    for (const char* end : {"2>/dev/full", "2>&-", "--json-progress 2>/dev/full"})
        ExpectImage(directory, fmt::format("{} -o out.exr {}", kRender, end), 0);
}

// No file takes the place of a stream.
TEST(Streams, RendersEndWithoutStreams) {
    const SceneDirectory directory;
    ExpectImage(directory, fmt::format("{} -o out.exr 0<&- 1>&- 2>&-", kRender), 1);
}

// The names of the files are lost, and only they.
TEST(Streams, RendersEndWhereNobodyListens) {
    const SceneDirectory directory;
    ExpectImage(directory,
                fmt::format("bash -c '{} -o out.exr --json-progress 2>&1 | true; exit "
                            "${{PIPESTATUS[0]}}'",
                            kRender),
                1);
}

// A terminal that is closed sends the signal twice, and takes the streams with it.
TEST(Streams, ClosedTerminalsLeaveImageAndCheckpoint) {
    const SceneDirectory directory;
    const Outcome interrupted = RunAndSignal(
        directory,
        "LULL render scene.pbrt --resolution 100x90 --block 40 --stop dammertz:0.004 --cap 1500 "
        "-o parts.exr --checkpoint c.h5 --checkpoint-interval 0.1",
        SIGHUP, "c.h5");
    EXPECT_EQ(interrupted.exitCode, 130) << interrupted.err;
    EXPECT_TRUE(directory.Has("c.h5"));
    EXPECT_TRUE(directory.Has("parts.exr"));
}

TEST(Streams, LostResultsAreAnError) {
    const SceneDirectory directory;
    directory.Write("h.csv", "a;20;40;60;80\n");
    for (const char* command : {"LULL evaluate --human h.csv --predicted h.csv >/dev/full",
                                "LULL info scene.pbrt >/dev/full", "LULL --help >/dev/full",
                                "LULL info scene.pbrt >&-"}) {
        const Outcome outcome = RunShell(directory, command);
        EXPECT_EQ(outcome.exitCode, 1) << command << outcome.err;
        EXPECT_EQ(CountErrorLines(outcome.err), 1) << command << outcome.err;
        EXPECT_HAS(outcome.err, "stdout");
    }
}

}  // namespace
}  // namespace lull
