// Tests that everything wrong with a pbrt-v3 file is told with its place and its reason.
#include <sys/stat.h>

#include "renderer/input/pbrt_parser.h"
#include "tests/renderer/input/test_files.h"

namespace lull {
namespace {

class PbrtErrors : public testing::Test {
  protected:
    void Expect(const std::string& text, const std::string& message) {
        const std::string found = folder.ErrorOf(text);
        EXPECT_TRUE(found.starts_with(message))
            << "in    " << text << "\nfound " << found << "\nnot   " << message;
    }
    // Puts `text` on the second line, inside the world.
    void ExpectInWorld(const std::string& text, const std::string& message) {
        Expect("WorldBegin\n" + text + "\nWorldEnd", "scene.pbrt:2: " + message);
    }
    // Gives a shape these parameters.
    void InShape(const std::string& parameters, const std::string& message) {
        ExpectInWorld("Shape \"sphere\" " + parameters, message);
    }

    TestFolder folder;
};

TEST_F(PbrtErrors, Structure) {
    Expect("", "scene.pbrt:1: the file ends without WorldBegin");
    Expect("# nothing\n\n", "scene.pbrt:3: the file ends without WorldBegin");
    Expect("Film \"image\" WorldBegin\n",
           "scene.pbrt:2: the file ends without WorldEnd for the WorldBegin of line 1");
    Expect("WorldBegin WorldEnd\nWorldBegin", "scene.pbrt:2: 'WorldBegin' after WorldEnd");
    Expect("\nShape \"sphere\"", "scene.pbrt:2: 'Shape' must come after WorldBegin");
    EXPECT_EQ(folder.ErrorOf("\nworldbegin\nShape \"sphere\""),
              "scene.pbrt:2: unknown directive 'worldbegin'");
    ExpectInWorld("Camera \"perspective\"", "'Camera' must come before WorldBegin");
    ExpectInWorld("WorldBegin", "'WorldBegin' must come before WorldBegin");
    ExpectInWorld("Sphere", "unknown directive 'Sphere'");
    ExpectInWorld("\"Shape\"", "expected a directive, but there is \"Shape\"");
    ExpectInWorld("Shape \"sphere\" ]", "expected a directive, but there is ']'");
    ExpectInWorld("Translate 1 2 3 4", "unknown directive '4'");
}

TEST_F(PbrtErrors, Scopes) {
    ExpectInWorld("AttributeEnd", "AttributeEnd without AttributeBegin");
    ExpectInWorld("TransformEnd", "TransformEnd without TransformBegin");
    ExpectInWorld("ObjectEnd", "ObjectEnd without ObjectBegin");
    ExpectInWorld("AttributeBegin TransformBegin AttributeEnd",
                  "AttributeEnd where the TransformBegin of line 2 is still open");
    ExpectInWorld("TransformBegin AttributeBegin TransformEnd",
                  "TransformEnd where the AttributeBegin of line 2 is still open");
    ExpectInWorld("ObjectBegin \"o\" TransformBegin ObjectEnd",
                  "ObjectEnd where the TransformBegin of line 2 is still open");
    ExpectInWorld("AttributeBegin ObjectEnd", "ObjectEnd without ObjectBegin");
    Expect("WorldBegin\nObjectBegin \"o\" AttributeEnd\nWorldEnd",
           "scene.pbrt:3: WorldEnd where the ObjectBegin of line 2 is still open");
    Expect("WorldBegin\nAttributeBegin\nWorldEnd",
           "scene.pbrt:3: WorldEnd where the AttributeBegin of line 2 is still open");
}

TEST_F(PbrtErrors, Names) {
    ExpectInWorld("Shape sphere", "expected a name in quotes, but there is 'sphere'");
    ExpectInWorld("NamedMaterial \"x\"",
                  "NamedMaterial \"x\": no MakeNamedMaterial in force defines it");
    ExpectInWorld(
        "AttributeBegin MakeNamedMaterial \"x\" \"string type\" \"matte\" AttributeEnd "
        "NamedMaterial \"x\"",
        "NamedMaterial \"x\"");
    ExpectInWorld("MakeNamedMaterial \"x\"", "MakeNamedMaterial \"x\" has no \"string type\"");
    ExpectInWorld("ObjectInstance \"x\"", "ObjectInstance of \"x\", which no ObjectBegin");
    ExpectInWorld("ObjectBegin \"x\" ObjectInstance \"x\"",
                  "ObjectInstance inside an object definition");
    ExpectInWorld("ObjectBegin \"x\" ObjectBegin \"y\"", "ObjectBegin inside the object of line 2");
    ExpectInWorld("CoordSysTransform \"x\"", "coordinate system \"x\" is unknown");
    ExpectInWorld("Texture \"t\" \"rgb\" \"constant\"", "texture kind \"rgb\" is unknown");
    ExpectInWorld("ActiveTransform Never", "ActiveTransform takes All, StartTime or EndTime");
}

TEST_F(PbrtErrors, Parameters) {
    InShape("\"radius\" 1", "\"radius\" declares no parameter");
    InShape("\"\" 1", "\"\" declares no parameter");
    InShape("\"float a b\" 1", "\"float a b\" declares no parameter");
    InShape("\"double radius\" 1", "unknown parameter type 'double' in \"double radius\"");
    InShape("\"float a\" \"1\"", "parameter \"float a\" expects numbers, but there is \"1\"");
    InShape("\"float a\" [1 \"2\"]", "parameter \"float a\" expects numbers, but there is \"2\"");
    InShape("\"float a\" [1 [2]]", "parameter \"float a\" expects numbers, but there is '['");
    InShape("\"float a\" Shape", "parameter \"float a\" expects numbers, but there is 'Shape'");
    InShape("\"integer a\" true", "parameter \"integer a\" expects integers, but there is 'true'");
    InShape("\"string a\" 1", "parameter \"string a\" expects quoted strings, but there is '1'");
    InShape("\"string a\" [\"x\" 1]", "parameter \"string a\" expects quoted strings");
    InShape("\"bool a\" \"yes\"", "parameter \"bool a\" expects true or false");
    InShape("\"bool a\" 1", "parameter \"bool a\" expects true or false, but there is '1'");
    InShape("\"point P\" [1 2 3 4]", "parameter \"point P\" has 4 numbers, no multiple of 3");
    InShape("\"point2 P\" [1]", "parameter \"point2 P\" has 1 numbers, no multiple of 2");
    InShape("\"rgb c\" [1 2]", "parameter \"rgb c\" has 2 numbers, no multiple of 3");
    InShape("\"rgb c\" 1", "parameter \"rgb c\" has 1 numbers");
    InShape("\"blackbody c\" [5000]", "parameter \"blackbody c\" has 1 numbers");
    InShape("\"spectrum c\" [400 1 500]", "parameter \"spectrum c\" has 3 numbers");
    InShape("\"texture t\" [\"a\" \"b\"]", "parameter \"texture t\" must name one texture");
    InShape("\"texture t\" []", "parameter \"texture t\" must name one texture");
}

TEST_F(PbrtErrors, EndOfFileInAList) {
    Expect("WorldBegin\nShape \"sphere\" \"float a\" [1\n2",
           "scene.pbrt:3: parameter \"float a\" expects numbers, but there is the end of the file");
    Expect("Film", "scene.pbrt:1: expected a name in quotes, but there is the end of the file");
    Expect("Translate 1\n2", "scene.pbrt:2: expected a number, but there is the end of the file");
}

TEST_F(PbrtErrors, Numbers) {
    for (const std::string bad :
         {"1.2.3", "1x", "--1", "+-1", "0x10", "1e", "-", ".", "1,2", "1e+"})
        ExpectInWorld("Translate 0 0 " + bad, "'" + bad + "' is not a number");
    for (const std::string bad : {"nan", "inf", "NaN", "infinity"})
        ExpectInWorld("Translate 0 0 " + bad, "expected a number, but there is '" + bad + "'");
    for (const std::string bad : {"-inf", "-nan", "+inf", "1e999", "-1e999"})
        ExpectInWorld("Translate 0 0 " + bad, "'" + bad + "' is not a number that can be used");
    InShape("\"float a\" 1e39", "'1e39' is not a number that can be used");
    InShape("\"float a\" nan", "parameter \"float a\" expects numbers, but there is 'nan'");
    InShape("\"integer i\" 2147483648", "'2147483648' is beyond the range of an integer");
    InShape("\"integer i\" [1 99999999999999999999]",
            "'99999999999999999999' is beyond the range of an integer");
    InShape("\"integer i\" 12ab", "'12ab' is not a number");
    // As Microsoft's printf has them, of which # begins a comment.
    for (const std::string number : {"1.#INF", "-1.#IND", "1.#QNAN0", "1.#INF000"})
        for (const std::string type : {"float", "integer"})
            InShape("\"" + type + " radius\" [ " + number + " ]",
                    "'" + number.substr(0, number.find('0')) + "' is not a finite number");
    Expect("WorldBegin\nShape \"sphere\" \"float radius\" 2#INF\nShape 3", "scene.pbrt:3: ");
}

TEST_F(PbrtErrors, Strings) {
    ExpectInWorld("Shape \"sphere", "the string that begins with \"sphere\" has no closing quote");
    Expect("Film \"image", "scene.pbrt:1: the string that begins with \"image\"");
    ExpectInWorld("Shape \"a\\q\"", "unknown escape '\\q' in a string");
    ExpectInWorld("Shape \"a\\", "the string that begins with");
    ExpectInWorld("Shape \"" + std::string(5000, 'a') + "\"", "a string is longer than 4096");
}

TEST_F(PbrtErrors, BinaryFiles) {
    Expect(std::string("\x1f\x8b\x08\x00\x01", 5), "the gzip'd data are damaged or cut short");
    Expect(std::string("\0\0\0", 3), "'scene.pbrt' is not a pbrt scene file: it is a binary file");
    const std::string scene = "WorldBegin\nWorldEnd\n";
    for (const bool bigEndian : {false, true})
        for (const char* mark : {"", bigEndian ? "\xfe\xff" : "\xff\xfe"}) {
            std::string wide = mark;
            for (const char c : scene)
                wide += bigEndian ? std::string{'\0', c} : std::string{c, '\0'};
            Expect(wide,
                   "'scene.pbrt' is not a pbrt scene file: it is UTF-16 text; save it as UTF-8");
        }
    // What editors and old programs put around text.
    for (const std::string& text : {"\xef\xbb\xbf" + scene, scene + "\x1a", scene + '\0',
                                    scene + std::string("\0\0\n", 3), scene + "\x1a\r\n"})
        EXPECT_EQ(folder.ErrorOf(text), "");
    Expect("WorldBegin\r\rShape \"sphere\" nonsense\rWorldEnd\r", "scene.pbrt:3: ");
    Expect("a\x01", "scene.pbrt:1: control character in 'a\\x01'");
    Expect("\xff\xfe\xfd", "scene.pbrt:1: unknown directive '\\xff\\xfe\\xfd'");
    // A long word is cut in the message.
    EXPECT_LT(folder.ErrorOf(std::string(100000, 'x')).size(), 300u);
}

TEST_F(PbrtErrors, Transforms) {
    ExpectInWorld("Scale 1 0 1", "Scale by 0 makes the transform singular");
    ExpectInWorld("Rotate 30 0 0 0", "Rotate about an axis of length 0");
    ExpectInWorld("LookAt 1 2 3 1 2 3 0 1 0", "LookAt: the eye and the point looked at");
    ExpectInWorld("LookAt 0 0 0 0 0 5 0 0 1", "LookAt: the up vector is 0 or points along");
    ExpectInWorld("LookAt 0 0 0 0 0 5 0 0 0", "LookAt: the up vector is 0 or points along");
    ExpectInWorld("Transform [1 0 0 0 0 1 0 0 1 1 0 0 0 0 0 1]", "the matrix is singular");
    ExpectInWorld("ConcatTransform [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1]", "the matrix is singular");
    // Of rank 2, though rounding hides that: (1 2 3) (4 5 6) (7 8 9), times 0.1.
    ExpectInWorld("Transform [.1 .2 .3 0 .4 .5 .6 0 .7 .8 .9 0 0 0 0 1]", "the matrix is singular");
    ExpectInWorld("Transform [1 0 0 .5 0 1 0 0 0 0 1 0 0 0 0 1]", "the matrix is a projection");
    ExpectInWorld("Transform 1 0 0 0", "expected 16 numbers in brackets, but there is '1'");
    ExpectInWorld("Transform [1 0 0 0]", "expected a number, but there is ']'");
    ExpectInWorld("Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1]",
                  "expected ']' after 16 numbers, but there is '1'");
    ExpectInWorld("Scale 1e30 1 1 Scale 1e30 1 1",
                  "the transform is singular or beyond the range of numbers from here on");
    ExpectInWorld("Scale 1e-30 1 1 Scale 1e-30 1 1", "the transform is singular or beyond");
    ExpectInWorld("Translate 1e300 0 0", "the transform is singular or beyond");
}

TEST_F(PbrtErrors, Spectra) {
    InShape("\"spectrum c\" []", "a spectrum needs pairs of wavelength and value");
    InShape("\"spectrum c\" \"none.spd\"", "cannot read 'none.spd': No such file");
    InShape("\"blackbody c\" [0 1]", "a black body needs a temperature above 0 K");
    InShape("\"blackbody c\" [-5 1]", "a black body needs a temperature above 0 K");
    InShape("\"xyz c\" [3e38 -3e38 0]", "the values of \"xyz c\" are too large");
    InShape("\"spectrum c\" [400 3e38 401 3e38]", "the values of a spectrum are too large");
    folder.Write("bad.spd", "400 1\n\n500 x\n");
    Expect("Film \"f\" \"spectrum c\" \"bad.spd\"",
           "bad.spd:3: 'x' in a spectrum file is not a number");
    folder.Write("comma.spd", "# 1,2 3\n400, 1\n500,1\n\n600 ,1\n700,0 1,5\n");
    Expect(
        "Film \"f\" \"spectrum c\" \"comma.spd\"",
        "comma.spd:6: numbers of a line are apart by commas and by blanks; write decimal points");
    folder.Write("odd.spd", "400 1\n500\n");
    Expect("Film \"f\" \"spectrum c\" \"odd.spd\"", "odd.spd: a spectrum needs pairs");
}

TEST_F(PbrtErrors, Refusals) {
    const std::string path = "Integrator \"volpath\" WorldBegin\n";
    Expect(path + "MakeNamedMedium \"m\" \"string kind\" \"homogeneous\"",
           "scene.pbrt:2: MakeNamedMedium \"m\" has no \"string type\"");
    Expect(path + "MediumInterface \"a\" \"b\" Shape \"sphere\"",
           "scene.pbrt:2: medium \"a\" of MediumInterface: no MakeNamedMedium before defines it");
    Expect("MediumInterface \"\" \"fog\"\nIntegrator \"bdpt\" WorldBegin\nWorldEnd",
           "scene.pbrt:3: medium \"fog\" of MediumInterface");
}

TEST_F(PbrtErrors, Files) {
    Warnings warnings;
    const auto parse = [&](const std::string& name) {
        return folder.MessageOf([&] { ParsePbrt(folder.File(name), warnings); });
    };
    EXPECT_EQ(parse("none.pbrt"), "cannot read 'none.pbrt': No such file or directory");
    std::filesystem::create_directory(folder.File("room"));
    EXPECT_EQ(parse("room"), "cannot read 'room': it is a directory; name a file in it");
    ASSERT_EQ(mkfifo(folder.File("pipe").c_str(), 0600), 0);
    EXPECT_EQ(parse("pipe"), "cannot read 'pipe': it is not a regular file");
    folder.Write("a.OBJ", "v 0 0 0\n");
    EXPECT_HAS(parse("a.OBJ"), "it is a Wavefront OBJ mesh; export the scene as glTF");
    ExpectInWorld("Include \"none.pbrt\"", "cannot read 'none.pbrt': No such file or directory");
    ExpectInWorld("Include \"room\"", "cannot read 'room': it is a directory");
}

// Where there is such a file alone, also if the backslash was read as an escape.
TEST_F(PbrtErrors, BackslashesSeparateFolders) {
    std::filesystem::create_directory(folder.File("new"));
    folder.Write("new/tile.pbrt", "");
    const auto named = [&](const std::string& name) {
        return folder.ErrorOf("WorldBegin Include \"" + name + "\" WorldEnd");
    };
    EXPECT_EQ(named("new\\\\tile.pbrt"), "");
    EXPECT_EQ(named("new\\tile.pbrt"), "");
    EXPECT_HAS(named("\\new\\tile.pbrt"), "cannot read '\\new\\tile.pbrt'");
}

TEST_F(PbrtErrors, RecursiveInclude) {
    ExpectInWorld("Include \"scene.pbrt\"", "'scene.pbrt' includes itself");
    folder.Write("a.pbrt", "\n\nInclude \"b.pbrt\"");
    folder.Write("b.pbrt", "Include \"./a.pbrt\"");
    Expect("Include \"a.pbrt\"", "b.pbrt:1: './a.pbrt' includes itself");
}

TEST_F(PbrtErrors, IncludesThatMultiply) {
    // Each of 40 files includes the next one twice.
    const auto name = [](int i) { return std::to_string(i).append(".pbrt"); };
    for (int i = 0; i < 40; ++i) {
        const std::string next = "Include \"" + name(i + 1) + "\"\n";
        folder.Write(name(i), next + next);
    }
    folder.Write(name(40), "# end");
    EXPECT_HAS(folder.ErrorOf("Include \"0.pbrt\""),
               "files included again and again come to more than 1 GiB of text");
}

TEST_F(PbrtErrors, AmplificationIsBounded) {
    std::string many = "Shape \"sphere\"";
    for (int i = 0; i < 1001; ++i) many += " \"float p" + std::to_string(i) + "\" 1";
    ExpectInWorld(many, "a directive has more than 1000 parameters");
    std::string values;
    for (int i = 0; i < 2000; ++i) values += " 1";
    ExpectInWorld("AreaLightSource \"diffuse\" \"float x\" [" + values + "]",
                  "AreaLightSource has more than 1000 values");
}

}  // namespace
}  // namespace lull
