// Trains models as a user would.

#include "renderer/files/file_io.h"
#include "stopping/network/model_file.h"
#include "tests/integration/run_and_signal.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"

namespace lull {
namespace {

// Recordings of three viewpoints, and thresholds of people for two of them.
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
    "train data.h5 --human human.csv --preset paper --units 8,4 --k 4 --epochs 6 --seed 3 ";

bool SameWeights(const Network& a, const Network& b) {
    return a.lstm[0].kernel == b.lstm[0].kernel && a.lstm[1].recurrent == b.lstm[1].recurrent &&
           a.lstm[1].bias == b.lstm[1].bias && a.dense[0].kernel == b.dense[0].kernel;
}

TEST(Train, WritesTheSameModelOnAnyNumberOfThreads) {
    const TrainingDirectory directory;
    const Outcome first = ExpectSuccess(directory, kSmall + "-o one.h5 --threads 1");
    EXPECT_HAS(first.err, "cellar-c");  // has no thresholds
    EXPECT_HAS(first.err, "epoch 6/6  loss 0.");
    EXPECT_HAS(first.out, "blocks trained on");
    ExpectSuccess(directory, kSmall + "-o two.h5 --threads 3 --quiet");
    const Model one = ReadModel(directory.File("one.h5")),
                two = ReadModel(directory.File("two.h5"));
    EXPECT_TRUE(SameWeights(one.network, two.network));
    EXPECT_EQ(one.settings.k, 4);
    EXPECT_EQ(one.settings.voteSpacing, 40);
    EXPECT_FALSE(directory.Has("one.h5.checkpoint"));
}

TEST(Train, GoesOnAfterAnInterruption) {
    const TrainingDirectory directory;
    const std::string larger =
        "train data.h5 --human human.csv --preset paper --units 64,32 --epochs 40 --quiet ";
    ExpectSuccess(directory, larger + "-o whole.h5");
    const Outcome part =
        RunAndSignal(directory, "LULL " + larger + "-o part.h5 --checkpoint-interval 0.1", SIGINT,
                     "part.h5.checkpoint");
    ASSERT_EQ(part.exitCode, 130) << part.err;
    EXPECT_EQ(part.out, "");
    // Another training cannot go on from there.
    const Outcome other = RunLull(directory, larger + "-o part.h5 --resume --dropout 0.3");
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_HAS(other.err, "part.h5.checkpoint: the saved training had other");
    ExpectSuccess(directory, larger + "-o part.h5 --resume");
    EXPECT_TRUE(SameWeights(ReadModel(directory.File("whole.h5")).network,
                            ReadModel(directory.File("part.h5")).network));
}

TEST(Train, LeavesEachViewpointOutAndWritesAModelOfAll) {
    const TrainingDirectory directory;
    const std::string options =
        "train --units 4 data.h5 --human human.csv --preset paper --k 2 --pool mean --quiet "
        "--channels H,visible_drop --learning-rate 0.02 --epochs 30 ";
    const Outcome outcome =
        ExpectSuccess(directory, options + "--cross-validate -o model.h5 --csv judged.csv");
    EXPECT_HAS(outcome.out, "each viewpoint left out");
    EXPECT_HAS(directory.Bytes("judged.csv"), "barn-b");
    const Model model = ReadModel(directory.File("model.h5"));
    EXPECT_EQ(FeatureNames(model.settings.features), "H,visible_drop");
    ExpectSuccess(directory, "evaluate data.h5 --human human.csv --stop learned:model.h5");
    // Left out, it is judged by the same network as when each is left out in turn.
    const Outcome single = ExpectSuccess(directory, options + "-o one.h5 --leave-out barn-b");
    const size_t at = single.out.find("barn-b"), end = single.out.find('\n', at);
    EXPECT_HAS(outcome.out, single.out.substr(at + 30, end - at - 30)) << outcome.out << single.out;
}

TEST(Train, TakesTheRecipeOfTheShippedModelUnlessThePaperIsAskedFor) {
    const TrainingDirectory directory;
    const std::string train = "train data.h5 --human human.csv --quiet --epochs 1 ";
    ExpectSuccess(directory, train + "-o entropy.h5");
    // What is given by itself counts, before or after the preset.
    ExpectSuccess(directory, train + "-o paper.h5 --units 8,4 --preset paper --k 4");
    const Model entropy = ReadModel(directory.File("entropy.h5")),
                paper = ReadModel(directory.File("paper.h5"));
    EXPECT_EQ(FeatureNames(entropy.settings.features), "visible_drop");
    EXPECT_TRUE(entropy.settings.takesMean);
    EXPECT_EQ(entropy.settings.k, 2);
    EXPECT_EQ(entropy.settings.spacing, Spacing::Geometric);
    EXPECT_EQ(entropy.network.lstm.size(), 2u);
    EXPECT_EQ(entropy.network.lstm[0].Units(), 8);
    EXPECT_EQ(FeatureNames(paper.settings.features), "H");
    EXPECT_FALSE(paper.settings.takesMean);
    EXPECT_EQ(paper.settings.k, 4);
    EXPECT_EQ(paper.network.lstm[0].Units(), 8);

    // The same by either way, cross-validated.
    const std::string judge = train + "--cross-validate ";
    const Outcome brief = ExpectSuccess(directory, judge),
                  full = RunLull(directory, judge +
                                                "--features visible_drop --pool mean --spacing "
                                                "geometric --ratio 1.4142 --k 2 --units 8,4 "
                                                "--dropout 0 --learning-rate 0.003 --flare 0 "
                                                "--balance-viewpoints --no-class-weights "
                                                "--mask 1e9 --nearness 0.25 "
                                                "--peak-limit 1.1 --preset paper");
    EXPECT_EQ(brief.out, full.out);
    EXPECT_NE(brief.out, RunLull(directory, judge + "--preset paper --units 8,4").out);
    EXPECT_EQ(RunLull(directory, judge + "--preset rendering").exitCode, 2);
}

TEST(Train, SplitsBlocks) {
    const TrainingDirectory directory;
    directory.Write("split.csv", "attic-a;0;3;\nbarn-b;1;2;3;\n");
    const Outcome outcome = ExpectSuccess(directory, kSmall + "-o m.h5 --split paper:split.csv");
    EXPECT_HAS(outcome.err, "windows of 5 blocks");
    EXPECT_HAS(outcome.out, "blocks left out");
    EXPECT_EQ(ExpectSuccess(directory, kSmall + "--split paper:split.csv").out, outcome.out);
}

TEST(Train, SaysWhatIsWrong) {
    const TrainingDirectory directory;
    ExpectFailure(directory, kSmall + "-o m.h5 --n 30", {"multiple", "30"});
    ExpectFailure(directory, kSmall + "-o m.h5 --n 60", {"not recorded at", "n = 60"});
    ExpectFailure(directory, kSmall + "-o m.h5 --leave-out shed", {"no viewpoint 'shed'"});
    ExpectFailure(directory, kSmall + "-o m.h5 --without shed", {"no viewpoint 'shed'"});
    ExpectFailure(directory, kSmall + "-o m.h5 --resume", {"m.h5.checkpoint"});
    ExpectFailure(directory, kSmall + "-o no/such/m.h5", {"no/such"});
    ExpectFailure(directory, "train human.csv --human human.csv -o m.h5", {"human.csv"});
    for (const char* bad :
         {"", "-o m.h5 --features Q", "-o m.h5 --pool rms", "-o m.h5 --units none",
          "-o m.h5 --dropout 1", "-o m.h5 --units 8,0", "-o m.h5 --units 8,,4", "--resume",
          "-o m.h5 --cross-validate --leave-out attic-a", "-o m.h5 --split human.csv"})
        EXPECT_EQ(
            RunLull(directory, std::string("train data.h5 --human human.csv ") + bad).exitCode, 2)
            << bad;
}

}  // namespace
}  // namespace lull
