// Renders under mpirun, and compares with what one process makes.
#include <fmt/format.h>

#include "renderer/image/image_io.h"
#include "stopping/lab/recordings/recording.h"
#include "tests/integration/run_and_signal.h"

namespace lull::ranks_test {
namespace {

constexpr const char* kRender =
    "LULL render scene.pbrt --resolution 100x90 --block 40 --threads 1 --quiet ";

struct RanksTest : testing::Test {
    void SetUp() override {
        if (std::string(LULL_MPIRUN).empty()) GTEST_SKIP() << "there is no MPI";
        directory.Write("scene.pbrt",
                        SceneText(kSphere + std::string(" LightSource \"point\" \"point from\" "
                                                        "[2 1 -2]")));
    }

    // Open MPI leaves memory behind, and takes no root and no more ranks than cores without asking.
    static std::string Ranks(int ranks) {
        return fmt::format("env ASAN_OPTIONS=detect_leaks=0 " LULL_MPIRUN
                           " --oversubscribe --allow-run-as-root --bind-to none -n {} ",
                           ranks);
    }

    // Sets $last to rank 2 of that mpirun: threads of it start ranks, in any order.
    static std::string RankTwo(const std::string& mpi) {
        return "for child in $(cat /proc/" + mpi +
               "/task/*/children); do grep -qzx OMPI_COMM_WORLD_RANK=2 /proc/$child/environ && "
               "last=$child; done; ";
    }

    Outcome Run(const std::string& command) { return RunShell(directory, command); }

    std::vector<float> Texels(const std::string& name) {
        return std::get<std::vector<float>>(ReadImage(directory.File(name + ".exr")).texels);
    }
    void ExpectSame(const std::string& a, const std::string& b) {
        EXPECT_EQ(Texels(a), Texels(b)) << a << " " << b;
        for (const char* file : {".thresholds.csv", ".png", ".spp.png"})
            EXPECT_EQ(directory.Bytes(a + file), directory.Bytes(b + file)) << a << " " << b;
    }

    // Expects the same files, with light groups and all other channels, of one process and of three
    // ranks; and of three that go on with what two have begun.
    void ExpectShared(const std::string& options) {
        const auto expectSameChannels = [&](const std::string& name) {
            ExpectSame("one", name);
            const ExrImage x = ReadExr(directory.File("one.exr")),
                           y = ReadExr(directory.File(name + ".exr"));
            ASSERT_TRUE(x.Find("light.rest.G"));
            ASSERT_EQ(x.channels.size(), y.channels.size());
            for (const ExrChannel& channel : x.channels)
                EXPECT_EQ(y.Find(channel.name)->values, channel.values) << channel.name;
        };
        const std::string render =
            kRender + options + "--light-groups environment --report r.html ";
        ExpectSuccess(Run(render + "-o one.exr"));
        const Outcome some = ExpectSuccess(Run(Ranks(3) + render + "-o some.exr --preview 0.3"));
        EXPECT_EQ(some.out, "some.exr\nsome.png\nsome.spp.png\nsome.thresholds.csv\nr.html\n");
        EXPECT_FALSE(Contains(some.err, "workers")) << some.err;
        EXPECT_FALSE(Contains(directory.Bytes("some.exr"), "interrupted"));
        expectSameChannels("some");

        const std::string parts = render + "-o parts.exr --checkpoint c.h5 --resume ";
        const Outcome interrupted = RunAndSignal(
            directory, Ranks(2) + parts + "--checkpoint-interval 0.1", SIGTERM, "c.h5");
        EXPECT_NE(interrupted.exitCode, 0) << interrupted.err;
        ExpectSuccess(Run(Ranks(3) + parts));
        expectSameChannels("parts");
    }

