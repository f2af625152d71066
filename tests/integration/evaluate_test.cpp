// Judges rules and thresholds as a user would.
#include <cmath>

#include "renderer/files/file_io.h"
#include "stopping/lab/recordings/recording.h"
#include "tests/integration/run_lull.h"
#include "tests/stopping/golden_data.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"

namespace lull {
namespace {

// Thresholds of people for two viewpoints of four blocks, and recordings of some of these,
// in which visible noise is 0.5 where people stop to see it.
struct EvaluationDirectory : TemporaryDirectory {
    EvaluationDirectory() {
        Write("human.csv", "attic;400;900;1600;2500;\ncellar;625;10000;1225;3025;\n");
        Write("predicted.csv", "attic;300;900;2400;2500;\nbarn;20;20;20;20;\n");
        Write("all.csv", "attic;300;900;2400;2500;\ncellar;625;625;625;10000;\n");
        std::vector<ViewpointRecording> viewpoints;
        for (const auto& [name, roots] : {std::pair("attic", std::vector<int>{20, 30, 40, 50}),
                                          std::pair("cellar", std::vector<int>{25, 100, 35}),
                                          std::pair("shed", std::vector<int>{10})}) {
            ViewpointRecording& viewpoint = viewpoints.emplace_back();
            viewpoint = {.name = name,
                         .blockCount = 4,
                         .cap = 10000,
                         .passSpp = 20,
                         .provenance = {{"scene", "made up"}},
                         .blocks = {},
                         .blockNotes = {}};
            for (const int root : roots) {
                const int end = std::min(10000, root * root * 3 / 2 / 20 * 20);
                BlockRecording recording = EmptyRecording(end);
                for (const char* channel : {"masked_noise", "dammertz", "luxtile"})
                    SetChannel(&recording, channel,
                               [&](int spp) { return 0.5 * root / std::sqrt(spp); });
                viewpoint.blocks[int(viewpoint.blocks.size())] = recording;
            }
        }
        WriteFileAtomically(File("data.h5"), EncodeDataset(viewpoints));
    }
};

// Returns the line of `out` that begins with `begin`; empty if there is none.
std::string Line(const std::string& out, const std::string& begin) {
    const size_t at = ("\n" + out).find("\n" + begin);
    return at == std::string::npos ? "" : out.substr(at, out.find('\n', at) - at);
}

TEST(Evaluate, PrintsThePublishedErrors) {
    const std::string human = ThresholdsFile("human.csv"),
                      entropy = ThresholdsFile("svd-entropy-rnn.csv"),
                      attributes = ThresholdsFile("26-attributes-rnn.csv");
    const TemporaryDirectory directory;
    const std::string files = " --human '" + human + "' --predicted '";
    const Outcome first = ExpectSuccess(directory, "evaluate" + files + entropy + "' --grid 40");
    EXPECT_HAS(Line(first.out, "all"), "  14.79   13.25   11.89  ") << first.out;
    EXPECT_HAS(Line(first.out, "all"), "  40     640     0") << first.out;
    const Outcome second =
        RunLull(directory, "evaluate" + files + attributes + "' --grid 20 --margins 10,2,6");
    EXPECT_HAS(Line(second.out, "all"), "  14.73   17.82   16.20  ") << second.out;
    EXPECT_NE(Line(second.out, "p3d_kitchen-view0_part6"), "");
}

TEST(Evaluate, ComparesTwoFiles) {
    const EvaluationDirectory directory;
    const std::string files = "evaluate --human human.csv --predicted predicted.csv";
    const Outcome outcome = ExpectSuccess(directory, files + " --csv out.csv");
    EXPECT_HAS(outcome.err, "1 of 2 viewpoints");
    // 100 early and 800 late of 4 blocks; the first is early, the third late.
    EXPECT_HAS(Line(outcome.out, "attic"), "  225    2.2   25.0   25.0") << outcome.out;
    const std::string csv = directory.Bytes("out.csv");
    EXPECT_HAS(csv, "\npredicted,attic,,1,4,0,");
    EXPECT_HAS(csv, "\npredicted,all,,1,4,0,");

    const Outcome brief = RunLull(directory, files + " --predicted all.csv --brief");
    EXPECT_EQ(Line(brief.out, "attic"), "");
    EXPECT_NE(Line(brief.out, "predicted"), "");
    EXPECT_NE(Line(brief.out, "all"), "");
    const Outcome without = RunLull(directory, files + " --predicted all.csv --without cellar");
    EXPECT_EQ(Line(without.out, "cellar"), "");
}

TEST(Evaluate, RunsRulesOnRecordings) {
    const EvaluationDirectory directory;
    const Outcome outcome =
        ExpectSuccess(directory,
                      "evaluate data.h5 --human human.csv --stop lnoise:0.51 --stop fixed:900 "
                      "--stop lnoise:0.3 --stop thresholds:all.csv --brief");
    EXPECT_HAS(outcome.err, "no thresholds for 'shed'");
    // Seven blocks of two viewpoints; at 0.3 all but the one at the cap end before they stop.
    EXPECT_HAS(Line(outcome.out, "lnoise:0.51"), "  2       7     0") << outcome.out;
    EXPECT_EQ(Line(outcome.out, "lnoise:0.51, "), "");
    EXPECT_HAS(Line(outcome.out, "lnoise:0.3, at least"), "  2       7     0     6") << outcome.out;
    EXPECT_HAS(Line(outcome.out, "lnoise:0.3, extended"), "  2       7     0     6") << outcome.out;
    // fixed: 500, 0, 700, 1600 and 275, 9100, 325: means of 700 and 3233.
    EXPECT_HAS(Line(outcome.out, "fixed:900"), "  1967   19.7") << outcome.out;
    EXPECT_NE(Line(outcome.out, "thresholds:all.csv"), "");
}

TEST(Evaluate, ComparesRivals) {
    const EvaluationDirectory directory;
    for (const char* choice : {"error", "critical"}) {
        const Outcome outcome =
            ExpectSuccess(directory,
                          "evaluate data.h5 --human human.csv --rivals --predicted "
                          "all.csv --choose-by " +
                              std::string(choice));
        // The last table has all of them.
        const std::string table = outcome.out.substr(outcome.out.rfind("\nrule ") + 1);
        for (const char* rule : {"dammertz", "cycles", "luxtile", "lnoise"})
            EXPECT_NE(Line(table, rule), "") << table;
        EXPECT_HAS(Line(table, "all "), "  2       7     0") << table;
        // Thresholds of 2400, 625 and 10000 spp: the first is at the end of the recording.
        EXPECT_HAS(Line(table, "all, clipped"), "  2       7     0") << table;
    }
    const Outcome alone =
        RunLull(directory, "evaluate data.h5 --human human.csv --rivals --without cellar");
    EXPECT_EQ(alone.exitCode, 1);
    EXPECT_HAS(alone.err, "other viewpoints");
}

TEST(Evaluate, EvaluatesRulesBySingleAnswers) {
    const EvaluationDirectory directory;
    // People stop to see noise where it is 0.5; block 3 of the attic ends at 3,740 spp.
    std::string answers = "block,spp,noise_seen\n";
    for (int block = 0; block < 4; ++block)
        for (int spp = 90; spp < 4000; spp += 180) {
            const int root = 20 + 10 * block;
            answers += fmt::format("{},{},{}\n", block, spp, int(spp < root * root));
        }
    directory.Write("answers.csv", answers);
    const std::string command =
        "evaluate data.h5 --without cellar --without shed --answers answers.csv --stop lnoise:0.5 "
        "--stop fixed:1600 --csv out.csv ";
    const Outcome outcome = ExpectSuccess(directory, command);
    EXPECT_HAS(outcome.out, "attic: 45 of 88 answers, to 4 of 4 blocks, count");
    EXPECT_HAS(outcome.out, "left out: 43 answers at spp where not every rule has");
    EXPECT_HAS(Line(outcome.out, "lnoise:0.5 "), "   100.0  ") << outcome.out;
    EXPECT_HAS(Line(outcome.out, "fixed:1600 "), "     0.0  ") << outcome.out;
    EXPECT_HAS(directory.Bytes("out.csv"), "\nlnoise:0.5,attic,45,4,");
    const Outcome brief = RunLull(directory, command + "--brief");
    EXPECT_FALSE(Contains(brief.out, "threshold  stops")) << brief.out;
}

TEST(Evaluate, SaysWhatIsWrong) {
    const EvaluationDirectory directory;
    directory.Write("answers.csv", "block,spp,noise_seen\n0,400,1\n4,400,1\n");
    directory.Write("torn.csv", "block,spp,noise_seen\n0,400,1\n0,4\n");
    directory.Write("bad.csv", "attic;20;x;\n");
    directory.Write("short.csv", "attic;20;\n");
    const struct {
        const char* arguments;
        std::vector<std::string> parts;
    } cases[] = {
        {"evaluate --human human.csv --predicted bad.csv", {"bad.csv:1: "}},
        {"evaluate --human bad.csv --predicted human.csv", {"bad.csv:1: "}},
        {"evaluate --human human.csv --predicted short.csv", {"short.csv", "1 thresholds, but 4"}},
        {"evaluate data.h5 --human short.csv --stop fixed:20", {"short.csv", "attic"}},
        {"evaluate data.h5 --human human.csv --predicted short.csv", {"short.csv", "'attic'"}},
        {"evaluate human.csv --human human.csv --stop fixed:20", {"human.csv"}},
        {"evaluate data.h5 --human human.csv --stop oracle:1", {"oracle:1"}},
        {"evaluate data.h5 --human human.csv --stop cycles:0.05", {"0.06 0.04"}},
        {"evaluate data.h5 --human human.csv --stop learned:human.csv", {"human.csv"}},
        {"evaluate data.h5 --human human.csv --stop fixed:20 --without barn", {"'barn'"}},
        {"evaluate data.h5 --human human.csv --stop fixed:20 --csv no/such/f.csv", {"no/such"}},
        {"evaluate data.h5 --without cellar --without shed --answers answers.csv --stop fixed:20",
         {"answers.csv:3: ", "block 4", "0 to 3"}},
        {"evaluate data.h5 --answers torn.csv --stop fixed:20", {"torn.csv:3: ", "'0,4'"}},
        {"evaluate data.h5 --answers human.csv --stop fixed:20",
         {"human.csv:1: ", "block,spp,noise_seen"}},
        {"evaluate data.h5 --answers answers.csv --stop fixed:20",
         {"'attic', 'cellar', 'shed'", "--without"}}};
    for (const auto& [arguments, parts] : cases) ExpectFailure(directory, arguments, parts);
    for (const char* arguments :
         {"evaluate", "evaluate --human human.csv", "evaluate --human human.csv --rivals",
          "evaluate --human human.csv --stop fixed:20", "evaluate data.h5 --human human.csv",
          "evaluate --human no.csv --predicted predicted.csv",
          "evaluate --human human.csv --predicted predicted.csv --grid 0",
          "evaluate --human human.csv --predicted predicted.csv --margins 2,x",
          "evaluate data.h5 --human human.csv --rivals --choose-by taste",
          "evaluate data.h5 --stop fixed:20", "evaluate --answers answers.csv --stop fixed:20",
          "evaluate data.h5 --answers answers.csv",
          "evaluate data.h5 --answers answers.csv --rivals --stop fixed:20",
          "evaluate data.h5 --answers answers.csv --stop fixed:20 --margins 2",
          "evaluate data.h5 --human human.csv --stop fixed:20 --block 50",
          "evaluate data.h5 --human human.csv --stop fixed:20 --choose-by critical",
          "evaluate data.h5 --human human.csv --rivals --caution 2",
          "evaluate data.h5 --answers answers.csv --human human.csv --stop fixed:20"})
        EXPECT_EQ(RunLull(directory, arguments).exitCode, 2) << arguments;
    ExpectSuccess(directory, "evaluate --help");
}

}  // namespace
}  // namespace lull
