#include "renderer/input/scene_hash.h"

#include <gtest/gtest.h>

#include "renderer/input/pbrt_parser.h"
#include "tests/renderer/files/test_files.h"

namespace lull::scene_hash_test {
namespace {

constexpr const char* kScene = R"(
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "image" "string filename" ["a.exr"] "integer xresolution" [32]
WorldBegin
Texture "t" "spectrum" "imagemap" "string filename" ["t.png"]
Material "matte" "texture Kd" "t"
LightSource "point" "rgb I" [1 2 3]
AttributeBegin
Translate 1 0 0
Shape "sphere" "float radius" [2]
AttributeEnd
WorldEnd
)";

// Returns the hash of a scene in a folder of its own, beside a "texture".
std::string HashOf(const std::string& text, const std::string& texture = "pixels") {
    const TemporaryDirectory directory;
    directory.Write("t.png", texture);
    Warnings warnings;
    return SceneHash(ParsePbrt(directory.Write("scene.pbrt", text), warnings));
}

std::string Replaced(const std::string& from, const std::string& to) {
    std::string text = kScene;
    return text.replace(text.find(from), from.size(), to);
}

TEST(SceneHash, IsThatOfTheContent) {
    const std::string hash = HashOf(kScene);
    EXPECT_EQ(hash.size(), 14u);
    EXPECT_EQ(HashOf(kScene), hash);  // from another folder
    EXPECT_EQ(HashOf(Replaced("a.exr", "other.exr")), hash);
    EXPECT_EQ(HashOf(Replaced("AttributeBegin", "# nothing\nAttributeBegin")), hash);
}

TEST(SceneHash, ChangesWithEverythingThatIsSeen) {
    const std::string hash = HashOf(kScene);
    EXPECT_NE(HashOf(kScene, "pixel5"), hash);
    for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
             {"0 0 5", "0 0 6"},
             {"[40]", "[41]"},
             {"[32]", "[33]"},
             {"matte", "mirror"},
             {"\"texture Kd\" \"t\"", ""},
             {"[1 2 3]", "[1 2 4]"},
             {"point", "distant"},
             {"Translate 1", "Translate 2"},
             {"[2]", "[2.0000002]"},
             {"AttributeEnd", "AttributeEnd\nShape \"sphere\""}})
        EXPECT_NE(HashOf(Replaced(from, to)), hash) << from;
}

}  // namespace
}  // namespace lull::scene_hash_test
