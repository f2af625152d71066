// Tests what is no regular file, names that would command a terminal, and writers that meet.
#include <sys/stat.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/image_io.h"
#include "stopping/lab/recordings/recording.h"
#include "tests/integration/run_lull.h"

namespace lull {
namespace {

// A command that hangs would hang the test.
constexpr const char* kLimit = "timeout 20 LULL ";

TEST(Writers, OfOneDatasetLoseNothing) {
    const SceneDirectory directory;
    ExpectSuccess(RunShell(
        directory,
        "for v in v1 v2 v3; do LULL record scene.pbrt --resolution 60x60 --max-depth 0 --cap 40 "
        "--threads 1 --name $v -o d.h5 --quiet & done; wait"));
    EXPECT_EQ(ReadDataset(directory.File("d.h5")).size(), 3u);
    EXPECT_EQ(directory.CountFiles(), 2);
}

// Expects that of two processes that write the same `file` one says so, and the other ends well.
void ExpectOneWriter(const TemporaryDirectory& directory, const std::string& command,
                     const std::string& lock, const std::string& file = "this checkpoint") {
    const Outcome outcome = RunShell(directory, "exec 9>" + lock + " && flock 9 && (" + command +
                                                    " 9>&-; echo first $?); " + "exec 9>&-; " +
                                                    command + "; echo then $?");
    EXPECT_HAS(outcome.out, "first 1\n") << outcome.out << outcome.err;
    EXPECT_HAS(outcome.out, "then 0\n") << outcome.out << outcome.err;
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_HAS(outcome.err, "another process is writing " + file);
    EXPECT_FALSE(directory.Has(lock));
}

TEST(Writers, OfOneCheckpointAreOne) {
    const SceneDirectory directory;
    ExpectOneWriter(directory, "LULL render scene.pbrt --spp 2 --checkpoint c.h5 -o a.exr --quiet",
                    ".c.h5.lock");
    ExpectOneWriter(directory,
                    "LULL record scene.pbrt --resolution 60x60 --max-depth 0 --cap 40 --threads 1 "
                    "--name v -o d.h5 --quiet",
                    ".d.h5.v.checkpoint.lock");
}

// Files of one name are of one process; another name, or a name that a killed process had, is free.
TEST(Writers, OfOneResultAreOne) {
    const SceneDirectory directory;
    const auto expectOneWriter = [&](const std::string& command, const std::string& lock) {
        ExpectOneWriter(directory, command, lock, "this file");
    };
    expectOneWriter("LULL render scene.pbrt --spp 20 --denoise-layers -o a.png --quiet",
                    ".a.exr.lock");
    expectOneWriter("LULL denoise a.exr -o b.exr --quiet", ".b.exr.lock");
    expectOneWriter("LULL compare scene.pbrt --cap 20 --snapshots -o c --quiet",
                    ".c.compare.json.lock");
    expectOneWriter("LULL compare --automatic a.exr --reference b.exr -o c",
                    ".c.compare.json.lock");
    expectOneWriter(
        "LULL study scene.pbrt --resolution 60x60 --max-depth 0 --cap 40 -o s.html --quiet",
        ".s.html.lock");
    ExpectSuccess(RunShell(directory,
                           "exec 9>.a.exr.lock && flock 9 && LULL render scene.pbrt --spp 1 -o "
                           "other.exr --quiet 9>&-"));
}

TEST(SpecialFiles, AreNotWaitedFor) {
    const SceneDirectory directory;
    for (const char* name : {"f.exr", "f.h5", "f.csv", "f.json"})
        ASSERT_EQ(mkfifo(directory.File(name).c_str(), 0600), 0);
    for (const char* command :
         {"render scene.pbrt --spp 2 -o f.exr", "render scene.pbrt --spp 2 --report f.json",
          "render scene.pbrt --spp 20 --checkpoint f.h5 --resume",
          "render scene.pbrt --stop learned:f.h5", "render scene.pbrt --stop thresholds:f.csv",
          "render scene.pbrt --stop thresholds:/dev/zero", "evaluate f.h5 --human f.csv --rivals",
          "train f.h5 --human f.csv -o m.h5", "study --collect f.json -o t.csv"}) {
        const Outcome outcome = RunShell(directory, kLimit + std::string(command));
        EXPECT_EQ(outcome.exitCode, 1) << command << "\n" << outcome.err;
        EXPECT_HAS(outcome.err, "not a regular file");
    }
}

TEST(HalfExr, IsClampedWithOneWarning) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText("AreaLightSource \"area\" \"rgb L\" [1e5 1e5 1e5] " +
                                            std::string(kSphere)));
    const Outcome outcome =
        ExpectSuccess(directory, "render scene.pbrt --spp 2 --exr-half -o a.exr");
    const std::string warning = "values clamped to 65504: ";
    const size_t first = outcome.err.find(warning);
    EXPECT_NE(first, std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find(warning, first + 1), std::string::npos) << outcome.err;
}

