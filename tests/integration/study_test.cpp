// Makes studies and collects answers; the page itself is used in study_page.py.
#include <gtest/gtest.h>

#include "stopping/lab/recordings/recording.h"
#include "stopping/rules/thresholds.h"
#include "tests/integration/run_and_signal.h"
#include "tests/stopping/lab/observers/example_answers.h"

namespace lull {
namespace {

// Returns all of the page from the description of the study on: what it was made of, and pictures.
std::string StudyIn(const std::string& page) {
    const size_t begin = page.find("<script type=\"application/json\" id=\"study\">");
    EXPECT_NE(begin, std::string::npos);
    return page.substr(std::min(begin, page.size()));
}

TEST(Study, RecordsWhatRecordDoes) {
    const SceneDirectory directory;
    const std::string same = " scene.pbrt --resolution 60x40 --cap 60 --name room --quiet ";
    const Outcome judge = ExpectSuccess(directory, "study -o s.html --record a.h5" + same);
    EXPECT_HAS(judge.out, "s.html\na.h5\n");
    ExpectSuccess(directory, "record -o b.h5" + same);
    const ViewpointRecording a = ReadDataset(directory.File("a.h5")).at(0);
    const ViewpointRecording b = ReadDataset(directory.File("b.h5")).at(0);
    EXPECT_EQ(a.name, "room");
    EXPECT_EQ(a.cap, 60);
    EXPECT_EQ(a.provenance, b.provenance);
    ASSERT_EQ(a.blocks.size(), 1u);
    EXPECT_EQ(a.blocks.at(0).spp, b.blocks.at(0).spp);
    EXPECT_EQ(a.blocks.at(0).values, b.blocks.at(0).values);
}

TEST(Study, GoesOnWhereItWasInterrupted) {
    const SceneDirectory directory;
    const std::string command =
        "LULL study scene.pbrt --resolution 80x80 --block 40 --cap 400 --threads 1 --quiet "
        "--checkpoint-interval 0.1 -o ";
    const Outcome interrupted =
        RunAndSignal(directory, command + "a.html", SIGINT, "a.html.checkpoint");
    ASSERT_EQ(interrupted.exitCode, 130) << interrupted.err;
    EXPECT_HAS(interrupted.err, "interrupted; to resume: ");
    EXPECT_FALSE(Contains(interrupted.err, "--resume")) << interrupted.err;
    EXPECT_EQ(directory.Bytes("a.html"), "");
    ExpectSuccess(RunShell(directory, command + "a.html"));
    ExpectSuccess(RunShell(directory, command + "b.html"));
    EXPECT_EQ(StudyIn(directory.Bytes("a.html")), StudyIn(directory.Bytes("b.html")));
    EXPECT_EQ(directory.CountFiles(), 3);  // the scene and two studies
}

TEST(Study, TakesPicturesOfOtherRenderers) {
    const SceneDirectory directory;
    std::filesystem::create_directory(directory.path / "pictures");
    for (const char* spp : {"20", "40", "80"}) {
        ExpectSuccess(
            directory,
            fmt::format("render scene.pbrt --sampler random --quiet --spp {0} -o r.exr", spp));
        std::filesystem::rename(directory.File("r.png"),
                                directory.File(fmt::format("pictures/r-{}spp.png", spp)));
    }
    const Outcome own =
        RunLull(directory,
                "study scene.pbrt --cap 80 --levels 3 --block 10 --estimator combined --name x "
                "-o own.html --quiet");
    const Outcome other =
        RunLull(directory, "study --images pictures --block 10 --name x -o other.html");
    ASSERT_EQ(own.exitCode, 0) << own.err;
    ASSERT_EQ(other.exitCode, 0) << other.err;
    EXPECT_HAS(other.err, "6 blocks at 3 levels: 20, 40, 80 spp");
    // The same pictures, bit for bit: the images that lull itself would have rendered.
    const auto pictures = [&](const char* file) {
        const std::string page = StudyIn(directory.Bytes(file));
        return page.substr(page.find("id=\"pictures-0\""));
    };
    EXPECT_EQ(pictures("own.html"), pictures("other.html"));
}

TEST(Study, CollectsThresholdsAndSaysWhoWasLeftOut) {
    const TemporaryDirectory directory;
    directory.Write("a.json", ExampleAnswers{.observer = R"(a, \"b\")", .session = "1"}.Text());
    const auto with = [](ExampleAnswers answers) { return answers.Text(); };
    directory.Write("b.json", with({.observer = "b", .session = "2", .levels = {3, 2, 3, 4}}));
    directory.Write("c.json", with({.observer = "c", .session = "3", .failed = 3}));
    directory.Write("d.json", "{\"format\":");
    const Outcome outcome = ExpectSuccess(
        directory, "study --collect a.json b.json c.json d.json -o human.csv --report r.html");
    EXPECT_EQ(outcome.out,
              "human.csv\nhuman.details.csv\nhuman.observers.csv\nhuman.answers.csv\nr.html\n");
    EXPECT_HAS(outcome.err, "c.json: c failed 3 of 4 checks; left out");
    EXPECT_HAS(outcome.err, "d.json: is not JSON, or cut short; left out");
    EXPECT_EQ(directory.Bytes("human.csv"), "room;100;80;160;320;\n");
    const std::string observers = directory.Bytes("human.observers.csv");
    EXPECT_HAS(observers, "a.json,room,\"a, \"\"b\"\"\",yes,");
    EXPECT_HAS(observers, "c.json,room,c,no,failed 3 of 4 checks,");
    EXPECT_HAS(observers, "d.json,,,no,\"is not JSON, or cut short\",");
    EXPECT_HAS(directory.Bytes("human.details.csv"), "room,0,2,100,40,160,84.85,1.414,2\n");
    EXPECT_HAS(outcome.err, "rest on as few as 2 answers; they are rough");
    EXPECT_TRUE(directory.Bytes("human.answers.csv")
                    .starts_with("block,spp,noise_seen,observer,track\n0,40,0,"));
    EXPECT_EQ(ReadThresholds(directory.File("human.csv")).at(0).spp.size(), 4u);
}

TEST(Study, RefusesWhatDoesNotFit) {
    const SceneDirectory directory;
    directory.Write("bad.json", "{}");
    ExpectFailure(directory, "study --collect bad.json -o human.csv", {"none of 1 files"});
    ExpectFailure(directory, "study --collect bad.json -o human.csv --study bad.json",
                  {"bad.json: not a page made by lull study"});
    ExpectFailure(directory, "study scene.pbrt -o s.html --cap 20",
                  {"--max-spp 20", "a ladder needs"});
    ExpectFailure(directory, "study scene.pbrt -o s.html --record d.h5", {"cannot be recorded"});
    ExpectFailure(directory, "study --images nowhere -o s.html", {"--images nowhere"});
    ExpectFailure(directory, "study scene.pbrt -o s.html --questions",
                  {"there is no option --questions any more"}, 2);
    ExpectFailure(directory, "study scene.pbrt -o no/such/s.html", {"no/such"});
    for (const char* usage :
         {"study -o s.html", "study scene.pbrt", "study scene.pbrt -o s.csv",
          "study scene.pbrt --images x -o s.html", "study --images x --record d.h5 -o s.html",
          "study --images x --seed 1 -o s.html", "study --collect bad.json --cap 20 -o human.csv",
          "study --collect bad.json -o s.html", "study scene.pbrt -o s.html --report r.html",
          "study scene.pbrt -o s.html --repeats 2"})
        EXPECT_EQ(RunLull(directory, usage).exitCode, 2) << usage;
}

}  // namespace
}  // namespace lull
