// Runs `lull compare` and `lull bench` as their help describes them.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"

namespace lull::compare_test {
namespace {

using Json = nlohmann::json;

constexpr const char* kSize = " --resolution 100x90 --block 40 --quiet ";

struct SceneDirectory : TemporaryDirectory {
    SceneDirectory() {
        Write("scene.pbrt", SceneText(kSphere));
        Write("human.csv", "a;20;40;60;80;100;120;20;40;60;\nb;20;20;20;20;20;20;20;20;20;\n");
    }
    Json Read(const std::string& name) const { return Json::parse(ReadBytes(File(name))); }
};

std::vector<float> Green(const TemporaryDirectory& directory, const std::string& name) {
    return ReadExr(directory.File(name)).Find("G")->values;
}

TEST(Compare, OneRenderGivesTheImagesOfThree) {
    const SceneDirectory directory;
    const Outcome outcome = ExpectSuccess(
        directory, std::string("compare scene.pbrt") + kSize +
                       "--snapshots --stop dammertz:0.02 --human human.csv:a --cap 160 -o "
                       "room --report room.html --verify 2");
    EXPECT_TRUE(Contains(outcome.out, "the same bits")) << outcome.out;
    for (const char* file : {"room.automatic.exr", "room.human.png", "room.reference.exr",
                             "room.thresholds.csv", "room.compare.json", "room.html"}) {
        EXPECT_TRUE(Contains(outcome.out, std::string(file) + "\n")) << file;
        EXPECT_TRUE(std::filesystem::exists(directory.File(file))) << file;
    }

    const std::string render = std::string("render scene.pbrt --sampler random") + kSize;
    RunLull(directory, render + "--stop dammertz:0.02 --cap 160 -o a.exr");
    RunLull(directory, render + "--stop thresholds:human.csv:a --cap 160 -o h.exr");
    RunLull(directory, render + "--spp 160 -o r.exr");
    EXPECT_EQ(Green(directory, "room.automatic.exr"), Green(directory, "a.exr"));
    EXPECT_EQ(Green(directory, "room.human.exr"), Green(directory, "h.exr"));
    EXPECT_EQ(Green(directory, "room.reference.exr"), Green(directory, "r.exr"));
    EXPECT_EQ(ReadExr(directory.File("room.human.exr")).Find("spp")->values,
              ReadExr(directory.File("h.exr")).Find("spp")->values);
    EXPECT_EQ(ReadBytes(directory.File("room.automatic.png")), ReadBytes(directory.File("a.png")));

    // The same images, from their files, have the same errors.
    const Outcome files = ExpectSuccess(
        directory, "compare --automatic a.exr --human h.exr --reference r.exr --block 40 -o files");
    const Json one = directory.Read("room.compare.json"),
               other = directory.Read("files.compare.json");
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(one["images"][i]["figures"], other["images"][i]["figures"]);
        EXPECT_EQ(one["images"][i]["cost"]["samples"], other["images"][i]["cost"]["samples"]);
        EXPECT_GT(one["images"][i]["figures"]["rmseLightness"], 0);
    }
    EXPECT_EQ(one["againstHuman"]["spp"], other["againstHuman"]["spp"]);
    EXPECT_EQ(one["images"][2]["cost"]["samples"], 100 * 90 * 160);
}

TEST(Compare, SaysHowManyBlocksDifferVisibly) {
    const SceneDirectory directory;
    for (const char* spp : {"20", "160"})
        RunLull(directory, std::string("render scene.pbrt") + kSize + "--spp " + spp + " -o at" +
                               spp + ".exr");
    const std::string files = "compare --automatic at20.exr --reference at160.exr --block 40 ";
    const Outcome near = ExpectSuccess(directory, files + "--viewing 200cd,20ppd -o near");
    EXPECT_TRUE(Contains(near.out, " blocks differ visibly at 20 pixels a degree\n")) << near.out;
    RunLull(directory, files + "--viewing 200cd,90ppd -o far");
    const Json json = directory.Read("near.compare.json"), image = json["images"][0];
    EXPECT_EQ(json["viewing"]["name"], "200cd,20ppd,250lux");
    EXPECT_GT(image["figures"]["visibleDifference"],
              directory.Read("far.compare.json")["images"][0]["figures"]["visibleDifference"]);
    int visible = 0;
    for (const Json& block : image["blocks"])
        visible +=
            block["visibleDifference"].get<double>() > json["viewing"]["threshold"].get<double>();
    EXPECT_EQ(image["visibleBlocks"], visible);

    const Outcome bad = RunLull(directory, files + "--viewing 200 -o bad");
    EXPECT_EQ(bad.exitCode, 2);
    EXPECT_TRUE(Contains(bad.err, "100cd,40ppd,250lux")) << bad.err;
}

TEST(Compare, MakesTheDenoisedImageOfARender) {
    const SceneDirectory directory;
    ExpectSuccess(directory, std::string("compare scene.pbrt") + kSize +
                                 "--snapshots --denoise --stop fixed:20 --cap 300 -o room --report "
                                 "room.html");
    RunLull(directory, std::string("render scene.pbrt") + kSize +
                           "--sampler random --denoise --cap 300 -o clean.exr");
    EXPECT_EQ(Green(directory, "room.denoised.exr"), Green(directory, "clean.exr"));
    EXPECT_EQ(ReadExr(directory.File("room.denoised.exr")).Find("spp")->values,
              ReadExr(directory.File("clean.exr")).Find("spp")->values);
    const Json denoised = directory.Read("room.compare.json")["images"][1];
    EXPECT_EQ(denoised["name"], "denoised");
    EXPECT_TRUE(denoised["seams"].is_object()) << denoised["seams"];
    EXPECT_LT(denoised["figures"]["rmseLightness"],
              directory.Read("room.compare.json")["images"][0]["figures"]["rmseLightness"]);
    EXPECT_GT(denoised["cost"]["ruleSeconds"], 0);
    const Outcome files =
        RunLull(directory, "compare --denoise --automatic a.exr --reference a.exr");
    EXPECT_EQ(files.exitCode, 2) << files.err;
}

// Pictures have the figures of the display image of the EXRs beside them, and no others.
TEST(Compare, TakesPicturesForDisplays) {
    const SceneDirectory directory;
    const std::string part = " --crop 0.25,1,0,1 ";
    for (const char* spp : {"20", "160"})
        RunLull(directory, std::string("render scene.pbrt --sampler random") + kSize + part +
                               "--spp " + spp + " -o at" + spp + ".exr");
    const std::string files = "compare --block 40 ";
    const Outcome exr =
        ExpectSuccess(directory, files + "--automatic at20.exr --reference at160.exr -o exr");
    EXPECT_FALSE(Contains(exr.err, "displays"));
    const Json expected = directory.Read("exr.compare.json")["images"][0];
    for (const char* names :
         {"--human at20.png --reference at160.exr", "--human at20.exr --reference at160.png",
          "--human at20.png --reference at160.png --report r.html"}) {
        const Outcome outcome = ExpectSuccess(directory, files + names + " -o png");
        EXPECT_TRUE(Contains(outcome.err, "Pictures for displays: ")) << outcome.err;
        const Json json = directory.Read("png.compare.json"), image = json["images"][0];
        EXPECT_TRUE(Contains(json["notes"][0].get<std::string>(), "no radiance"));
        for (const Json& figures : {image["figures"], image["blocks"][0]}) {
            EXPECT_TRUE(figures["rmse"].is_null());
            EXPECT_TRUE(figures["relMse"].is_null());
        }
        for (const char* figure : {"rmseLightness", "psnr", "ssim", "flip", "visibleDifference"}) {
            EXPECT_EQ(image["figures"][figure], expected["figures"][figure]) << names << figure;
            EXPECT_EQ(image["blocks"][1][figure], expected["blocks"][1][figure]);
        }
    }
    // Beside a render, too.
    const Outcome beside =
        ExpectSuccess(directory, std::string("compare scene.pbrt") + kSize + part +
                                     "--stop fixed:20 --reference at160.png --cap 160 -o beside");
    const Json image = directory.Read("beside.compare.json")["images"][0];
    EXPECT_EQ(image["figures"]["flip"], expected["figures"]["flip"]);
    EXPECT_TRUE(image["figures"]["rmse"].is_null());
}

// Returns a grey TIFF of 64x64 pixels, each of so many bytes 128.
std::string GreyTiff(int bytes) {
    const auto number = [](int value, int size) {
        std::string text;
        for (int i = 0; i < size; ++i) text += char(value >> 8 * i & 255);
        return text;
    };
    std::string file = "II" + number(42, 2) + number(8, 4) + number(8, 2);
    for (const auto& [tag, value] : std::vector<std::pair<int, int>>{{256, 64},
                                                                     {257, 64},
                                                                     {258, 8 * bytes},
                                                                     {259, 1},
                                                                     {262, 1},
                                                                     {273, 110},
                                                                     {278, 64},
                                                                     {279, 64 * 64 * bytes}})
        file += number(tag, 2) + number(4, 2) + number(1, 4) + number(value, 4);
    return file + number(0, 4) + std::string(size_t(64 * 64 * bytes), '\x80');
}

TEST(Compare, ReadsJpegAndGreyPictures) {
    const SceneDirectory directory;
    // Both 64x64 of the one value 128, which a JPEG's coefficients, all 0, stand for: each is a
    // code of one bit, and so is the end of a block.
    directory.Write(
        "grey.png",
        FromHex(
            "89504e470d0a1a0a0000000d49484452000000400000004008000000008f022e02000000294944415478da"
            "edcc411100000c0220a31bdd10fbed2000e951040281402010080402814020107c0f06df6d007970ba79fa"
            "0000000049454e44ae426082"));
    directory.Write("colour.JPG",
                    FromHex("ffd8ffdb004300") + std::string(64, '\x08') +
                        FromHex("ffc00011080040004003011100021100031100"
                                "ffc400140001" +
                                std::string(32, '0') + "ffc400141001" + std::string(32, '0') +
                                "ffda000c03010002000300003f00") +
                        std::string(48, '\0') + FromHex("ffd9"));
    ExpectSuccess(directory, "compare --automatic grey.png --reference colour.JPG -o both");
    const Json figures = directory.Read("both.compare.json")["images"][0]["figures"];
    EXPECT_LT(figures["rmseLightness"], 0.5);  // a step of 8 bits, if the JPEG has rounded
    directory.Write("grey.tif", GreyTiff(1));
    directory.Write("large.tif", GreyTiff(2));
    const Outcome tiff = ExpectSuccess(
        directory, "compare --automatic grey.tif --reference grey.png -o made/here/ --block 40");
    EXPECT_TRUE(Contains(tiff.out, "made/here/lull.compare.json\n"));
    EXPECT_EQ(
        directory.Read("made/here/lull.compare.json")["images"][0]["figures"]["rmseLightness"], 0);
    ExpectFailure(directory, "compare --automatic large.tif --reference grey.png",
                  {"large.tif", "8 bits"});
    RunLull(directory, "render scene.pbrt --spp 1 --quiet -o small.exr");
    ExpectFailure(directory, "compare --automatic small.exr --reference colour.JPG",
                  {"colour.JPG", "different sizes", "64x64"});
}

TEST(Compare, RendersNoFurtherThanItMustBesideAReference) {
    const SceneDirectory directory;
    RunLull(directory, std::string("render scene.pbrt") + kSize + "--spp 160 -o r.exr");
    ExpectSuccess(directory,
                  std::string("compare scene.pbrt") + kSize +
                      "--stop fixed:60 --human human.csv:b --reference r.exr --cap 160 -o room");
    const Json json = directory.Read("room.compare.json");
    EXPECT_EQ(json["images"][0]["cost"]["samples"], 100 * 90 * 60);
    EXPECT_EQ(json["images"][0]["saved"]["estimated"], true);
    EXPECT_EQ(json["againstHuman"]["later"], 9);
    EXPECT_FALSE(std::filesystem::exists(directory.File("room.reference.exr")));
}

TEST(Compare, GoesOnAfterAnInterruption) {
    const SceneDirectory directory;
    const std::string command = std::string("compare scene.pbrt") + kSize +
                                "--snapshots --stop dammertz:0.01 --human human.csv:a --cap 400 ";
    ExpectSuccess(directory, command + "-o whole");
    int kills = 0;
    for (; kills < 100; ++kills) {
        const std::string limit =
            kills < 5 ? "timeout -s KILL 0." + std::to_string(2 + kills) + " " : "";
        const Outcome outcome = RunShell(
            directory, limit + "LULL " + command +
                           "-o parts --checkpoint c.h5 --checkpoint-interval 0.1 --resume");
        if (outcome.exitCode == 0) break;
        ASSERT_EQ(outcome.exitCode, 137) << outcome.err;
    }
    for (const char* image : {"automatic", "human", "reference"})
        EXPECT_EQ(ReadBytes(directory.File(std::string("parts.") + image + ".png")),
                  ReadBytes(directory.File(std::string("whole.") + image + ".png")));
    EXPECT_EQ(directory.Read("parts.compare.json")["images"][1]["figures"],
              directory.Read("whole.compare.json")["images"][1]["figures"]);
    EXPECT_FALSE(std::filesystem::exists(directory.File("c.h5")));
}

TEST(Compare, SaysWhatIsMissingOrWrong) {
    const SceneDirectory directory;
    RunLull(directory, "render scene.pbrt --spp 1 --quiet -o small.exr");
    RunLull(directory, "render scene.pbrt --spp 1 --quiet -o crop.exr --crop 0,0.5,0,1");
    directory.Write("text.exr", "no image");
    const std::string scene = std::string("compare scene.pbrt") + kSize;
    ExpectFailure(directory, "compare", {"a scene is missing"});
    ExpectFailure(directory, scene, {"--snapshots", "--reference"});
    ExpectFailure(directory, scene + "--snapshots --human human.csv:c",
                  {"human.csv", "no row 'c'"});
    ExpectFailure(directory, scene + "--snapshots --human missing.csv", {"missing.csv"});
    ExpectFailure(
        directory,
        "compare scene.pbrt --block 50 --resolution 100x90 --snapshots --human human.csv:a",
        {"9 blocks", "the image has 4"});
    ExpectFailure(directory, scene + "--snapshots --stop dammertz:x", {"--stop", "'x'"}, 2);
    ExpectFailure(directory, scene + "--reference small.exr", {"small.exr", "100x90 pixels"});
    ExpectFailure(directory, scene + "--snapshots -o nowhere/room", {"nowhere"});
    ExpectFailure(directory, scene + "--snapshots -o text.exr/", {"-o text.exr/"});
    ExpectFailure(directory, "compare --automatic small.exr --reference crop.exr",
                  {"crop.exr", "different sizes"});
    ExpectFailure(directory, "compare --automatic small.exr --reference text.exr", {"text.exr"});
    ExpectFailure(directory, "compare --reference small.exr --human human.csv",
                  {"human.csv", "need a scene"});
    for (const char* arguments :
         {"compare scene.pbrt --snapshots --reference r.exr", "compare --snapshots",
          "compare --automatic small.exr --reference small.exr --resolution 9x9",
          "compare --automatic small.exr --reference small.exr --seed 1",
          "compare scene.pbrt --automatic a.exr", "compare scene.pbrt --snapshots --verify x",
          "compare scene.pbrt --snapshots --report r.pdf"})
        EXPECT_EQ(RunLull(directory, arguments).exitCode, 2) << arguments;
}

TEST(Bench, WritesPointsForBothSamplersAndOtherRenderers) {
    const SceneDirectory directory;
    const std::string size = " --resolution 48x44 --block 44 --quiet ";
    RunLull(directory, "render scene.pbrt" + size + "--spp 7 -o other.exr");
    directory.Write("others.csv", "someone,3.5,other.exr\n");
    const Outcome outcome = ExpectSuccess(
        directory,
        "bench scene.pbrt" + size +
            "--cap 100 --rule dammertz:0.03 --external others.csv -o room --report room.html");
    EXPECT_EQ(outcome.out, "room.csv\nroom.html\n");
    const std::string csv = ReadBytes(directory.File("room.csv"));
    for (const char* part :
         {"\nfixed,20,sobol-halves,20,", "\nfixed,60,random,60,", "\nlnoise,0.5,random,",
          "\nentropy,0.5,random,", "\nlearned,,sobol-halves,", "\ndammertz,0.03,sobol-halves,",
          "\nsomeone,,,0,3.5,"})
        EXPECT_TRUE(Contains(csv, part)) << part << csv;
    // Fixed, 5 sweeps of 8, learned and the extra rule, for both samplers, and the line of names.
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (4 + 40 + 2) + 1);
    for (const auto& entry : std::filesystem::directory_iterator(directory.path))
        EXPECT_FALSE(Contains(entry.path().string(), "checkpoint")) << entry.path();
}

