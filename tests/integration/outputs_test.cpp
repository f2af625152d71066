// Results replace neither each other nor what they are made from, and none is lost where one cannot
// be written.

#include "renderer/image/image_io.h"
#include "tests/integration/run_and_signal.h"

namespace lull::outputs_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOptions = "scene.pbrt --spp 20 --block 8 --quiet";

// A scene with a mesh and a texture, an image, thresholds and answers of people.
struct Inputs : TemporaryDirectory {
    Inputs() {
        Write("mesh.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        Write("scene.pbrt", SceneText("Texture \"t\" \"color\" \"imagemap\" \"string filename\" "
                                      "\"texture.png\"\n"
                                      "Material \"matte\" \"texture Kd\" \"t\"\n"
                                      "Shape \"plymesh\" \"string filename\" \"mesh.ply\""));
        WritePng(File("texture.png"), std::vector<Rgb>(4, Rgb(0.5f, 0.5f, 0.5f)), 2, 2);
        WritePng(File("environment.png"), std::vector<Rgb>(2, Rgb(1, 1, 1)), 2, 1);
        Write("human.csv", "scene;20;40;60;80;100;120\n");
        fs::create_symlink("human.csv", File("link.csv"));
    }
};

// Returns all files by name, with what is in them.
std::map<std::string, std::string> FilesIn(const TemporaryDirectory& directory) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(directory.path))
        files[entry.path().filename()] = ReadBytes(entry.path());
    return files;
}

// Expects exit code 1, one error that says which two files are the same, and no change.
void ExpectRefused(const TemporaryDirectory& directory, const std::string& arguments,
                   const std::string& output, const std::string& other) {
    const auto before = FilesIn(directory);
    const Outcome outcome = RunLull(directory, arguments);
    EXPECT_EQ(outcome.exitCode, 1) << arguments << "\n" << outcome.err;
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << arguments << "\n" << outcome.err;
    for (const std::string& part : {output + " \"", "would replace " + other + " \""})
        EXPECT_HAS(outcome.err, part) << arguments;
    EXPECT_EQ(FilesIn(directory), before) << arguments;
}

TEST(Outputs, OfRendersAreDifferentFiles) {
    const Inputs directory;
    const std::string render = fmt::format("render {} ", kOptions);
    ExpectRefused(directory, render + "--checkpoint out.exr -o out.exr", "--checkpoint", "-o");
    ExpectRefused(directory, render + "--checkpoint out.png -o out.exr", "--checkpoint", "-o");
    ExpectRefused(directory, render + "-o o.exr --report r.json --checkpoint r.json",
                  "--checkpoint", "--report");
}

TEST(Outputs, OfRendersAreNoInputs) {
    const Inputs directory;
    const std::string render = fmt::format("render {} ", kOptions);
    ExpectRefused(directory, render + "-o environment.exr --environment environment.png", "-o",
                  "--environment");
    for (const char* file : {"mesh.ply", "texture.png"})
        ExpectRefused(directory, render + "-o o.exr --checkpoint " + file, "--checkpoint",
                      "a file of the scene");
    ExpectRefused(directory, render + "-o texture.exr", "-o", "a file of the scene");
    ExpectRefused(directory, render + "-o o.exr --checkpoint scene.pbrt", "--checkpoint",
                  "the scene");
    ExpectRefused(directory,
                  "render scene.pbrt -o o.exr --checkpoint human.csv --stop "
                  "thresholds:link.csv:scene --block 8",
                  "--checkpoint", "the file of the rule,");
}

TEST(Outputs, OfOtherCommandsAreNoInputs) {
    const Inputs directory;
    directory.Write("d.h5", "no recording");
    directory.Write("p.csv", "scene;20;40;60;80;100;120\n");
    directory.Write("a.exr", "no image");
    const struct {
        const char *arguments, *output, *other;
    } kCases[] = {
        {"train d.h5 --human human.csv -o d.h5", "-o", "DATASET.h5"},
        {"train d.h5 --human human.csv -o m.h5 --csv link.csv", "--csv", "--human"},
        {"train d.h5 --human human.csv -o m.h5 --csv m.h5.checkpoint", "--csv", "the checkpoint"},
        {"evaluate --human human.csv --predicted p.csv --csv human.csv", "--csv", "--human"},
        {"evaluate --human human.csv --predicted p.csv --csv link.csv", "--csv", "--human"},
        {"evaluate --human human.csv --predicted p.csv --csv p.csv", "--csv", "--predicted"},
        {"record scene.pbrt --name a -o mesh.ply --blocks 0", "-o", "a file of the scene"},
        {"denoise a.exr -o a.exr", "-o", "IN"},
        {"compare --automatic a.exr --reference r.html -o c --report r.html", "--report",
         "--reference"},
        {"compare scene.pbrt --snapshots --cap 40 --block 8 --checkpoint c.reference.exr -o c "
         "--quiet",
         "--checkpoint", "-o"},
        {"study scene.pbrt -o s.html --record mesh.ply --cap 100", "--record",
         "a file of the scene"},
        {"study --collect p.csv -o p.csv", "-o", "--collect"},
    };
    for (const auto& [arguments, output, other] : kCases)
        ExpectRefused(directory, arguments, output, other);
}