    TemporaryDirectory directory;
};

// Rank 0 denoises blocks from the sums of all.
TEST_F(RanksTest, ShareLayers) {
    WritePng(directory.File("mask.png"), std::vector<uint8_t>{0, 0, 0, 255, 255, 255}, 2, 1);
    ExpectShared(
        "--importance mask.png "
        "--aov albedo,normal,depth,position,object,material,noise --denoise --stop denoised:0.1 "
        "--cap 300 ");
}

// Each rank traces a part of the light paths, learns from the light of all, and continues the work
// of others.
TEST_F(RanksTest, ShareLightPaths) {
    ExpectShared("--integrator bdpt --aov noise --stop lnoise:0.5 --cap 100 ");
}

TEST_F(RanksTest, GoOnWithOthersAfterSignalsAndDeaths) {
    const std::string render = std::string(kRender) + "--cap 800 --stop lnoise:0.2 ";
    ExpectSuccess(Run(render + "-o one.exr"));
    const std::string parts =
        render + "-o parts.exr --checkpoint c.h5 --checkpoint-interval 0.1 --resume";

    // A rank is killed: the job ends, and what there was stays. mpirun leaves the others a second,
    // which may be too short where many share the machine.
    const Outcome killed =
        Run("env OMPI_MCA_odls_base_sigkill_timeout=3 " + Ranks(3) + parts +
            " & p=$!; while [ ! -e c.h5 ] && kill -0 $p; do sleep 0.02; done; " + RankTwo("$p") +
            "kill -KILL $last; "
            "wait $p");
    EXPECT_NE(killed.exitCode, 0) << killed.err;
    // Of rank 2, or of rank 0 where mpirun was the first to end that. Open MPI 5 leaves the others
    // a quarter of a second, whatever is set, and names the rank itself.
    const auto names = [&](int rank) {
        return Contains(killed.err,
                        fmt::format("lull: warning: rank {} does not respond; if it has "
                                    "died, --resume",
                                    rank));
    };
    EXPECT_TRUE(names(2) || names(0) || Contains(killed.err, "prterun noticed that process rank 2"))
        << killed.err;
    ASSERT_TRUE(directory.Has("c.h5"));
    std::filesystem::copy(directory.File("c.h5"), directory.File("before.h5"));

    ExpectSuccess(Run(Ranks(2) + parts));
    ExpectSame("one", "parts");

    std::filesystem::rename(directory.File("before.h5"), directory.File("c.h5"));
    ExpectSuccess(Run(parts));
    ExpectSame("one", "parts");
}

// For ever: the clock still ends the render, and the others make up for it.
TEST_F(RanksTest, GoOnWithoutOneThatIsStopped) {
    const Outcome stopped = ExpectSuccess(
        Run("timeout -s KILL 120 " + Ranks(3) + kRender +
            "--stop fixed:100000 -o parts.exr --time 9s --checkpoint c.h5 --checkpoint-interval 0.5"
            " & p=$!; while [ ! -e c.h5 ] && kill -0 $p; do sleep 0.02; done; "
            "mpi=$(echo $(cat /proc/$p/task/$p/children)); " +
            RankTwo("$mpi") + "kill -STOP $last; wait $p"));
    EXPECT_HAS(stopped.err, "lull: warning: rank 2 has not responded for 5.0s");
    EXPECT_EQ(stopped.out, "parts.exr\nparts.png\nparts.spp.png\nparts.thresholds.csv\n");
    ExpectSuccess(
        Run("LULL render scene.pbrt --resolution 100x90 --block 40 --quiet "
            "--stop thresholds:parts.thresholds.csv --cap 100000 -o again.exr"));
    EXPECT_EQ(Texels("parts"), Texels("again"));
}

TEST_F(RanksTest, CompareAndRecord) {
    const std::string size = " scene.pbrt --resolution 60x45 --quiet --cap 60 --threads 1 ";
    const auto runBoth = [&](const std::string& command) {
        for (const auto& [launch, name] : {std::pair(std::string(), "one"), {Ranks(3), "some"}}) {
            ExpectSuccess(Run(launch + "LULL " + command + " -o " + name));
        }
    };
    runBoth("compare" + size + "--block 25 --stop lnoise:0.5 --snapshots --denoise");
    for (const char* image : {".automatic", ".denoised", ".reference"})
        EXPECT_EQ(Texels(std::string("one") + image), Texels(std::string("some") + image));
    EXPECT_EQ(directory.Bytes("one.thresholds.csv"), directory.Bytes("some.thresholds.csv"));

    runBoth("record --name a" + size + "--blocks 0");
    const std::vector<ViewpointRecording> one = ReadDataset(directory.File("one")),
                                          some = ReadDataset(directory.File("some"));
    ASSERT_EQ(some.at(0).blocks.size(), 1u);
    EXPECT_EQ(some[0].blocks.at(0).spp, one.at(0).blocks.at(0).spp);
    EXPECT_EQ(some[0].blocks.at(0).values, one[0].blocks.at(0).values);
    ExpectSuccess(Run(Ranks(2) + "LULL record --name a" + size + "--blocks 0 -o some"));
}

TEST_F(RanksTest, SaySharedErrorsOnce) {
    for (const auto& [command, part] :
         {std::pair(Ranks(3) + "LULL render nothing.pbrt", "nothing.pbrt"),
          {Ranks(2) + "LULL info scene.pbrt", "several ranks"}}) {
        const Outcome outcome = Run(command);
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
        EXPECT_HAS(outcome.err, part);
    }
    EXPECT_EQ(Run(Ranks(2) + "LULL render scene.pbrt --stop").exitCode, 2);

    const Outcome viewed = Run(Ranks(2) + kRender + "--display 127.0.0.1:9");
    EXPECT_NE(viewed.exitCode, 0);
    EXPECT_HAS(viewed.err, "--display");
    EXPECT_HAS(viewed.err, "one process");
}

// Whoever is about to render another scene does not spoil the image of the others.
TEST_F(RanksTest, RefuseToRenderDifferentScenes) {
    directory.Write("other.pbrt", SceneText("Shape \"sphere\" \"float radius\" [.5]"));
    const Outcome outcome =
        Run(Ranks(2) +
            "sh -c 'if [ $OMPI_COMM_WORLD_RANK = 1 ]; then cp other.pbrt mine.pbrt; "
            "else cp scene.pbrt mine0.pbrt; fi; "
            "[ $OMPI_COMM_WORLD_RANK = 1 ] && s=mine || s=mine0; LULL render $s.pbrt --spp 4'");
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_HAS(outcome.err, "rank 1");
}

}  // namespace
}  // namespace lull::ranks_test
