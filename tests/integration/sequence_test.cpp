// Renders sequences: the frames of an animation in one run.
#include <array>
#include <span>

#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"

namespace lull::sequence_test {
namespace {

// A triangle that moves by 1 to the right in a second, seen by a camera.
struct SequenceDirectory : TemporaryDirectory {
    SequenceDirectory() {
        constexpr std::array<float, 17> values = {0, 0, 0, 1, 0, 0, 0, 1, 0,  // positions
                                                  0, 1,                       // seconds
                                                  0, 0, 0, 1, 0, 0};          // translations
        const auto bytes = std::as_bytes(std::span(values));
        Write("moving.bin", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        Write("moving.gltf", R"({
"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
"nodes": [{"mesh": 0}, {"camera": 0, "translation": [0.5, 0.5, 4]}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"buffers": [{"uri": "moving.bin", "byteLength": 68}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
               "min": [0, 0, 0], "max": [1, 1, 0]},
              {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR",
               "min": [0], "max": [1]},
              {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
"animations": [{"samplers": [{"input": 1, "output": 2}],
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]})");
    }

    bool Same(const std::string& a, const std::string& b) const {
        return ReadImage(File(a)).texels == ReadImage(File(b)).texels;
    }
};

const std::string kRender = "render moving.gltf --resolution 40x30 --spp 4 --quiet ";

TEST(Sequence, IsItsFrames) {
    const SequenceDirectory directory;
    ExpectSuccess(directory,
                  kRender + "--frames 0:0.75:4fps --shutter 0.1 -o a.exr --report a.json");
    for (int frame = 0; frame < 3; ++frame) {
        ExpectSuccess(directory, fmt::format("{}--frame {} --shutter 0.1 --seed {} -o one.exr",
                                             kRender, 0.25 * frame, frame + 1));
        EXPECT_TRUE(directory.Same(fmt::format("a.{:04}.exr", frame + 1), "one.exr")) << frame;
        EXPECT_TRUE(directory.Has(fmt::format("a.{:04}.json", frame + 1)));
    }
    EXPECT_FALSE(directory.Same("a.0001.exr", "a.0003.exr"));
    EXPECT_FALSE(directory.Has("a.0004.exr"));
}

TEST(Sequence, HasASeedForEachFrame) {
    const SequenceDirectory directory;
    const std::string command = kRender + "--shutter 0 --frames ";
    // All three show the end of the animation, and differ by their grain alone.
    ExpectSuccess(directory, command + "2:5:1 -o own.exr --seed 5");
    ExpectSuccess(directory, command + "2:5:1 -o same.exr --seed 7 --same-seed");
    EXPECT_FALSE(directory.Same("own.0001.exr", "own.0002.exr"));
    EXPECT_TRUE(directory.Same("own.0002.exr", "same.0001.exr"));
    EXPECT_TRUE(directory.Same("same.0001.exr", "same.0003.exr"));
    EXPECT_EQ(RunLull(directory, kRender + "--frame 0 --same-seed").exitCode, 2);
}

TEST(Sequence, GoesOnWithTheFramesThatAreLeft) {
    const SequenceDirectory directory;
    const std::string command = kRender + "--frames 0:0.5:4 --checkpoint c.h5 --resume";
    ExpectSuccess(directory, command);
    EXPECT_FALSE(directory.Has("c.0001.h5"));
    const auto first = std::filesystem::last_write_time(directory.File("moving.0001.exr"));
    std::filesystem::remove(directory.File("moving.0002.exr"));
    const Outcome again = ExpectSuccess(directory, command);
    EXPECT_EQ(std::filesystem::last_write_time(directory.File("moving.0001.exr")), first);
    EXPECT_TRUE(again.out.starts_with("moving.0002.exr\n")) << again.out;
}

// A frame is done when all of its files are there, whole, by the same settings.
TEST(Sequence, KnowsFramesThatAreNotDone) {
    const SequenceDirectory directory;
    const std::string command =
        kRender + "--frames 0:0.5:4 --checkpoint c.h5 --resume --report r.json ";
    ExpectSuccess(directory, command + "-o a.exr");
    EXPECT_EQ(ExpectSuccess(directory, command + "-o a.exr").out, "");
    for (const char* file :
         {"a.0001.png", "a.0001.spp.png", "a.0001.thresholds.csv", "r.0001.json", "a.0001.exr"}) {
        const std::string whole = directory.Bytes(file);
        for (const size_t left : {whole.size(), whole.size() * 9 / 10}) {
            if (left == whole.size())
                std::filesystem::remove(directory.File(file));
            else
                directory.Write(file, std::string_view(whole).substr(0, left));
            EXPECT_TRUE(
                ExpectSuccess(directory, command + "-o a.exr").out.starts_with("a.0001.exr\n"))
                << file << ": " << left << " bytes";
        }
        EXPECT_EQ(ExpectSuccess(directory, command + "-o a.exr").out, "") << file;
    }
    EXPECT_NO_THROW(ReadExr(directory.File("a.0001.exr")));
    ExpectFailure(directory, command + "-o a.exr --seed 7",
                  {"a.0001.exr", "other settings", "seed=1 there", "seed=8 here"});
    ExpectFailure(directory, command + "-o a.exr --aov depth", {"a.0001.exr", "aov"});
}

TEST(Sequence, IsRefusedWhereItCannotBe) {
    const SequenceDirectory directory;
    for (const char* frames : {"0:1", "1:0:24", "0:1:0", "0:1:24mm", "0:1e9:24", "nan:1:1",
                               "0:1:2 --frame 0", "0:1:2 --until 09:00"})
        EXPECT_EQ(RunLull(directory, kRender + "--frames " + frames).exitCode, 2) << frames;
    EXPECT_EQ(RunLull(directory, kRender + "--shutter 0.1").exitCode, 2);
    directory.Write("scene.pbrt", SceneText(kSphere));
    EXPECT_EQ(RunLull(directory, "render scene.pbrt --frames 0:1:2").exitCode, 1);
}

}  // namespace
}  // namespace lull::sequence_test
