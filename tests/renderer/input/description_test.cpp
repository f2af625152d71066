#include "renderer/input/description.h"

#include "tests/renderer/input/test_files.h"

namespace lull::description_test {
namespace {

Parameter Floats(ParameterType type, const std::string& name, std::vector<float> values) {
    return {type, name, {}, std::move(values)};
}

TEST(Parameters, FindsByNameAndType) {
    Parameters p;
    p.Add(Floats(ParameterType::Float, "a", {2}));
    p.Add({ParameterType::Integer, "a", {}, std::vector<int>{3}});
    p.Add({ParameterType::Bool, "b", {}, std::vector<int>{1}});
    p.Add({ParameterType::String, "s", {}, std::vector<std::string>{"text"}});
    p.Add(Floats(ParameterType::Point3, "p", {1, 2, 3}));
    p.Add(Floats(ParameterType::Vector3, "v", {4, 5, 6}));
    p.Add(Floats(ParameterType::Spectrum, "c", {7, 8, 9}));
    p.Add({ParameterType::Texture, "t", {}, std::vector<TextureRef>{{"wood", 1, -1}}});
    EXPECT_EQ(p.GetFloat("a", 0), 2);
    EXPECT_EQ(p.GetInt("a", 0), 3);
    EXPECT_TRUE(p.GetBool("b", false));
    EXPECT_EQ(p.GetString("s", ""), "text");
    EXPECT_EQ(p.GetPoint3("p", Vec3f::Zero()), Vec3f(1, 2, 3));
    EXPECT_EQ(p.GetVector3("v", Vec3f::Zero()), Vec3f(4, 5, 6));
    EXPECT_EQ(p.GetSpectrum("c", Rgb::Zero()).matrix(), Vec3f(7, 8, 9));
    ASSERT_TRUE(p.GetTexture("t"));
    EXPECT_EQ(p.GetTexture("t")->floatIndex, 1);
    // The same names as other types are not there.
    EXPECT_EQ(p.GetFloat("b", 9), 9);
    EXPECT_EQ(p.GetPoint3("v", Vec3f::Zero()), Vec3f::Zero());
    EXPECT_EQ(p.GetTexture("s"), nullptr);
    EXPECT_EQ(p.Find(ParameterType::Float, "none"), nullptr);
}

TEST(Parameters, SingleLookupNeedsExactlyOneValue) {
    Parameters p;
    p.Add(Floats(ParameterType::Float, "f", {1, 2}));
    p.Add(Floats(ParameterType::Spectrum, "c", {1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(p.GetFloat("f", 7), 7);
    EXPECT_EQ(p.GetSpectrum("c", Rgb::Constant(5)).x(), 5);
    EXPECT_EQ(p.GetFloats(ParameterType::Float, "f").size(), 2u);
    EXPECT_TRUE(p.GetFloats(ParameterType::Float, "g").empty());
    EXPECT_TRUE(p.GetInts("f").empty());
}

TEST(Parameters, LaterOneOfSameNameAndTypeCounts) {
    Parameters p;
    p.Add(Floats(ParameterType::Float, "f", {1}));
    p.Add(Floats(ParameterType::Float, "f", {2}));
    EXPECT_EQ(p.All().size(), 1u);
    EXPECT_EQ(p.GetFloat("f", 0), 2);
}

TEST(Parameters, ReportsWhatWasNotLookedUp) {
    Parameters p;
    p.Add(Floats(ParameterType::Float, "used", {1}));
    p.Add(Floats(ParameterType::Float, "unused", {1}));
    p.Add(Floats(ParameterType::Float, "twice", {1, 2}));
    p.GetFloat("used", 0);
    p.GetFloat("twice", 0);  // has two values, so this does not find it
    std::vector<std::string> messages;
    Warnings warnings([&](const std::string& message) { messages.push_back(message); });
    p.ReportUnused("shape \"sphere\"", warnings);
    EXPECT_EQ(warnings.Total(), 2);
    EXPECT_EQ(messages.at(0),
              "warning: unused parameter: 'unused' of shape \"sphere\" has no effect");
    EXPECT_EQ(p.Mistyped("twice"), "; it has 2 values and has to have 1");
}

TEST(Parameters, NameTheTypeThatIsWanted) {
    Parameters p;
    p.Add(Floats(ParameterType::Float, "Kd", {1}));
    p.GetTexture("Kd");
    p.GetSpectrum("Kd", Rgb::Zero());
    std::string message;
    Warnings warnings([&](const std::string& text) { message = text; });
    p.ReportUnused("material \"matte\"", warnings);
    EXPECT_EQ(message,
              "warning: unused parameter: 'Kd' of material \"matte\" has no effect; it is given as "
              "\"float\" and has to be \"rgb\"");
    EXPECT_EQ(p.Mistyped("Kd"), "; it is given as \"float\" and has to be \"rgb\"");
    EXPECT_EQ(p.Mistyped("Ks"), "");
    p.GetFloat("Kd", 0);
    EXPECT_EQ(p.Mistyped("Kd"), "");
}

TEST(ResolvePath, StartsAtTheScene) {
    Description description;
    EXPECT_EQ(ResolvePath(description, "a.ply"), "a.ply");
    description.directory = "scenes/room";
    EXPECT_EQ(ResolvePath(description, "geometry/a.ply"), "scenes/room/geometry/a.ply");
    EXPECT_EQ(ResolvePath(description, "/data/a.ply"), "/data/a.ply");
    EXPECT_EQ(ResolvePath(description, ""), "");
}

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
}  // namespace lull::description_test
