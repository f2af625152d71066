// Renders under mpirun, and compares with what one process makes.
#include <fmt/format.h>

#include <sstream>

#include "renderer/image/image_io.h"
#include "stopping/lab/recordings/dataset.h"
#include "tests/integration/run_and_signal.h"

namespace lull::ranks_test {
namespace {

constexpr const char* kRender =
    "LULL render scene.pbrt --resolution 100x90 --block 40 --threads 1 --quiet ";
constexpr const char* kLamp = "LightSource \"point\" \"point from\" [2 1 -2]\n";
constexpr const char* kShort = "--stop lnoise:0.6 --cap 140 ";  // some blocks stop before

struct RanksTest : testing::Test {
    void SetUp() override {
        if (std::string(LULL_MPIRUN).empty()) GTEST_SKIP() << "there is no MPI";
        directory.Write("scene.pbrt", SceneText(kSphere));
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
            EXPECT_EQ(ReadBytes(directory.File(a + file)), ReadBytes(directory.File(b + file)))
                << a << " " << b;
    }

    void ExpectSameChannels(const std::string& a, const std::string& b, const char* one) {
        ExpectSame(a, b);
        const ExrImage x = ReadExr(directory.File(a + ".exr")),
                       y = ReadExr(directory.File(b + ".exr"));
        ASSERT_TRUE(x.Find(one)) << one;
        ASSERT_EQ(x.channels.size(), y.channels.size());
        for (const ExrChannel& channel : x.channels)
            EXPECT_EQ(y.Find(channel.name)->values, channel.values) << channel.name;
    }

    // Expect the same files, with this channel and all others, of one process and of each number of
    // ranks; and of three that go on with what two have begun.
    void ExpectShared(const std::string& options, std::initializer_list<int> counts,
                      const char* channel = "G") {
        ExpectSuccess(Run(kRender + options + "-o one.exr"));
        for (const int ranks : counts) {
            ExpectSuccess(Run(Ranks(ranks) + kRender + options + "-o some.exr"));
            ExpectSameChannels("one", "some", channel);
        }
    }
    void ExpectContinued(const std::string& options, const char* channel = "G") {
        ExpectSuccess(Run(kRender + options + "-o one.exr"));
        const std::string parts = kRender + options + "-o parts.exr --checkpoint c.h5 --resume ";
        const Outcome interrupted = RunAndSignal(
            directory, Ranks(2) + parts + "--checkpoint-interval 0.1", SIGTERM, "c.h5");
        EXPECT_NE(interrupted.exitCode, 0) << interrupted.err;
        ExpectSuccess(Run(Ranks(3) + parts));
        ExpectSameChannels("one", "parts", channel);
    }

    TemporaryDirectory directory;
};

TEST_F(RanksTest, SayNothingOfThreads) {
    const Outcome outcome = ExpectSuccess(Run(Ranks(2) + kRender + kShort));
    EXPECT_FALSE(Contains(outcome.err, "workers")) << outcome.err;
}

TEST_F(RanksTest, RefuseViewers) {
    const Outcome outcome = Run(Ranks(2) + kRender + kShort + "--display 127.0.0.1:9");
    EXPECT_NE(outcome.exitCode, 0);
    EXPECT_TRUE(Contains(outcome.err, "--display")) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "one process")) << outcome.err;
}

TEST_F(RanksTest, ComeToTheSameBits) {
    ExpectSuccess(Run(std::string(kRender) + kShort + "-o one.exr"));
    for (const int ranks : {1, 2, 3, 4}) {
        const Outcome outcome = ExpectSuccess(Run(Ranks(ranks) + kRender + kShort + "-o some.exr"));
        EXPECT_EQ(outcome.out, "some.exr\nsome.png\nsome.spp.png\nsome.thresholds.csv\n");
        ExpectSame("one", "some");
    }
}

TEST_F(RanksTest, ShowPreviews) {
    const std::string render = std::string(kRender) + "--spp 250 ";
    ExpectSuccess(Run(render + "-o one.exr"));
    ExpectSuccess(Run(Ranks(2) + render + "-o some.exr --preview 0.3"));
    ExpectSame("one", "some");
    EXPECT_FALSE(Contains(ReadBytes(directory.File("some.exr")), "interrupted"));
}

TEST_F(RanksTest, ShareLayers) {
    const std::string layers = "--aov albedo,normal,depth,position,object,material,noise ";
    ExpectShared(layers + "--spp 32 ", {3}, "noise");
    EXPECT_EQ(ReadExr(directory.File("some.exr")).channels.size(), 17u);
    ExpectContinued(layers + "--stop lnoise:0.5 --cap 250 ", "noise");
}

