// Uses the pictures of another renderer as a laboratory would.
#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

#include "renderer/image/image_io.h"
#include "stopping/lab/recordings/recording.h"
#include "tests/integration/run_lull.h"
#include "tests/stopping/lab/observers/example_answers.h"

namespace lull {
namespace {

constexpr const char* kRoom = "Material \"matte\" \"rgb Kd\" [.5 .4 .3]\nShape \"sphere\"";

// A folder "room" of pictures of 100x100 pixels at 20, 40, ... 200 spp, as a renderer leaves them.
struct PictureDirectory : TemporaryDirectory {
    PictureDirectory() {
        Write("scene.pbrt", SceneText(kRoom));
        std::filesystem::create_directory(path / "room");
        for (int spp = 20; spp <= 200; spp += 20) {
            // Each takes up the samples of the one before.
            ExpectSuccess(*this, fmt::format("render scene.pbrt --resolution 100x100 --quiet --spp "
                                             "{} --sampler random -o r.exr --checkpoint r.h5 "
                                             "--resume --keep-checkpoint",
                                             spp));
            std::filesystem::rename(File("r.png"), File(fmt::format("room/tex_{}.png", spp)));
        }
        std::filesystem::remove(File("r.h5"));
        Write("human.csv", "room;60;90;200;120;\nhall;20;20;20;20;\n");
    }
};

TEST(Pictures, AreRecordedAndJudgedAsScenesAre) {
    const PictureDirectory directory;
    const Outcome made =
        ExpectSuccess(directory, "record --images room -o data.h5 --block 50 --threads 1");
    EXPECT_EQ(made.out, "data.h5\n");
    EXPECT_HAS(made.err, "room: 10 pictures of 20 to 200 spp, 4 of 4 blocks");
    const ViewpointRecording room = ReadDataset(directory.File("data.h5")).at(0);
    EXPECT_EQ(room.name, "room");
    EXPECT_EQ(room.blocks.at(3).Count(), 10);
    // What a render of the same samples records of its picture, but for halves.
    ExpectSuccess(
        directory,
        "record scene.pbrt --name own -o own.h5 --resolution 100x100 --block 50 --cap 200 "
        "--quiet --estimator combined");
    const ViewpointRecording own = ReadDataset(directory.File("own.h5")).at(0);
    for (const char* channel : {"h4", "h100", "h1", "attributes26"})
        EXPECT_TRUE(std::ranges::equal(room.blocks.at(2).Values(4, channel),
                                       own.blocks.at(2).Values(4, channel)))
            << channel;
    EXPECT_HAS(ExpectSuccess(directory, "record --images room -o data.h5 --block 50").err,
               "has all blocks of 'room' already");

    const std::string rules = " --human human.csv --stop entropy:1 --stop fixed:100 --brief";
    const Outcome fromData = ExpectSuccess(directory, "evaluate data.h5" + rules);
    EXPECT_EQ(
        RunLull(directory, "evaluate --images room --block 50 --split paper:split.csv" + rules)
            .exitCode,
        1);  // there is no such file
    directory.Write("split.csv", "room;0;1;\n");
    const Outcome test =
        ExpectSuccess(directory,
                      "evaluate --images room:room --block 50 --csv a.csv --curves c.csv "
                      "--split paper:split.csv" +
                          rules);
    EXPECT_HAS(test.err, "2 blocks that split.csv does not list");
    EXPECT_TRUE(directory.Bytes("c.csv").starts_with(
        "rule,viewpoint,block,human,stop,spp,value,threshold,noisy\n"
        "entropy:1,room,2,200,"));
    EXPECT_FALSE(Contains(directory.Bytes("c.csv"), "entropy:1,room,1,"));
    EXPECT_EQ(ExpectSuccess(directory, "evaluate --images room --block 50" + rules).out,
              fromData.out);
    EXPECT_HAS(
        RunLull(directory, "evaluate --images room --block 50 --human human.csv --stop lnoise").err,
        "half of the samples");
}

TEST(Pictures, MakeTheImageOfPeople) {
    const PictureDirectory directory;
    const Outcome outcome = ExpectSuccess(
        directory, "compare --images room --human human.csv --stop fixed:80 --block 50 -o out");
    for (const char* file : {"out.automatic.png", "out.human.png", "out.reference.png",
                             "out.thresholds.csv", "out.compare.json"})
        EXPECT_HAS(outcome.out, std::string(file) + "\n");
    EXPECT_EQ(directory.Bytes("out.thresholds.csv"), "room;80;80;80;80;\n");
    const auto json = nlohmann::json::parse(directory.Bytes("out.compare.json"));
    ASSERT_EQ(json["images"].size(), 3u);
    // 60, 100 (the first of at least 90), 200 and 120 spp.
    EXPECT_EQ(json["images"][1]["name"], "human");
    EXPECT_HAS(outcome.out, "    120.0");
    // The folder's thresholds by another name; and what does not fit.
    ExpectSuccess(directory, "compare --images room:attic --human human.csv:room --block 50 -o b");
    ExpectFailure(directory, "compare --images room:attic --human human.csv --block 50 -o c",
                  {"human.csv"});
    ExpectFailure(directory, "compare --images room --human human.csv -o c", {"human.csv"});
    ExpectFailure(directory, "compare --images nowhere -o c", {"--images nowhere"});
    EXPECT_EQ(RunLull(directory, "compare --images room scene.pbrt").exitCode, 2);
    EXPECT_EQ(RunLull(directory, "compare --images room --reference r.exr").exitCode, 2);
    ExpectFailure(directory, "compare --images room --cap 20",
                  {"--max-spp: has no effect with --images"}, 2);
    ExpectFailure(directory, "record --images room -o data.h5 --resolution 9x9",
                  {"--resolution: has no effect with --images"}, 2);
}

TEST(Pictures, HaveEntropies) {
    const PictureDirectory directory;
    const Outcome one = ExpectSuccess(directory,
                                      "entropy room/tex_100.png --block 50 --csv e.csv --values "
                                      "--attributes --sub-blocks 25");
    EXPECT_EQ(std::ranges::count(one.out, '\n'), 1 + 4 + 2) << one.out;
    const std::string csv = directory.Bytes("e.csv");
    EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 1 + 4 * 26);
    EXPECT_HAS(csv, "\n,room/tex_100.png,100,,,0,0,100,100,") << csv.substr(0, 400);
    EXPECT_HAS(csv, "\n,room/tex_100.png,100,3,24,90,90,10,10,");
    const std::string head = csv.substr(0, csv.find('\n'));
    for (size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1)  // as many fields
        EXPECT_EQ(std::count(csv.begin() + ptrdiff_t(at),
                             csv.begin() + ptrdiff_t(csv.find('\n', at)), ','),
                  std::ranges::count(head, ','));
    // In the order of spp, by name or by folder: entropies fall.
    const Outcome folder = ExpectSuccess(directory, "entropy --images room --block 50 --csv f.csv");
    EXPECT_EQ(ExpectSuccess(directory, "entropy room/tex_*.png --block 50").out, folder.out);
    EXPECT_LT(folder.out.find("tex_40.png"), folder.out.find("tex_100.png"));
    EXPECT_HAS(directory.Bytes("f.csv"), "\nroom,room/tex_200.png,200,3,,50,50,");
    ExpectFailure(directory, "entropy room/tex_20.png --block 7", {"tex_20.png", "too small"});
    ExpectFailure(directory, "entropy nowhere.png", {"nowhere.png"});
    for (const char* usage :
         {"entropy", "entropy room/tex_20.png --sub-blocks 99", "entropy room/tex_20.png --values"})
        EXPECT_EQ(RunLull(directory, usage).exitCode, 2) << usage;
}

// Writes pictures of 100x100 pixels at 20, 40, ... 320 spp; block i has (i + 1) times the noise.
void WriteNoisyPictures(const TemporaryDirectory& directory) {
    std::filesystem::create_directory(directory.path / "kitchen");
    for (int spp = 20; spp <= 320; spp += 20) {
        std::mt19937 generator{unsigned(spp)};
        std::normal_distribution<float> gauss;
        std::vector<Rgb> pixels;
        for (int i = 0; i < 100 * 100; ++i) {
            const int x = i % 100, y = i / 100, block = x / 50 + 2 * (y / 50);
            const float truth = 0.2f + 0.003f * float(x);
            pixels.push_back(Rgb::Constant(truth + 0.2f * float(block + 1) / std::sqrt(float(spp)) *
                                                       gauss(generator)));
        }
        WritePng(directory.File(fmt::format("kitchen/k_{}.png", spp)), pixels, 100, 100);
    }
}

TEST(Laboratory, GoesFromPicturesToATableAndAFigure) {
    const TemporaryDirectory directory;
    WriteNoisyPictures(directory);
    const auto run = [&](const std::string& rest) {
        return RunShell(directory, "export LEVELS=5 && export \"L\"ULL=LULL && bash '" +
                                       std::string(LULL_TESTS_DIR) +
                                       "/../stopping/examples/laboratory.sh' kitchen " + rest);
    };
    EXPECT_EQ(run("answers").exitCode, 2);
    std::filesystem::create_directory(directory.path / "answers");
    const Outcome study = ExpectSuccess(run("answers out 50"));
    EXPECT_HAS(study.out, "Give out/study.html to observers");
    // Observers answer, as the page saves it.
    const std::string page = directory.Bytes("out/study.html");
    const size_t at = page.find("\"id\":\"") + 6;
    for (const char* observer : {"ada", "bo"})
        directory.Write(std::string("answers/") + observer + ".json",
                        ExampleAnswers{.observer = observer,
                                       .session = observer,
                                       .study = page.substr(at, 16),
                                       .viewpoint = "kitchen"}
                            .Text());
    const Outcome whole = ExpectSuccess(run("answers out 50"));
    EXPECT_HAS(directory.Bytes("out/human.csv"), "kitchen;40;80;160;320;");
    for (const char* file : {"entropies.csv", "collected.html", "data.h5", "own.h5", "blocks.csv",
                             "curves.csv", "kitchen.human.png", "compare.html"})
        EXPECT_FALSE(directory.Bytes(std::string("out/") + file).empty()) << file;
    EXPECT_HAS(directory.Bytes("out/table.csv"), "learned:out/own.h5,");
    // With thresholds that are there already, there is nobody to ask.
    ExpectSuccess(run("out/human.csv again 50"));
    EXPECT_FALSE(directory.Has("again/study.html"));
}

TEST(Preset, ListsItsValues) {
    const TemporaryDirectory directory;
    const Outcome paper = ExpectSuccess(directory, "train --preset paper");
    for (const char* line :
         {"--k 8\n", "--n 40\n", "--features H\n", "--units 512,128,32\n", "--epochs 30\n"})
        EXPECT_HAS(paper.out, line);
    EXPECT_HAS(ExpectSuccess(directory, "train --preset entropy").out, "--ratio 1.4142\n");
    EXPECT_EQ(RunLull(directory, "train -o m.h5").exitCode, 2);
}

TEST(PaperFull, SaysWhyItDoesNotShip) {
    const SceneDirectory directory;
    ExpectFailure(directory, "render scene.pbrt --stop learned:paper-full -o a.exr",
                  {"paper-full", "--preset paper"});
}

}  // namespace
}  // namespace lull