TEST(Bench, DenoisesToo) {
    const SceneDirectory directory;
    ExpectSuccess(directory,
                  "bench scene.pbrt --resolution 48x44 --block 44 --cap 100 "
                  "--samplers sobol-halves --denoise --rule denoised:20 -o room");
    std::map<std::string, double> errors, ruleSeconds;
    std::istringstream lines(ReadBytes(directory.File("room.csv")));
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> fields;
        std::istringstream in(line);
        for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
        if (fields[0] == "rule") continue;
        const std::string name = fields[0] + ":" + fields[1];
        errors[name] = std::stod(fields[8]);
        ruleSeconds[name] = std::stod(fields[6]);
    }
    // Two looks, at 20 and at 40 spp.
    ASSERT_TRUE(errors.contains("denoised:20") && errors.contains("denoised:3.1"));
    EXPECT_NE(errors["denoised:20"], errors["fixed:40"]);
    EXPECT_GT(ruleSeconds["denoised:20"], 0);
    const Outcome without = RunLull(directory, "bench scene.pbrt --rule denoised --cap 20 -o b");
    EXPECT_EQ(without.exitCode, 1);
    EXPECT_TRUE(Contains(without.err, "--denoise")) << without.err;
}

TEST(Bench, GoesOnAfterAnInterruption) {
    const SceneDirectory directory;
    const std::string command =
        "bench scene.pbrt --resolution 48x44 --block 44 --quiet --cap 400 --checkpoint-interval "
        "0.1 -o ";
    ExpectSuccess(directory, command + "whole");
    for (int kill = 0; kill < 100; ++kill) {
        const std::string limit =
            kill < 6 ? "timeout -s KILL 0." + std::to_string(2 + kill) + " " : "";
        const Outcome outcome = RunShell(directory, limit + "LULL " + command + "parts");
        if (outcome.exitCode == 0) break;
        ASSERT_EQ(outcome.exitCode, 137) << outcome.err;
    }
    // All but the seconds is the same.
    const auto withoutSeconds = [&](const char* name) {
        std::istringstream in(ReadBytes(directory.File(name)));
        std::string text, line;
        while (std::getline(in, line)) {
            int column = 0;
            for (const char c : line) {
                column += c == ',';
                if (column < 4 || column > 6) text += c;
            }
        }
        return text;
    };
    EXPECT_EQ(withoutSeconds("parts.csv"), withoutSeconds("whole.csv"));
}

