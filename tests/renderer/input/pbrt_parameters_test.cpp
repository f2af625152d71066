// Tests every form in which the pbrt-v3 parser reads parameters.
#include "renderer/input/pbrt_parser.h"
#include "tests/renderer/input/test_files.h"

namespace lull {
namespace {

class PbrtParameters : public testing::Test {
  protected:
    // Returns the parameters of a shape written with `text`.
    Parameters Read(const std::string& text) {
        return folder.ParseWorld("Shape \"sphere\" " + text, &warnings).shapes.at(0).parameters;
    }
    std::vector<float> Floats(const Parameters& p, ParameterType type, const std::string& name) {
        const auto values = p.GetFloats(type, name);
        return {values.begin(), values.end()};
    }

    TestFolder folder;
    Warnings warnings;
};

using V = std::vector<float>;

TEST_F(PbrtParameters, SingleValuesWithAndWithoutBrackets) {
    const auto p = Read(
        "\"float a\" 1.5 \"float b\" [ 2.5 ] \"integer i\" -3 \"string s\" \"x\" "
        "\"string t\" [\"y\"] \"bool u\" \"true\" \"bool v\" [\"false\"]");
    EXPECT_EQ(p.GetFloat("a", 0), 1.5f);
    EXPECT_EQ(p.GetFloat("b", 0), 2.5f);
    EXPECT_EQ(p.GetInt("i", 0), -3);
    EXPECT_EQ(p.GetString("s", ""), "x");
    EXPECT_EQ(p.GetString("t", ""), "y");
    EXPECT_TRUE(p.GetBool("u", false));
    EXPECT_FALSE(p.GetBool("v", true));
    EXPECT_EQ(p.All()[0].loc.line, 1);
}

TEST_F(PbrtParameters, TheLaterOneCounts) {
    const auto p =
        Read("\"float a\" 1 \"integer a\" 2 \"float a\" 3 \"rgb c\" [1 1 1] \"xyz c\" [0 0 0]");
    EXPECT_EQ(p.GetFloat("a", 0), 3);
    EXPECT_EQ(p.GetSpectrum("c", Rgb::Ones()).x(), 0);
    EXPECT_EQ(p.All().size(), 3u);
    EXPECT_EQ(warnings.Counts().at("parameter given again; the later one counts"), 2);
}

TEST_F(PbrtParameters, BareBooleans) {
    const auto p = Read("\"bool a\" true \"bool b\" [false] \"bool c\" [true \"false\"]");
    EXPECT_TRUE(p.GetBool("a", false));
    EXPECT_FALSE(p.GetBool("b", true));
    EXPECT_EQ(std::get<std::vector<int>>(p.Find(ParameterType::Bool, "c")->values),
              (std::vector{1, 0}));
}

TEST_F(PbrtParameters, ArraysOfEveryType) {
    const auto p = Read(
        "\"float f\" [1 2] \"integer i\" [3 4] \"string s\" [\"a\" \"b\"] \"point2 p2\" [1 2 3 4] "
        "\"vector2 v2\" [1 2] \"point p\" [1 2 3 4 5 6] \"point3 q\" [1 2 3] \"vector v\" [4 5 6] "
        "\"vector3 w\" [7 8 9] \"normal n\" [0 0 1] \"float none\" []");
    EXPECT_EQ(Floats(p, ParameterType::Float, "f"), (V{1, 2}));
    EXPECT_EQ(p.GetInts("i").size(), 2u);
    EXPECT_EQ(p.GetInts("i")[1], 4);
    EXPECT_EQ(std::get<std::vector<std::string>>(p.Find(ParameterType::String, "s")->values),
              (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(Floats(p, ParameterType::Point2, "p2"), (V{1, 2, 3, 4}));
    EXPECT_EQ(Floats(p, ParameterType::Vector2, "v2"), (V{1, 2}));
    EXPECT_EQ(Floats(p, ParameterType::Point3, "p"), (V{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(p.GetPoint3("q", Vec3f::Zero()), Vec3f(1, 2, 3));
    EXPECT_EQ(p.GetVector3("v", Vec3f::Zero()), Vec3f(4, 5, 6));
    EXPECT_EQ(p.GetVector3("w", Vec3f::Zero()), Vec3f(7, 8, 9));
    EXPECT_EQ(Floats(p, ParameterType::Normal, "n"), (V{0, 0, 1}));
    EXPECT_TRUE(p.Find(ParameterType::Float, "none"));
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(PbrtParameters, NumbersInEveryForm) {
    const auto p = Read("\"float f\" [+1 -2 .5 4. 1e2 -1.5E-2 +.25 007 1e-60 -0 16777217 3.4e38]");
    EXPECT_EQ(Floats(p, ParameterType::Float, "f"),
              (V{1, -2, .5f, 4, 100, -.015f, .25f, 7, 0, 0, 16777216, 3.4e38f}));
    const auto q = Read("\"integer i\" [+1 -2 3.0 4e2 2147483647 -2147483647 0]");
    const auto i = q.GetInts("i");
    EXPECT_EQ(std::vector<int>(i.begin(), i.end()),
              (std::vector{1, -2, 3, 400, 2147483647, -2147483647, 0}));
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(PbrtParameters, IntegerFractionsAreCutWithAWarning) {
    EXPECT_EQ(Read("\"integer i\" -1.75").GetInt("i", 0), -1);
    EXPECT_EQ(warnings.Counts().at("integer with a fraction, which is cut off"), 1);
}

TEST_F(PbrtParameters, CommentsAndBlanksAnywhere) {
    const auto p = Read("# one\r\n\t\" float\ta \" # two\n[1#three ] \" [\n2\r3]\"float b\"4#");
    EXPECT_EQ(Floats(p, ParameterType::Float, "a"), (V{1, 2, 3}));
    EXPECT_EQ(p.GetFloat("b", 0), 4);
}

TEST_F(PbrtParameters, StringsMayHoldEscapesAndUtf8) {
    EXPECT_EQ(Read("\"string s\" \"a\\\"b\\\\c\\n\\t\\'# [d]\"").GetString("s", ""),
              "a\"b\\c\n\t'# [d]");
    EXPECT_EQ(Read("\"string s\" \"\xc3\xa9t\xc3\xa9.png\"").GetString("s", ""),
              "\xc3\xa9t\xc3\xa9.png");
}

TEST_F(PbrtParameters, SpectraOfEveryFormAreRgb) {
    folder.Write("spds/flat.spd", "# flat\n400 1\n700, 1 # end");
    const auto p = Read(
        "\"rgb a\" [.1 .2 .3] \"color b\" [.4 .5 .6 .7 .8 .9] \"xyz c\" [.950456 1 1.088754] "
        "\"blackbody d\" [6500 2] \"spectrum e\" [300 1 800 1] \"spectrum f\" \"spds/flat.spd\" "
        "\"spectrum g\" [ # comment\n \"spds/flat.spd\" \"spds/flat.spd\"]");
    EXPECT_EQ(Floats(p, ParameterType::Spectrum, "a"), (V{.1f, .2f, .3f}));
    EXPECT_EQ(Floats(p, ParameterType::Spectrum, "b").size(), 6u);
    EXPECT_TRUE(p.GetSpectrum("c", Rgb::Zero()).isApprox(Rgb::Ones(), 1e-4f));
    EXPECT_TRUE(p.GetSpectrum("d", Rgb::Zero())
                    .isApprox(2 * Rgb(.92221901f, .86949617f, .91521711f), 1e-5f));
    const Rgb flat(1.2023297f, .94621524f, .90733963f);
    EXPECT_TRUE(p.GetSpectrum("e", Rgb::Zero()).isApprox(flat, 1e-5f));
    EXPECT_TRUE(p.GetSpectrum("f", Rgb::Zero()).isApprox(flat, 1e-5f));
    EXPECT_EQ(Floats(p, ParameterType::Spectrum, "g").size(), 6u);
}

}  // namespace
}  // namespace lull