TEST(Messages, AreShortAndCommandNoTerminal) {
    const SceneDirectory directory;
    directory.Write("t.csv", "scene;" + std::string(100'000, '\x1b') + ";\n");
    directory.Write(
        "m.pbrt", SceneText("Material \"a\x1b[31m\a" + std::string(5000, 'x') + "\"\n" + kSphere));
    for (const char* command : {"render scene.pbrt --stop thresholds:t.csv", "render m.pbrt",
                                "render scene.pbrt --stop \"$(printf 'x%.0s' $(seq 5000))\"",
                                "render m.pbrt --substitute --spp 1 -o x.exr"}) {
        const Outcome outcome = RunShell(directory, kLimit + std::string(command));
        EXPECT_EQ(outcome.err.find_first_of("\x1b\a"), std::string::npos) << command;
        EXPECT_LT(outcome.err.size(), 2000u) << command;
        EXPECT_NE(outcome.err, "") << command;
    }
}

TEST(Messages, AreShortHoweverLongTheCommandIs) {
    const SceneDirectory directory;
    directory.Write("h.csv", "v;20\n");
    for (const char* command :
         {"render scene.pbrt --stop learned:$L", "render scene.pbrt --stop thresholds:h.csv:$L",
          "render scene.pbrt -o $L.exr", "render $L", "render scene.pbrt --aov $L", "$L",
          "record scene.pbrt --name $L -o d.h5", "render scene.pbrt --checkpoint $L"}) {
        const Outcome outcome = RunShell(
            directory, "L=$(printf 'x%.0s' $(seq 20000)); " + std::string(kLimit) + command);
        EXPECT_LT(outcome.err.size(), 2200u) << command;
        EXPECT_EQ(CountErrorLines(outcome.err), 1) << command << "\n" << outcome.err;
        EXPECT_FALSE(Contains(outcome.err, "filesystem error")) << outcome.err;
    }
}

TEST(Messages, AreNotThoseOfALibraryForManyThreads) {
    const SceneDirectory directory;
    const Outcome outcome =
        ExpectSuccess(directory, "render scene.pbrt --spp 1 --threads 4096 -o a.exr --quiet");
    EXPECT_EQ(outcome.err, "");
}

TEST(Layers, HoldNoInfinityWhereTheFilmIsScaled) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText("AreaLightSource \"area\" \"rgb L\" [1e30 1e20 1e38] " +
                                            std::string(kSphere)));
    const Outcome outcome = ExpectSuccess(
        directory, "render scene.pbrt --spp 20 --exposure 100 --denoise --denoise-layers -o a.exr");
    EXPECT_HAS(outcome.err, "samples were not finite");
    for (const ExrChannel& channel : ReadExr(directory.File("a.exr")).channels)
        EXPECT_TRUE(std::ranges::all_of(channel.values, [](float v) { return std::isfinite(v); }))
            << channel.name;
}

}  // namespace
}  // namespace lull