TEST(Bench, SaysWhatIsWrong) {
    const SceneDirectory directory;
    directory.Write("others.csv", "someone,3.5\n");
    directory.Write("lost.csv", "someone,3.5,lost.exr\n");
    ExpectFailure(directory, "bench scene.pbrt --external others.csv",
                  {"others.csv:1: ", "name,seconds,file.exr"});
    ExpectFailure(directory, "bench scene.pbrt --external lost.csv", {"lost.exr"});
    ExpectFailure(directory, "bench scene.pbrt --rule dammertz:x", {"--rule", "'x'"}, 2);
    ExpectFailure(directory, "bench scene.pbrt --samplers random,random",
                  {"--samplers: random is given twice"}, 2);
    EXPECT_EQ(RunLull(directory, "bench scene.pbrt --samplers halton").exitCode, 2);
    EXPECT_EQ(RunLull(directory, "bench").exitCode, 2);
}

TEST(RenderReport, IsAPageWhereItsNameSaysSo) {
    const SceneDirectory directory;
    ExpectSuccess(directory, std::string("render scene.pbrt") + kSize +
                                 "--stop lnoise:2 --cap 200 -o i.exr --report r.html");
    EXPECT_TRUE(ReadBytes(directory.File("r.html")).starts_with("<!DOCTYPE html>"));
    RunLull(directory, std::string("render scene.pbrt") + kSize +
                           "--stop lnoise:2 --cap 200 -o j.exr --report r.json");
    EXPECT_EQ(ReadBytes(directory.File("i.thresholds.csv")),
              ReadBytes(directory.File("j.thresholds.csv")));
    EXPECT_EQ(ReadBytes(directory.File("i.png")), ReadBytes(directory.File("j.png")));
}

}  // namespace
}  // namespace lull::compare_test