// What an interrupted render leaves is of one render.
TEST(Outputs, InterruptedRendersLeaveNoOlderThresholds) {
    const Inputs directory;
    const std::string render =
        "LULL render scene.pbrt --resolution 100x90 --block 40 --quiet -o out.exr ";
    ExpectSuccess(RunShell(directory, render + "--cap 40"));
    const std::string thresholds = directory.File("out.thresholds.csv");
    ASSERT_TRUE(fs::exists(thresholds));

    const Outcome outcome = RunAndSignal(
        directory, render + "--stop dammertz:0.00001 --checkpoint c.h5 --checkpoint-interval 0.1",
        SIGTERM, "c.h5");
    EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
    EXPECT_FALSE(fs::exists(thresholds));
    EXPECT_EQ(outcome.out, "out.exr\nout.png\nout.spp.png\n");
}

// In a closed white room paths end at --max-depth alone.
TEST(Outputs, LongRendersAreToldOfDenoising) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText("Material \"matte\" \"rgb Kd\" [1 1 1] Shape "
                                            "\"sphere\" \"float radius\" [9]"));
    const Outcome outcome =
        RunShell(directory,
                 "timeout -s INT 7 LULL render scene.pbrt --resolution 400x400 --max-depth 1000 "
                 "--threads 1 -o out.exr");
    EXPECT_HAS(outcome.err, " left; with --denoise, blocks stop once ");
}

// However early it comes, it is whole, and shows all of the picture.
TEST(Outputs, PreviewsAreOfTheWholePicture) {
    const Inputs directory;
    for (const std::string denoise : {"", "--denoise "}) {
        const Outcome outcome = RunAndSignal(
            directory,
            "LULL render scene.pbrt --resolution 600x400 --threads 1 --quiet -o out.exr " +
                denoise + "--cap 1000000 --stop fixed:1000000 --preview 0.1",
            SIGKILL, "out.exr out.png");
        EXPECT_EQ(outcome.exitCode, 137) << outcome.err;
        const ExrImage image = ReadExr(directory.File("out.exr"));
        EXPECT_HAS(std::get<std::string>(image.attributes.at("note")), "interrupted");
        EXPECT_EQ(ReadImage(directory.File("out.png")).width, image.width);
        bool isDenoised = false;
        for (const ExrChannel& channel : image.channels) {
            isDenoised |= channel.name == "noisy.R";
            if (channel.name != "R") continue;
            EXPECT_GT(std::ranges::min(channel.values), 0);
        }
        EXPECT_EQ(isDenoised, !denoise.empty());
    }
}

// /dev/full is a disk that is always full.
TEST(Outputs, FilesThatCannotBeWrittenGoElsewhere) {
    const Inputs directory;
    ExpectSuccess(directory, fmt::format("render {} -o whole.exr", kOptions));
    fs::create_symlink("/dev/full", directory.File("out.exr"));
    fs::create_directory(directory.File("other"));
    const Outcome outcome =
        RunShell(directory, fmt::format("TMPDIR=other LULL render {} -o out.exr", kOptions));
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_HAS(outcome.err, "cannot write \"out.exr\": No space left on device");

    const std::string place = outcome.out.substr(0, outcome.out.find('\n'));
    EXPECT_TRUE(place.starts_with("other/lull-") && place.ends_with("/out.exr")) << place;
    EXPECT_HAS(outcome.err, fs::path(place).parent_path().string());
    EXPECT_EQ(ReadImage(directory.File(place)).texels,
              ReadImage(directory.File("whole.exr")).texels);
    for (const char* extension : {".png", ".spp.png", ".thresholds.csv"})
        EXPECT_TRUE(directory.Has(std::string("out") + extension)) << extension;
}

// Neither the results of long renders of the laboratory nor former files are lost.
TEST(Outputs, FilesOfAllCommandsGoElsewhere) {
    const Inputs directory;
    ExpectSuccess(directory, fmt::format("render {} --denoise-layers -o in.exr", kOptions));
    const std::pair<const char*, const char*> kCases[] = {
        {"denoise in.exr -o", "full.exr"},
        {"study scene.pbrt --resolution 60x60 --max-depth 0 --cap 40 --quiet -o", "full.html"},
        {"compare scene.pbrt --snapshots --curves --cap 20 --quiet -o b --report", "full.html"}};
    for (const auto& [command, file] : kCases) {
        fs::remove(directory.File(file));
        fs::create_symlink("/dev/full", directory.File(file));
        const Outcome outcome =
            RunShell(directory, fmt::format("TMPDIR=. LULL {} {}", command, file));
        EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
        EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
        EXPECT_HAS(outcome.err, fmt::format("cannot write \"{}\": No space left on device", file));
        const size_t end = outcome.out.find(std::string("/") + file + "\n");
        ASSERT_NE(end, std::string::npos) << outcome.out;
        const size_t begin = outcome.out.rfind('\n', end) + 1;  // 0 where there is no other line
        EXPECT_TRUE(fs::exists(directory.File(outcome.out.substr(begin, end - begin)) + "/" + file))
            << outcome.out;
    }

    directory.Write("page.html", "former");
    const Outcome small = RunShell(
        directory, fmt::format("ulimit -f 4; TMPDIR=. LULL {} page.html", kCases[1].first));
    EXPECT_EQ(small.exitCode, 1) << small.err;
    EXPECT_EQ(CountErrorLines(small.err), 1) << small.err;
    EXPECT_HAS(small.err, "; lost: ");
    EXPECT_TRUE(small.err.ends_with("\"page.html\"\n")) << small.err;
    EXPECT_EQ(directory.Bytes("page.html"), "former");
}

}  // namespace
}  // namespace lull::outputs_test
