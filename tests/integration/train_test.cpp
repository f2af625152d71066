// Trains models as a user would.
#include "renderer/output/file_io.h"
#include "stopping/network/model_file.h"
#include "tests/integration/run_lull.h"
#include "tests/stopping/learning/made_up_recordings.h"

namespace lull {
namespace {

// Holds recordings of three viewpoints, and thresholds of people for two of them.
struct TrainingDirectory : TemporaryDirectory {
    TrainingDirectory() {
        std::vector<ViewpointRecording> viewpoints;
        for (const char* name : {"attic-a", "barn-b", "cellar-c"})
            viewpoints.push_back(MakeViewpoint(name, 4, 1200));
        WriteFileAtomically(File("data.h5"), EncodeDataset(viewpoints));
        WriteThresholds(File("human.csv"), {MakeHumanRow("attic-a"), MakeHumanRow("barn-b")});
    }
};

const std::string kSmall =
    "train data.h5 --human human.csv --units 8,4 --m 25 --k 4 --epochs 6 --seed 3 --augment ";

bool SameWeights(const Network& a, const Network& b) {
    return a.lstm[0].kernel == b.lstm[0].kernel && a.lstm[1].recurrent == b.lstm[1].recurrent &&
           a.lstm[1].bias == b.lstm[1].bias && a.dense[0].kernel == b.dense[0].kernel;
}

TEST(Train, WritesTheSameModelOnAnyNumberOfThreads) {
    const TrainingDirectory directory;
    const Outcome first = RunLull(directory, kSmall + "-o one.h5 --threads 1");
    EXPECT_EQ(first.exitCode, 0) << first.err;
    EXPECT_TRUE(Contains(first.err, "cellar-c")) << first.err;  // has no thresholds
    EXPECT_TRUE(Contains(first.err, "epoch 6/6  loss 0.")) << first.err;
    EXPECT_TRUE(Contains(first.out, "blocks trained on"));
    EXPECT_EQ(RunLull(directory, kSmall + "-o two.h5 --threads 3 --quiet").exitCode, 0);
    const Model one = ReadModel(directory.File("one.h5")),
                two = ReadModel(directory.File("two.h5"));
    EXPECT_TRUE(SameWeights(one.network, two.network));
    EXPECT_EQ(one.settings.k, 4);
    EXPECT_EQ(one.settings.voteSpacing, 40);
    EXPECT_FALSE(std::filesystem::exists(directory.File("one.h5.checkpoint")));
}

TEST(Train, GoesOnAfterAnInterruption) {
    const TrainingDirectory directory;
    const std::string larger = "train data.h5 --human human.csv --units 64,32 --epochs 40 --quiet ";
    EXPECT_EQ(RunLull(directory, larger + "-o whole.h5").exitCode, 0);
    const Outcome part =
        RunAndSignal(directory, "LULL " + larger + "-o part.h5 --checkpoint-interval 0.1", "INT",
                     "part.h5.checkpoint");
    ASSERT_EQ(part.exitCode, 130) << part.err;
    EXPECT_EQ(part.out, "");
    // Another training cannot go on from there.
    const Outcome other = RunLull(directory, larger + "-o part.h5 --resume --batch 32");
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_TRUE(Contains(other.err, "part.h5.checkpoint: the saved training had other"))
        << other.err;
    EXPECT_EQ(RunLull(directory, larger + "-o part.h5 --resume").exitCode, 0);
    EXPECT_TRUE(SameWeights(ReadModel(directory.File("whole.h5")).network,
                            ReadModel(directory.File("part.h5")).network));
}

TEST(Train, LeavesEachViewpointOutAndWritesAModelOfAll) {
    const TrainingDirectory directory;
    const std::string options =
        "train data.h5 --human human.csv --units none --k 1 --pool rms,q90 --quiet "
        "--channels masked_noise,logspp --learning-rate 0.02 --epochs 60 ";
    const Outcome outcome =
        RunLull(directory, options + "--cross-validate -o model.h5 --csv judged.csv");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(Contains(outcome.out, "each viewpoint left out")) << outcome.out;
    EXPECT_TRUE(Contains(ReadBytes(directory.File("judged.csv")), "barn-b"));
    const Model model = ReadModel(directory.File("model.h5"));
    EXPECT_TRUE(model.network.lstm.empty());
    EXPECT_EQ(FeatureNames(model.settings.features), "masked_noise,logspp");
    EXPECT_EQ(
        RunLull(directory, "evaluate data.h5 --human human.csv --stop learned:model.h5").exitCode,
        0);
    // Left out, it is judged by the same network as when each is left out in turn.
    const Outcome single = RunLull(directory, options + "-o one.h5 --leave-out barn-b");
    EXPECT_EQ(single.exitCode, 0) << single.err;
    const size_t at = single.out.find("barn-b"), end = single.out.find('\n', at);
    EXPECT_TRUE(Contains(outcome.out, single.out.substr(at + 30, end - at - 30)))
        << outcome.out << single.out;
}

TEST(Train, SplitsBlocks) {
    const TrainingDirectory directory;
    directory.Write("split.csv", "attic-a;0;3;\nbarn-b;1;2;3;\n");
    const Outcome outcome = RunLull(directory, kSmall + "-o m.h5 --split paper:split.csv");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "windows of 5 blocks")) << outcome.err;
    EXPECT_TRUE(Contains(outcome.out, "blocks left out"));
}

TEST(Train, SaysWhatIsWrong) {
    const TrainingDirectory directory;
    ExpectFailure(directory, kSmall + "-o m.h5 --features H1", {"H1 with m = 25"});
    ExpectFailure(directory, kSmall + "-o m.h5 --n 30", {"multiples", "30"});
    ExpectFailure(directory, kSmall + "-o m.h5 --n 60", {"not recorded at", "n = 60"});
    ExpectFailure(directory, kSmall + "-o m.h5 --leave-out shed", {"no viewpoint 'shed'"});
    ExpectFailure(directory, kSmall + "-o m.h5 --without shed", {"no viewpoint 'shed'"});
    ExpectFailure(directory, kSmall + "-o m.h5 --resume", {"m.h5.checkpoint"});
    ExpectFailure(directory, kSmall + "-o no/such/m.h5", {"no/such"});
    ExpectFailure(directory, "train human.csv --human human.csv -o m.h5", {"human.csv"});
    for (const char* bad :
         {"", "-o m.h5 --features Q", "-o m.h5 --pool q101", "-o m.h5 --m 16",
          "-o m.h5 --dropout 1", "-o m.h5 --units 8,,4", "--resume",
          "-o m.h5 --cross-validate --leave-out attic-a", "-o m.h5 --split human.csv"})
        EXPECT_EQ(
            RunLull(directory, std::string("train data.h5 --human human.csv ") + bad).exitCode, 2)
            << bad;
}

}  // namespace
}  // namespace lull
