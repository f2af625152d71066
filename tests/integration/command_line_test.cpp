// Runs the program as its help describes it.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"

namespace lull {
namespace {

TEST(CommandLine, RefusesWrongUsage) {
    const SceneDirectory directory;
    const auto refuses = [&](const std::string& arguments) {
        const Outcome outcome = RunLull(directory, arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.err;
        EXPECT_NE(outcome.err, "") << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
    };
    for (const char* arguments :
         {"paint", "render", "info", "record scene.pbrt --name a -o a.h5 --blocks 0,,5"})
        refuses(arguments);
    struct Option {
        const char* name;
        std::vector<const char*> values;
    };
    const Option options[] = {
        {"", {"extra", "--frobnicate", "--light-groups=each,", "--aov-through-specular"}},
        {"--resolution", {"-3x4", "3", "3x4x5", "0x10x8"}},
        {"--crop", {"0.5,0.2,0,1", "0,1", "0,nan,0,1", "3,2,0,1px", "0,0.5,0,1px"}},
        {"--pixel", {"24,0", "1"}},
        {"--sample", {"1"}},
        {"--threads", {"-1", "many"}},
        {"--seed", {"-1", "1.5", "18446744073709551616", "0x10"}},
        {"--spp", {"0x10", "010", "' 5'", "\"1'000\"", "99999999999999999999", "0"}},
        {"--spp 4", {"--graded-by 2", "--stop fixed:5"}},
        {"--caution", {"0x1p2", "nan"}},
        {"--exposure", {"nan", "inf"}},
        {"--environment a.exr", {"--environment-rotation nan"}},
        {"--frame", {"nan", "0 --shutter nan"}},
        {"--checkpoint c.h5", {"--checkpoint-interval nan"}},
        {"--cap", {"nan", "0", "3 --denoise-layers"}},
        {"--max-spp", {"0"}},
        {"--stop", {"fixed:nan", "noise:nan"}},
        {"--quality", {"best", "final --caution 2"}},
        {"-o", {"image.jpg", "image"}},
        {"--aov", {"albedo,colour", "albedo,,noise"}},
        {"", {"--preview nan", "--orbit nan,0", "--time nan", "--pass 0", "--block 0"}},
        {"", {"--sampler halton", "--estimator best", "--max-depth -1", "--display nowhere"}},
        {"", {"--tone-map aces", "--ocio a --tone-map filmic", "--graded-by nan"}},
        {"", {"--view-exposure 101"}},
    };
    for (const Option& option : options)
        for (const std::string value : option.values)
            refuses("render scene.pbrt " + std::string(option.name) + " " + value);
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(CommandLine, ReadsNumbersInDecimalNotation) {
    const SceneDirectory directory;
    const std::string render = "render scene.pbrt --quiet -o a.exr --spp ";
    for (const char* good : {"+2", "2 --exposure +.5", "2 --exposure -1e-1", "2 --seed +7"})
        ExpectSuccess(directory, render + good);
    EXPECT_HAS(RunLull(directory, render + "0x2").err, "'0x2' is not a whole number");
    EXPECT_HAS(RunLull(directory, render + "0").err, "'0' is not in the range from 1 to 16777216");
}

TEST(CommandLine, SuggestsOptions) {
    const SceneDirectory directory;
    const auto errorOf = [&](const std::string& arguments) {
        return RunLull(directory, "render scene.pbrt " + arguments).err;
    };
    EXPECT_EQ(errorOf("--denoize"),
              "lull: error: there is no option --denoize; did you mean --denoise?\n");
    EXPECT_EQ(
        errorOf("--guide on"),
        "lull: error: there is no option --guide any more; use --denoise, or --integrator bdpt for "
        "light through glass\n");
    EXPECT_EQ(errorOf("--ssp=3"), "lull: error: there is no option --ssp; did you mean --spp?\n");
    EXPECT_HAS(errorOf("--samples 4"), "did you mean --spp?");
    EXPECT_HAS(errorOf("--res=8x8"), "did you mean --resolution?");
    EXPECT_HAS(errorOf("--quantum"), "; lull render --help lists");
    EXPECT_TRUE(errorOf("--spp none").starts_with("lull: error: "));
    EXPECT_HAS(errorOf("--filtering=pbrt-v3"), "no option --filtering any more; images");
}

TEST(CommandLine, NamesImagesAfterTheScene) {
    const TemporaryDirectory directory;
    const auto render = [&](const std::string& folder, const std::string& film) {
        std::filesystem::create_directory(directory.File(folder));
        directory.Write(folder + "/scene.pbrt", SceneText(kSphere, film));
        return RunLull(directory, "render " + folder + "/scene.pbrt --spp 1 --quiet").out;
    };
    EXPECT_TRUE(render("attic", "").starts_with("attic.exr\n"));
    EXPECT_TRUE(render("barn", "\"string filename\" \"scene.exr\"").starts_with("barn.exr\n"));
    EXPECT_EQ(render("cellar", "\"string filename\" \"picture.tga\""),
              "picture.exr\npicture.png\npicture.spp.png\npicture.thresholds.csv\n");
}

TEST(CommandLine, HelpsAndTellsItsVersion) {
    const TemporaryDirectory directory;
    for (const char* arguments : {"--help", "render --help", "info --help", "--version"}) {
        const Outcome outcome = ExpectSuccess(directory, arguments);
        EXPECT_HAS(outcome.out, "lull") << arguments;
        EXPECT_EQ(outcome.err, "") << arguments;
    }
    for (const auto& [as, arguments] :
         {std::pair("--help", ""), {"--help", "help"}, {"render --help", "help render"}})
        EXPECT_EQ(ExpectSuccess(directory, arguments).out, ExpectSuccess(directory, as).out);
}

// A first render needs a page of help; every option has a subject.
TEST(CommandLine, HelpHasTheCommonOptionsFirst) {
    const TemporaryDirectory directory;
    const std::string brief = ExpectSuccess(directory, "render --help").out;
    const std::string all = ExpectSuccess(directory, "render --help-all").out;
    for (const char* option : {"--denoise ", "-o,--output", "--spp", "--resume", "--caution"})
        EXPECT_TRUE(Contains(brief, option) && Contains(all, option)) << option;
    for (const char* option : {"--png-bits", "--checkpoint-interval", "--orbit"})
        EXPECT_TRUE(!Contains(brief, option) && Contains(all, option)) << option;
    EXPECT_HAS(brief, "lull render --help-all lists all options.");
    for (const char* group :
         {"\nScene:\n  -", "\nImage:\n  -", "\nSampling:\n  -", "\nStopping:\n  -",
          "\nDenoising:\n  -", "\nOutput:\n  -", "\nInterruption:\n  -", "\nAdvanced:\n  -"})
        EXPECT_HAS(all, group) << group;
    EXPECT_FALSE(Contains(all, "\nOptions:\n"));
    // The options of one command alone come first.
    EXPECT_HAS(ExpectSuccess(directory, "compare --help").out, "--snapshots");
    EXPECT_EQ(RunLull(directory, "train --help").out, RunLull(directory, "train --help-all").out);
}

// Choices are named once, with the default.
TEST(CommandLine, HelpNamesChoices) {
    const TemporaryDirectory directory;
    for (const auto& [command, option] : {std::pair("render", "--png-bits 8|16=8 "),
                                          {"evaluate", "--choose-by error|critical=error"}}) {
        EXPECT_HAS(RunLull(directory, std::string(command) + " --help-all").out, option);
    }
    const Outcome wrong = RunLull(directory, "render scene.pbrt --png-bits 12");
    EXPECT_EQ(wrong.exitCode, 2);
    EXPECT_HAS(wrong.err, "12 not in {8,16}");
}

TEST(CommandLine, WritesAllFilesAndNamesThemOnStdout) {
    const SceneDirectory directory;
    for (const char* output : {"image.exr", "image.png"}) {
        const Outcome outcome = ExpectSuccess(
            directory, std::string("render scene.pbrt --spp 4 --report r.json -o ") + output);
        EXPECT_EQ(outcome.out,
                  "image.exr\nimage.png\nimage.spp.png\nimage.thresholds.csv\nr.json\n");
    }
    EXPECT_EQ(directory.CountFiles(), 6);
    EXPECT_TRUE(directory.Bytes("image.thresholds.csv").ends_with(";4;\n"));
    const Image png = ReadImage(directory.File("image.png"));
    EXPECT_EQ(png.width, 24);
    EXPECT_EQ(png.height, 16);
}

TEST(CommandLine, StopsAsPeopleWouldIfNothingElseIsAskedFor) {
    const SceneDirectory directory;
    ExpectSuccess(directory,
                  "render scene.pbrt --resolution 48x48 --cap 100 --report r.json -o image.exr");
    const nlohmann::json report = nlohmann::json::parse(directory.Bytes("r.json"));
    EXPECT_EQ(report["provenance"]["criterion"], "learned");
    EXPECT_NE(report["provenance"]["modelChecksum"], "");
}

TEST(CommandLine, CropsByPixels) {
    const SceneDirectory directory;
    ExpectSuccess(directory, "render scene.pbrt --spp 1 --quiet --crop 6,18,1,900px -o image.exr");
    const ExrImage exr = ReadExr(directory.File("image.exr"));
    EXPECT_EQ(exr.origin, Vec2i(6, 1));
    EXPECT_EQ(exr.width, 12);
    EXPECT_EQ(exr.height, 15);  // of 16 rows; what is beyond is not there
    ExpectFailure(directory, "render scene.pbrt --crop 24,30,0,9px -o out.exr",
                  {"lull: error: the crop window holds no pixel of 24x16"});
}

TEST(CommandLine, PrintsThePathOfASample) {
    const SceneDirectory directory;
    const std::string command = "render scene.pbrt --pixel 12,8 --sample 3 --seed 5";
    const Outcome outcome = ExpectSuccess(directory, command);
    for (const char* part : {"Sample 3 of pixel 12,8", "camera at 0 0 -3", "on \"sphere, ",
                             "\nRadiance ", "leaves the scene"})
        EXPECT_HAS(outcome.out, part);
    EXPECT_EQ(RunLull(directory, command).out, outcome.out);
    EXPECT_NE(RunLull(directory, command + "0").out, outcome.out);
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(CommandLine, WritesWhatTheImageWasMadeFrom) {
    const SceneDirectory directory;
    ExpectSuccess(directory,
                  "render scene.pbrt --spp 6 --seed 18446744073709551615 --crop 0.25,0.75,0,0.5 "
                  "--estimator pbrt-v3 -o image.exr");
    const ExrImage exr = ReadExr(directory.File("image.exr"));
    EXPECT_EQ(exr.width, 12);
    EXPECT_EQ(exr.height, 8);
    EXPECT_EQ(exr.origin, Vec2i(6, 0));
    EXPECT_EQ(exr.displaySize, Vec2i(24, 16));
    auto text = [&](const char* name) { return std::get<std::string>(exr.attributes.at(name)); };
    EXPECT_EQ(text("renderer"), "lull");
    EXPECT_EQ(text("seed"), "18446744073709551615");
    EXPECT_EQ(text("sampler"), "random");
    EXPECT_EQ(text("estimator"), "pbrt-v3");
    EXPECT_EQ(text("criterion"), "fixed:6");
    EXPECT_EQ(text("samples"), std::to_string(12 * 8 * 6));
    EXPECT_EQ(text("rejectedSamples"), "0");
    for (const char* name : {"rendererVersion", "seconds", "worldToCamera", "worldToNDC"})
        EXPECT_TRUE(exr.attributes.contains(name)) << name;
    ASSERT_TRUE(exr.Find("spp"));
    EXPECT_EQ(exr.Find("spp")->values, std::vector<float>(12 * 8, 6));
}

TEST(CommandLine, StopsBlocksAsARuleSays) {
    const SceneDirectory directory;
    directory.Write("rows.csv", "scene;20;60;\n");
    ExpectSuccess(directory,
                  "render scene.pbrt --resolution 100x50 --block 50 -o image.exr "
                  "--stop thresholds:rows.csv:scene");
    EXPECT_TRUE(directory.Bytes("image.thresholds.csv").ends_with(";20;60;\n"));
    const ExrImage exr = ReadExr(directory.File("image.exr"));
    EXPECT_EQ(exr.Find("spp")->values.front(), 20);
    EXPECT_EQ(exr.Find("spp")->values.back(), 60);
}

// Whoever gives less time than a sample for each pixel takes hears of it long before the end.
TEST(CommandLine, WarnsOfFirstSamplesThatTakeLongerThanTheClock) {
    const SceneDirectory directory;
    const std::string render = "LULL render scene.pbrt --quiet ";
    const std::string part = "warning: the first sample of every pixel";
    const Outcome late = RunShell(directory, "timeout -s TERM 100 " + render +
                                                 "--resolution 3000x2000 --spp 20 --threads 1 "
                                                 "--time 1ms");
    EXPECT_HAS(late.err, part);
    EXPECT_EQ(late.err.find(part), late.err.rfind(part)) << late.err;
    const Outcome inTime = ExpectSuccess(RunShell(directory, render + "--spp 20 --time 100s"));
    EXPECT_FALSE(Contains(inTime.err, part)) << inTime.err;
}

// The cap of 10,000 is for rules that may never stop.
TEST(CommandLine, TakesAsManySamplesAsAskedFor) {
    const SceneDirectory directory;
    const std::string one = "render scene.pbrt --resolution 1x1 --quiet -o i.exr ";
    RunLull(directory, one + "--spp 10001");
    EXPECT_EQ(ReadExr(directory.File("i.exr")).Find("spp")->values[0], 10001);
    RunLull(directory, one + "--spp 30 --cap 25");
    EXPECT_EQ(ReadExr(directory.File("i.exr")).Find("spp")->values[0], 25);
    RunLull(directory, one + "--max-spp 3");  // less than a pass
    EXPECT_EQ(ReadExr(directory.File("i.exr")).Find("spp")->values[0], 3);
    ExpectFailure(directory, "render scene.pbrt --pass 7 -o out.exr", {"pass of 7 spp"});
    RunLull(directory, one + "--cap 45");  // too small to be judged
    EXPECT_EQ(ReadExr(directory.File("i.exr")).Find("spp")->values[0], 45);
}

// Qualities are names of a caution, with the same stops.
TEST(CommandLine, NamesQualities) {
    const SceneDirectory directory;
    const auto thresholds = [&](const std::string& options) {
        ExpectSuccess(directory,
                      "render scene.pbrt --resolution 100x90 --block 45 --stop lnoise:0.4 "
                      "--max-spp 600 --quiet -o i.exr " +
                          options);
        return directory.Bytes("i.thresholds.csv");
    };
    const std::string draft = thresholds("--quality draft"), good = thresholds("--quality good");
    const std::string final = thresholds("--quality final");
    EXPECT_EQ(draft, thresholds("--caution 0.5"));
    EXPECT_EQ(good, thresholds(""));
    EXPECT_EQ(final, thresholds("--caution 2"));
    EXPECT_NE(draft, good);
    EXPECT_NE(final, good);
}

// Returns the objects on stderr, of which each line is one.
std::vector<nlohmann::json> EventsOf(const Outcome& outcome) {
    std::vector<nlohmann::json> events;
    std::istringstream lines(outcome.err);
    for (std::string line; std::getline(lines, line);)
        events.push_back(nlohmann::json::parse(line, nullptr, false));
    for (const auto& event : events) EXPECT_TRUE(event.is_object()) << outcome.err;
    return events;
}

int Count(const std::vector<nlohmann::json>& events, const std::string& event) {
    return int(std::ranges::count_if(events, [&](const auto& e) { return e["event"] == event; }));
}

TEST(CommandLine, PrintsNothingButJson) {
    const SceneDirectory directory;
    const Outcome outcome = ExpectSuccess(
        directory,
        "render scene.pbrt --resolution 100x100 --block 50 --stop lnoise:0.5 --cap 100 "
        "-o i.exr --json-progress --max-depth 3 --denoise-layers");
    const std::vector<nlohmann::json> events = EventsOf(outcome);
    EXPECT_EQ(Count(events, "stop"), 4) << outcome.err;
    EXPECT_EQ(Count(events, "file"), 4) << outcome.err;
    EXPECT_EQ(Count(events, "end"), 1);
    EXPECT_EQ(events.back()["event"], "end");
    EXPECT_EQ(events.back()["end"], "done");
    std::vector<double> percents;
    for (const auto& event : events)
        if (event["event"] == "progress") percents.push_back(event["percent"]);
    EXPECT_TRUE(std::ranges::is_sorted(percents));
    EXPECT_EQ(percents.back(), 100);
    EXPECT_EQ(std::ranges::adjacent_find(events), events.end()) << outcome.err;

    EXPECT_GE(Count(EventsOf(RunLull(directory,
                                     "compare scene.pbrt --snapshots -o c --resolution 20x20 "
                                     "--block 20 --cap 60 --json-progress")),
                    "progress"),
              1);

    directory.Write("old.pbrt", SceneText("Shape \"sphere\" \"float radios\" [1]"));
    const std::vector<nlohmann::json> warned =
        EventsOf(RunLull(directory, "render old.pbrt --spp 2 --quiet -o i.exr --json-progress"));
    EXPECT_GE(Count(warned, "warning"), 1);
    const Outcome missing = RunLull(directory,
                                    "render scene.pbrt --spp 2 --json-progress "
                                    "--checkpoint no/c.h5 -o i.exr");
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_EQ(Count(EventsOf(missing), "error"), 1) << missing.err;
}

// All four go to the cap, which is not the same as to stop.
TEST(CommandLine, TellsStoppedFromCapped) {
    const SceneDirectory directory;
    const std::string render = "render scene.pbrt --resolution 100x100 --block 50 --report r.json ";
    const Outcome capped =
        ExpectSuccess(directory, render + "--stop lnoise:0.01 --cap 100 -o i.exr");
    for (const char* part : {"0 of 4 blocks clean, 4 at the cap and not clean", "threshold 0.01;",
                             "estimated sufficient --max-spp: "})
        EXPECT_HAS(capped.err, part);
    EXPECT_FALSE(Contains(capped.err, "less time")) << capped.err;
    const nlohmann::json report = nlohmann::json::parse(directory.Bytes("r.json"));
    EXPECT_EQ(report["totals"]["blocksAtCap"], 4);
    EXPECT_GT(report["totals"]["neededCap"], 100);
    EXPECT_GT(report["blocks"][0]["neededSpp"], 100);
    const auto attribute = [&](const char* name) {
        return std::get<std::string>(ReadExr(directory.File("i.exr")).attributes.at(name));
    };
    EXPECT_EQ(attribute("cleanBlocks"), "0");
    EXPECT_EQ(attribute("blocksAtCap"), "4");
    EXPECT_HAS(attribute("note"), "4 of 4 blocks went to the cap");

    // A fixed number of samples is no cap that anybody ran into.
    const Outcome fixed = RunLull(directory, render + "--spp 20 -o i.exr");
    EXPECT_HAS(fixed.err, "4 of 4 blocks done");
    EXPECT_FALSE(Contains(fixed.err, "cap")) << fixed.err;
    EXPECT_FALSE(ReadExr(directory.File("i.exr")).attributes.contains("note"));
}

TEST(CommandLine, HelpsWithWrongUsage) {
    const SceneDirectory directory;
    const auto refuses = [&](const std::string& arguments, const std::string& part) {
        const Outcome outcome = RunLull(directory, arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments << outcome.err;
        EXPECT_HAS(outcome.err, part) << arguments;
    };
    refuses("rendr scene.pbrt", "there is no command 'rendr'; did you mean 'render'?");
    refuses("scene.pbrt", "type lull render scene.pbrt");
    refuses("frobnicate", "there are render, ");
    refuses("render scene.pbrt --aov colour", "no layer \"colour\"");
    refuses("bench scene.pbrt", "no command 'bench' any more; use lull compare --curves");
    refuses("train data.h5 --votes 2", "no option --votes any more; three consecutive");
    refuses("render scene.pbrt --stop lnoize", "--stop: ");
    refuses("render scene.pbrt --stop lnoise:x", "'x'");
    refuses("render scene.pbrt --report a.txt", "a.txt ends neither in .html nor in .json");
    ExpectSuccess(directory, "--help");
    refuses("render scene.pbrt --stop denoised", "needs --denoise");
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(CommandLine, TellsWhatIsInAScene) {
    const SceneDirectory directory;
    const Outcome outcome = ExpectSuccess(directory, "info scene.pbrt");
    for (const char* part : {"sphere", "matte", "infinite", "24 x 16",
                             "sobol-halves (random in the file)", "perspective"})
        EXPECT_HAS(outcome.out, part);
    EXPECT_EQ(directory.CountFiles(), 1);
}

}  // namespace
}  // namespace lull
