#include "renderer/input/spectrum.h"

#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"
#include "tests/shared_folder.h"

namespace lull {
namespace {

// Tests against numbers that pbrt-v3's formulas give in single precision (its own) and in double:
// each channel agrees to 1e-5.
void ExpectNear(const Rgb& found, double r, double g, double b) {
    EXPECT_NEAR(found.x(), r, 1e-5 * std::abs(r));
    EXPECT_NEAR(found.y(), g, 1e-5 * std::abs(g));
    EXPECT_NEAR(found.z(), b, 1e-5 * std::abs(b));
}

TEST(Spectrum, CieTableIsWhole) {
    // The maximum of y is 1 at 555 nm, and its sum is the integral that pbrt-v3 divides by.
    EXPECT_EQ(kCieY[555 - kCieFirst], 1.f);
    double x = 0, y = 0, z = 0;
    for (size_t i = 0; i < kCieY.size(); ++i) {
        x += kCieX[i];
        y += kCieY[i];
        z += kCieZ[i];
    }
    EXPECT_NEAR(y, 106.856895, 1e-4);
    EXPECT_NEAR(x, 106.866, 1e-2);  // equal-energy white has x = y = z = 1/3
    EXPECT_NEAR(z, 106.892, 1e-2);
}

TEST(Spectrum, Xyz) {
    ExpectNear(RgbFromXyz(1, 0, 0), 3.240479, -.969256, .055648);
    ExpectNear(RgbFromXyz(0, 1, 0), -1.53715, 1.875991, -.204043);
    ExpectNear(RgbFromXyz(0, 0, 1), -.498535, .041556, 1.057311);
}

TEST(Spectrum, Samples) {
    const std::vector<float> one = {500, 1};
    ExpectNear(RgbFromSamples(one), 1.2023317, .94621348, .90734005);
    const std::vector<float> four = {400, .2f, 500, .9f, 600, .4f, 700, .1f};
    ExpectNear(RgbFromSamples(four), .28167704, .68869615, .50800484);
    const std::vector<float> shuffled = {600, .4f, 400, .2f, 700, .1f, 500, .9f};
    EXPECT_TRUE((RgbFromSamples(shuffled) == RgbFromSamples(four)).all());
}

TEST(Spectrum, Blackbody) {
    ExpectNear(RgbFromBlackbody(2700), .53349411, .22157076, .052901801);
    ExpectNear(RgbFromBlackbody(6500), .92221779, .86949658, .91521716);
    ExpectNear(RgbFromBlackbody(12000), .23775887, .28607926, .45084539);
    // Blue is the small rest of a difference here, which single precision knows to 1e-5 only.
    ExpectNear(RgbFromBlackbody(1000), 4.1257102e-05, 3.5520107e-07, -8.0760118e-07);
    EXPECT_TRUE(IsFinite(RgbFromBlackbody(1e-30)));
    EXPECT_TRUE(IsFinite(RgbFromBlackbody(1e30)));
}

TEST(Spectrum, Copper) {
    ExpectNear(CopperEta(), .19999069, .92208463, 1.0998759);
    ExpectNear(CopperK(), 3.9046354, 2.4476333, 2.1376526);
}

TEST(Spectrum, FilesOfMetals) {
    LULL_SHARED_FILE(scenes, "pbrt-scenes");
    const auto load = [&](const char* name) { return LoadSpectrum((scenes / name).string()); };
    ExpectNear(load("bathroom/spds/Ag.eta.spd"), .15493518, .11647548, .13808739);
    ExpectNear(load("bathroom/spds/Ag.k.spd"), 4.8181009, 3.1156166, 2.1424017);
    ExpectNear(load("matpreview/spds/Au.eta.spd"), .14282006, .37414363, 1.4394444);
    ExpectNear(load("matpreview/spds/Au.k.spd"), 3.9747183, 2.3806598, 1.5998104);
}

// The same spectrum, as editors and old systems write it.
TEST(Spectrum, FilesOfAnyTextEditor) {
    const TemporaryDirectory directory;
    const auto load = [&](const std::string& text) {
        return LoadSpectrum(directory.Write("a.spd", text));
    };
    const Rgb rgb = load("# made by hand\n400 .2\n500 .9\n700 .1\n");
    for (const char* text :
         {"\xef\xbb\xbf"
          "400 .2\n500 .9\n700 .1\n",
          "400 .2\n500 .9\n700 .1\n\x1a", "# made by hand\r400 .2\r500 .9\r700 .1\r",
          "400, .2\r\n500, .9\r\n700, .1\r\n"})
        EXPECT_TRUE((load(text) == rgb).all()) << text;
    EXPECT_TRUE((load(std::string("400 .2\n500 .9\n700 .1\n\0\0", 23)) == rgb).all());
    std::string wide = "\xff\xfe";
    for (const char c : std::string("400 .2\n")) wide += std::string{c, '\0'};
    EXPECT_EQ(ErrorOf([&] { load(wide); }),
              directory.File("a.spd") + ": the text is UTF-16; save it as UTF-8");
    EXPECT_EQ(ErrorOf([&] { load("400 .2\r500 x\r"); }),
              directory.File("a.spd") + ":2: 'x' in a spectrum file is not a number");
}

// Tables of refractive indices have micrometres.
TEST(Spectrum, WavelengthsThatNobodySeesAreWarnedOf) {
    Warnings warnings;
    const auto read = [&](const std::vector<float>& pairs) {
        return RgbFromSamples(pairs, {}, &warnings);
    };
    read({300, .2f, 900, .4f});
    read({0, .5f});
    EXPECT_EQ(warnings.Total(), 0);
    EXPECT_TRUE(read({.4f, .2f, .8f, .4f}).isApprox(read({0, .4f})));
    EXPECT_EQ(warnings.Total(), 1);
}

// Values jump where two wavelengths were rounded to the same one, as they do in pbrt-v3.
TEST(Spectrum, WavelengthsMayBeRoundedToTheSame) {
    const std::vector<float> same = {400, .2f, 500, .9f, 500, .9f, 700, .1f},
                             once = {400, .2f, 500, .9f, 700, .1f},
                             jump = {400, 1, 550, 1, 550, 0, 700, 0},
                             steep = {400, 1, 549.999f, 1, 550.001f, 0, 700, 0};
    EXPECT_TRUE((RgbFromSamples(same) == RgbFromSamples(once)).all());
    EXPECT_TRUE(RgbFromSamples(jump).isApprox(RgbFromSamples(steep), 0.02f));
}

}  // namespace
}  // namespace lull