TEST_F(RanksTest, ShareLightGroups) {
    directory.Write("scene.pbrt", SceneText(kLamp + std::string(kSphere)));
    ExpectShared("--light-groups environment --denoise --stop denoised:0.1 --cap 200 ", {3},
                 "light.rest.G");
}

// Each rank traces a part of the light paths, learns from the light of all, and continues the work
// of others.
TEST_F(RanksTest, ShareLightPaths) {
    directory.Write("scene.pbrt", SceneText(kSphere + std::string(kLamp)));
    const std::string options =
        "--integrator bdpt --aov noise --light-groups environment --stop lnoise:0.5 --cap 100 ";
    ExpectShared(options, {2, 3}, "light.rest.G");
    ExpectContinued(options, "light.rest.G");
}

// Rank 0 denoises blocks from the sums of all.
TEST_F(RanksTest, DenoiseTheSame) {
    const std::string options = "--denoise --stop denoised:0.1 --cap 300 ";
    ExpectShared(options + "--report r.html ", {3});
    ExpectContinued(options);
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
    ASSERT_TRUE(std::filesystem::exists(directory.File("c.h5")));
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
    const std::string line = "lull: warning: rank 2 has not responded for 5.0s";
    EXPECT_TRUE(Contains(stopped.err, line)) << stopped.err;
    EXPECT_EQ(stopped.out, "parts.exr\nparts.png\nparts.spp.png\nparts.thresholds.csv\n");
    ExpectSuccess(Run(std::string(kRender) +
                      "--stop thresholds:parts.thresholds.csv --cap 100000 -o again.exr"));
    EXPECT_EQ(Texels("parts"), Texels("again"));
}

// Nobody waits for it, for longer than the clock allows.
TEST_F(RanksTest, GoOnWithoutOneThatIsStoppedWhileItLoadsTheScene) {
    const std::string render = std::string(kRender) + "--stop fixed:100000 --time 9s -o parts.exr ";
    const Outcome stopped = ExpectSuccess(
        Run(fmt::format("timeout -s KILL 120 {} sh -c '[ $OMPI_COMM_WORLD_RANK != 2 ] || export "
                        "LD_PRELOAD={} OPENED_FILE=scene.pbrt OPENED_SIGNAL={}; exec {}'",
                        Ranks(3), SIGNAL_AT_OPEN, SIGSTOP, render)));
    const std::string line = "lull: warning: rank 2 has not responded for 5.0s";
    EXPECT_TRUE(Contains(stopped.err, line)) << stopped.err;
    ExpectSuccess(Run(std::string(kRender) +
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
    EXPECT_EQ(ReadBytes(directory.File("one.thresholds.csv")),
              ReadBytes(directory.File("some.thresholds.csv")));

    runBoth("record --name a" + size + "--blocks 0");
    const std::vector<ViewpointRecording> one = ReadDataset(directory.File("one")),
                                          some = ReadDataset(directory.File("some"));
    ASSERT_EQ(some.at(0).blocks.size(), 1u);
    EXPECT_EQ(some[0].blocks.at(0).spp, one.at(0).blocks.at(0).spp);
    EXPECT_EQ(some[0].blocks.at(0).values, one[0].blocks.at(0).values);
    ExpectSuccess(Run(Ranks(2) + "LULL record --name a" + size + "--blocks 0 -o some"));
}

TEST_F(RanksTest, SaySharedErrorsOnce) {
    const Outcome missing = Run(Ranks(3) + "LULL render nothing.pbrt");
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_EQ(CountErrorLines(missing.err), 1) << missing.err;
    EXPECT_TRUE(Contains(missing.err, "nothing.pbrt")) << missing.err;

    const Outcome info = Run(Ranks(2) + "LULL info scene.pbrt");
    EXPECT_EQ(info.exitCode, 1);
    EXPECT_EQ(CountErrorLines(info.err), 1) << info.err;
    EXPECT_TRUE(Contains(info.err, "several ranks")) << info.err;

    EXPECT_EQ(Run(Ranks(2) + "LULL render scene.pbrt --stop").exitCode, 2);
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
    EXPECT_TRUE(Contains(outcome.err, "rank 1")) << outcome.err;
}

TEST_F(RanksTest, EndByTheClock) {
    const Outcome timed =
        ExpectSuccess(Run(Ranks(3) + kRender + "--stop fixed:100000 -o timed.exr --time 2s"));
    ExpectSuccess(Run(std::string(kRender) +
                      "--stop thresholds:timed.thresholds.csv --cap 100000 -o again.exr"));
    EXPECT_EQ(Texels("timed"), Texels("again"));
}

}  // namespace
}  // namespace lull::ranks_test
