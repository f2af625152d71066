// Runs `lull compare` as its help describes it.
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"

namespace lull::compare_test {
namespace {

using Json = nlohmann::json;

const std::string kScene = " scene.pbrt --resolution 100x90 --block 40 --quiet ";

struct HumanDirectory : SceneDirectory {
    HumanDirectory() {
        Write("human.csv", "a;20;40;60;80;100;120;20;40;60;\nb;20;20;20;20;20;20;20;20;20;\n");
    }
    Json Read(const std::string& name) const { return Json::parse(ReadBytes(File(name))); }
};

std::vector<float> Values(const TemporaryDirectory& directory, const std::string& name,
                          const std::string& channel = "G") {
    return ReadExr(directory.File(name)).Find(channel)->values;
}

TEST(Compare, OneRenderGivesTheImagesOfThree) {
    const HumanDirectory directory;
    const Outcome outcome = ExpectSuccess(
        directory, "compare" + kScene +
                       "--snapshots --stop dammertz:0.02 --human human.csv:a --cap 160 -o "
                       "room --report room.html --verify 2");
    EXPECT_HAS(outcome.out, "the same bits");
    for (const char* file : {"room.automatic.exr", "room.human.png", "room.reference.exr",
                             "room.thresholds.csv", "room.compare.json", "room.html"}) {
        EXPECT_HAS(outcome.out, std::string(file) + "\n") << file;
        EXPECT_TRUE(directory.Has(file)) << file;
    }

    const std::string render = "render" + kScene;
    RunLull(directory, render + "--stop dammertz:0.02 --cap 160 -o a.exr");
    RunLull(directory, render + "--stop thresholds:human.csv:a --cap 160 -o h.exr");
    RunLull(directory, render + "--spp 160 -o r.exr");
    EXPECT_EQ(Values(directory, "room.automatic.exr"), Values(directory, "a.exr"));
    EXPECT_EQ(Values(directory, "room.human.exr"), Values(directory, "h.exr"));
    EXPECT_EQ(Values(directory, "room.reference.exr"), Values(directory, "r.exr"));
    EXPECT_EQ(Values(directory, "room.human.exr", "spp"), Values(directory, "h.exr", "spp"));
    EXPECT_EQ(directory.Bytes("room.automatic.png"), directory.Bytes("a.png"));

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
    const HumanDirectory directory;
    for (const char* spp : {"20", "160"})
        RunLull(directory, "render" + kScene + "--spp " + spp + " -o at" + spp + ".exr");
    const std::string files = "compare --automatic at20.exr --reference at160.exr --block 40 ";
    const Outcome near = ExpectSuccess(directory, files + "--viewing 200cd,20ppd -o near");
    EXPECT_HAS(near.out, " blocks differ visibly at 20 pixels a degree\n");
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
    EXPECT_HAS(bad.err, "100cd,40ppd,250lux");
}

TEST(Compare, MakesTheDenoisedImageOfARender) {
    const HumanDirectory directory;
    ExpectSuccess(directory, "compare" + kScene +
                                 "--snapshots --denoise --stop fixed:20 --cap 300 -o room --report "
                                 "room.html");
    RunLull(directory, "render" + kScene + "--denoise --cap 300 -o clean.exr");
    EXPECT_EQ(Values(directory, "room.denoised.exr"), Values(directory, "clean.exr"));
    EXPECT_EQ(Values(directory, "room.denoised.exr", "spp"), Values(directory, "clean.exr", "spp"));
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

// Both blocks of a place stop with the later, and each eye is denoised and measured by itself.
TEST(Compare, TakesPairs) {
    const HumanDirectory directory;
    const std::string pair = kScene + "--stereo 0.3,4 ";
    const Outcome outcome =
        ExpectSuccess(directory, "compare" + pair +
                                     "--snapshots --denoise --stop lnoise:1.5 --cap 160 -o room "
                                     "--verify 1");
    EXPECT_HAS(outcome.out, "the same bits");
    RunLull(directory, "render" + pair + "--stop lnoise:1.5 --cap 160 -o a.exr");
    RunLull(directory, "render" + pair + "--denoise --cap 160 -o clean.exr");
    RunLull(directory, "render" + pair + "--spp 160 -o r.exr");
    for (const auto& [file, same] :
         {std::pair("room.automatic", "a"), std::pair("room.denoised", "clean"),
          std::pair("room.reference", "r")}) {
        const ExrImage made = ReadExr(directory.File(std::string(file) + ".exr")),
                       rendered = ReadExr(directory.File(std::string(same) + ".exr"));
        for (const char* channel : {"G", "right.G", "spp", "right.spp"})
            EXPECT_EQ(made.Find(channel)->values, rendered.Find(channel)->values) << file;
        EXPECT_EQ(directory.Bytes(std::string(file) + ".right.png"),
                  directory.Bytes(std::string(same) + ".right.png"));
    }
    ExpectSuccess(directory, "compare --automatic a.exr --reference r.exr --block 40 -o files");
    const Json one = directory.Read("room.compare.json")["images"][0],
               other = directory.Read("files.compare.json")["images"][0];
    EXPECT_EQ(one["figures"], other["figures"]);
    EXPECT_EQ(one["eyes"], other["eyes"]);
    EXPECT_EQ(one["blocks"][17]["flip"], other["blocks"][17]["flip"]);
    const Outcome refused = RunLull(directory, "denoise a.exr");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_HAS(refused.err, "a.exr: is a pair");
}

// Pictures have the figures of the display image of the EXRs beside them, and no others.
TEST(Compare, TakesPicturesForDisplays) {
    const HumanDirectory directory;
    for (const char* spp : {"20", "160"})
        RunLull(directory, "render" + kScene + "--spp " + spp + " -o at" + spp + ".exr");
    const std::string files = "compare --block 40 --reference at160.exr ";
    ExpectSuccess(directory, files + "--automatic at20.exr -o exr");
    const Outcome outcome = ExpectSuccess(directory, files + "--human at20.png -o png");
    EXPECT_HAS(outcome.err, "Pictures for displays: ");
    const Json expected = directory.Read("exr.compare.json")["images"][0],
               image = directory.Read("png.compare.json")["images"][0];
    EXPECT_TRUE(image["figures"]["rmse"].is_null() && image["blocks"][0]["relMse"].is_null());
    for (const char* figure : {"rmseLightness", "psnr", "ssim", "flip", "visibleDifference"})
        EXPECT_EQ(image["figures"][figure], expected["figures"][figure]) << figure;
}

TEST(Compare, RendersNoFurtherThanItMustBesideAReference) {
    const HumanDirectory directory;
    RunLull(directory, "render" + kScene + "--spp 160 -o r.exr");
    ExpectSuccess(directory,
                  "compare" + kScene +
                      "--stop fixed:60 --human human.csv:b --reference r.exr --cap 160 -o room");
    const Json json = directory.Read("room.compare.json");
    EXPECT_EQ(json["images"][0]["cost"]["samples"], 100 * 90 * 60);
    EXPECT_EQ(json["images"][0]["saved"]["estimated"], true);
    EXPECT_EQ(json["againstHuman"]["later"], 9);
    EXPECT_FALSE(directory.Has("room.reference.exr"));
}

TEST(Compare, GoesOnAfterAnInterruption) {
    const HumanDirectory directory;
    const std::string command = "compare" + kScene +
                                "--snapshots --curves --stop dammertz:0.01 --human human.csv:a "
                                "--cap 400 ";
    ExpectSuccess(directory, command + "-o whole");
    int kills = 0;
    for (; kills < 100; ++kills) {
        const std::string limit =
            kills < 2 ? "timeout -s KILL 0." + std::to_string(3 + 2 * kills) + " " : "";
        const Outcome outcome = RunShell(
            directory, limit + "LULL " + command +
                           "-o parts --checkpoint c.h5 --checkpoint-interval 0.1 --resume");
        if (outcome.exitCode == 0) break;
        ASSERT_EQ(outcome.exitCode, 137) << outcome.err;
    }
    for (const char* image : {"automatic", "human", "reference"})
        EXPECT_EQ(directory.Bytes(std::string("parts.") + image + ".png"),
                  directory.Bytes(std::string("whole.") + image + ".png"));
    EXPECT_EQ(directory.Read("parts.compare.json")["images"][1]["figures"],
              directory.Read("whole.compare.json")["images"][1]["figures"]);
    EXPECT_FALSE(directory.Has("c.h5"));
}

TEST(Compare, SaysWhatIsMissingOrWrong) {
    const HumanDirectory directory;
    RunLull(directory, "render scene.pbrt --spp 1 --quiet -o small.exr");
    RunLull(directory, "render scene.pbrt --spp 1 --quiet -o crop.exr --crop 0,0.5,0,1");
    directory.Write("text.exr", "no image");
    directory.Write("large.tif",  // 8x2 grey pixels of 16 bits
                    FromHex("49492a0008000000070000010300010000000800000001010300010000000200000002"
                            "0103000100000010000000060103000100000001000000110104000100000062000000"
                            "1601030001000000020000001701040001000000200000000000000"
                            "0") +
                        std::string(32, '\x80'));
    const std::string scene = "compare" + kScene;
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
    ExpectFailure(directory, "compare --automatic large.tif --reference small.exr",
                  {"large.tif", "8 bits"});
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

TEST(Compare, HasCurvesOfErrorAgainstTime) {
    const HumanDirectory directory;
    const std::string command =
        "compare scene.pbrt --resolution 48x44 --block 44 --quiet --cap 100 --curves "
        "--stop dammertz:0.03 ";
    ExpectSuccess(directory, command + "--snapshots --denoise -o room --report room.html");
    const Json curves = directory.Read("room.compare.json")["errorCurves"];
    EXPECT_EQ(curves["sharesReference"], true);
    std::map<std::string, Json> points;
    for (const Json& point : curves["points"])
        points[point["rule"].get<std::string>() + ":" + point["setting"].get<std::string>()] =
            point;
    // The rules of the two images, fixed sample counts, and 5 rules at 8 settings.
    EXPECT_EQ(curves["points"].size(), 2u + 4u + 40u);
    for (const char* name : {"fixed:60", "lnoise:0.5", "entropy:0.5", "dammertz:0.03"})
        EXPECT_TRUE(points.contains(name)) << name;
    EXPECT_EQ(points["fixed:20"]["spp"], 20);
    EXPECT_GT(points["fixed:20"]["rmseLightness"], points["fixed:60"]["rmseLightness"]);
    EXPECT_GT(points["denoised:3.1"]["ruleSeconds"], 0);
    EXPECT_HAS(directory.Bytes("room.html"), "errorCurves");

    // Beside a reference from a file, the errors are the same.
    ExpectSuccess(directory, command + "--reference room.reference.exr -o other");
    const Json other = directory.Read("other.compare.json")["errorCurves"];
    EXPECT_EQ(other["sharesReference"], false);
    EXPECT_EQ(other["points"][1]["flip"], points["fixed:20"]["flip"]);
}

TEST(RenderReport, IsAPageWhereItsNameSaysSo) {
    const HumanDirectory directory;
    ExpectSuccess(directory,
                  "render" + kScene + "--stop lnoise:2 --cap 200 -o i.exr --report r.html");
    EXPECT_TRUE(directory.Bytes("r.html").starts_with("<!DOCTYPE html>"));
    RunLull(directory, "render" + kScene + "--stop lnoise:2 --cap 200 -o j.exr --report r.json");
    EXPECT_EQ(directory.Bytes("i.thresholds.csv"), directory.Bytes("j.thresholds.csv"));
    EXPECT_EQ(directory.Bytes("i.png"), directory.Bytes("j.png"));
}

}  // namespace
}  // namespace lull::compare_test
