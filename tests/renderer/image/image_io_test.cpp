#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/image/image_io.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

// The files below are written out byte by byte, so that nothing but the reader is tested.
constexpr const char* kGreyPng =  // 2x2: 0 64 / 128 255
    "89504e470d0a1a0a0000000d494844520000000200000002080000000057dd52f80000000e4944415478da636070"
    "6068f80f00030501c0535b159f0000000049454e44ae426082";
constexpr const char* kBilevelPng =  // 2x1, 1 bit: black, white
    "89504e470d0a1a0a0000000d4948445200000002000000010100000000dc5942270000000a4944415478da637000"
    "000042004184bf8e620000000049454e44ae426082";
constexpr const char* kRgbPng =  // 2x2: 10 20 30, 40 50 60 / 70 80 90, 100 110 255
    "89504e470d0a1a0a0000000d4948445200000002000000020802000000fdd49a73000000164944415478da63e012"
    "91d330b261700b884ac9fb0f000f9f0394069395e30000000049454e44ae426082";
constexpr const char* kRgbaPng =  // 2x1: 200 100 50 0, 10 20 30 128
    "89504e470d0a1a0a0000000d4948445200000002000000010806000000f4227f8a000000114944415478da633891"
    "62c4c02522d700000b51021b23ebbbf20000000049454e44ae426082";
constexpr const char* kPalettePng =  // 2x1: 40 50 60, 10 20 30
    "89504e470d0a1a0a0000000d4948445200000002000000010803000000c3fc8fb800000006504c54450a141e2832"
    "3cd51bb4e90000000b4944415478da63606400000005000242c2449f0000000049454e44ae426082";
constexpr const char* kRgb16Png =  // 2x1: 0 65535 32768, 1 257 1000
    "89504e470d0a1a0a0000000d49484452000000020000000110020000002bd0349e000000154944415478da636060"
    "f8ffbf818181919191f9050017f4036df9b8f7a40000000049454e44ae426082";
constexpr const char*
    kInterlacedPng =  // 3x2, grey and alpha, 16 bits, gamma 1: 1000 x + 7 y, 65535 - x - y
    "89504e470d0a1a0a0000000d494844520000000300000002100400000110ea42440000000467414d41000186a031"
    "e8965f000000274944415478da011c00e3ff000000ffff0007d0fffd0003e8fffe000007fffe03effffd07d7fffc"
    "bf280f854a63612d0000000049454e44ae426082";
constexpr const char* kTransparentPng =  // 5x1, indices 0 1 2 3 0 of 2 bits; index 1 is transparent
    "89504e470d0a1a0a0000000d49484452000000050000000102030000006b908c600000000c504c54450a141e2832"
    "3c46505a646e78c64877df0000000274524e53ff00e5b7304a0000000b4944415478da63906600000039001cfd48"
    "606b0000000049454e44ae426082";
constexpr const char* kHugePng =  // claims to be 60000x60000, holds 10 bytes
    "89504e470d0a1a0a0000000d494844520000ea600000ea6008020000000fb0e2150000000b49444154789c636080"
    "0100000a00017f80745e0000000049454e44ae426082";

// 3x2: 204 102 51 with alpha 0, 128, 255 / 255, 0, 1; lossless, and lossy with alpha beside it.
constexpr const char* kLosslessWebP =
    "5249464626000000574542505650384c190000002f024000101f3066c33c33028282e55d8f8701f0099c88fe4700";
constexpr const char* kLossyWebP =
    "524946466400000057454250565038580a00000010000000020000010000414c504807000000000080ffff000100"
    "56503820360000005002009d012a0300020000000025a00274ba01f801fa01fc0009d000fedf803ffcb0fc7f5279"
    "ffcb10fffb527ebcc1caffed32000000";

template <typename T>
const std::vector<T>& Texels(const Image& image) {
    return std::get<std::vector<T>>(image.texels);
}

void ExpectNear(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

Image ReadFromBytes(const std::string& name, std::string_view bytes) {
    const TemporaryDirectory directory;
    return ReadImage(directory.Write(name, bytes));
}

// Palettes are undone, and alpha is left unassociated.
TEST(ReadImage, ReadsEightBitPng) {
    struct Case {
        const char* hex;
        int width, channels;
        std::vector<uint8_t> texels;
    };
    for (const Case& c :
         {Case{kGreyPng, 2, 1, {0, 64, 128, 255}}, Case{kBilevelPng, 2, 1, {0, 255}},
          Case{kRgbPng, 2, 3, {10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 255}},
          Case{kPalettePng, 2, 3, {40, 50, 60, 10, 20, 30}},
          Case{kRgbaPng, 2, 4, {200, 100, 50, 0, 10, 20, 30, 128}},
          Case{kTransparentPng, 5, 4, {10, 20,  30,  255, 40,  50,  60, 0,  70, 80,
                                       90, 255, 100, 110, 120, 255, 10, 20, 30, 255}}}) {
        const Image image = ReadFromBytes("a.png", FromHex(c.hex));
        EXPECT_EQ(image.width, c.width);
        EXPECT_EQ(image.height, int(c.texels.size()) / (c.width * c.channels));
        EXPECT_EQ(image.channels, c.channels);
        EXPECT_EQ(Texels<uint8_t>(image), c.texels);
        EXPECT_EQ(image.Bytes(), c.texels.size());
    }
}

TEST(ReadImage, UndoesInterlacing) {
    // The gamma that the file names changes nothing.
    const Image interlaced = ReadFromBytes("a.png", FromHex(kInterlacedPng));
    EXPECT_EQ(interlaced.width, 3);
    EXPECT_EQ(interlaced.channels, 2);
    std::vector<float> expected;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x)
            for (const int v : {1000 * x + 7 * y, 65535 - x - y})
                expected.push_back(float(v) / 65535);
    ExpectNear(Texels<float>(interlaced), expected, 1e-7f);
}

// The format is that of the bytes, whatever the name.
TEST(ReadImage, KnowsFormatsByTheirBytes) {
    EXPECT_EQ(ReadFromBytes("grey.jpg", FromHex(kGreyPng)).channels, 1);
    EXPECT_EQ(ReadFromBytes("grey", FromHex(kGreyPng)).channels, 1);
    const std::string png = FromHex(kGreyPng), pfm = "PF\n1 1\n-1.0\n" + std::string(12, '\0');
    EXPECT_EQ(ReadImage("inside", "jpg", std::as_bytes(std::span(png))).channels, 1);
    EXPECT_EQ(ReadFromBytes("really.png", pfm).channels, 3);
}

TEST(ReadImage, TurnsSixteenBitsIntoFloat) {
    const Image image = ReadFromBytes("deep.png", FromHex(kRgb16Png));
    EXPECT_EQ(image.channels, 3);
    const std::vector<float> expected = {
        0, 1, 32768 / 65535.f, 1 / 65535.f, 257 / 65535.f, 1000 / 65535.f};
    ExpectNear(Texels<float>(image), expected, 1e-7f);
}

TEST(ReadImage, ReadsTgaFromEitherCorner) {
    // 1x2, 24 bits, BGR; the first row stored is the lower one unless bit 5 is set.
    const std::string head("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\2\0\x18", 17);
    const std::string texels = "\1\2\3\4\5\6";
    EXPECT_EQ(Texels<uint8_t>(ReadFromBytes("a.tga", head + std::string(1, '\0') + texels)),
              (std::vector<uint8_t>{6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(Texels<uint8_t>(ReadFromBytes("a.tga", head + '\x20' + texels)),
              (std::vector<uint8_t>{3, 2, 1, 6, 5, 4}));
}

TEST(ReadImage, ReadsJpeg) {
    // One 8x8 block with no AC coefficients: Y = 200, Cb = 112, Cr = 144; quantiser 8.
    const std::string jpeg = FromHex("ffd8ffdb004300") + std::string(64, '\x08') +
                             FromHex(
                                 "ffc00011080008000803011100021100031100"
                                 "ffc4001500010100000000000000000000000000000705"
                                 "ffc40014100100000000000000000000000000000000"
                                 "ffda000c03010002000300003f00484f507fffd9");
    const Image image = ReadFromBytes("a.jpg", jpeg);
    EXPECT_EQ(image.width, 8);
    EXPECT_EQ(image.channels, 3);
    const auto& texels = Texels<uint8_t>(image);
    EXPECT_NEAR(texels[0], 200 + 1.402 * 16, 1);
    EXPECT_NEAR(texels[1], 200 + 0.344 * 16 - 0.714 * 16, 1);
    EXPECT_NEAR(texels[8 * 8 * 3 - 1], 200 - 1.772 * 16, 1);
}

TEST(ReadImage, ReadsRadianceHdr) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    const Image image = ReadFromBytes("a.hdr", header + FromHex("8040208180808084"));
    EXPECT_EQ(image.channels, 3);
    const std::vector<float> expected = {1, 0.5f, 0.25f, 8, 8, 8};
    ExpectNear(Texels<float>(image), expected, 0.04f);
}

// 2 columns, 3 rows, stored in all eight orders; each texel is as bright as its place.
TEST(ReadImage, TurnsRadianceHdrUpright) {
    const std::string texels = FromHex("808080818080808280808083808080848080808580808086");
    struct Order {
        const char* size;
        std::array<int, 6> at;  // the place among the stored texels of each texel
    };
    for (const Order& order :
         {Order{"-Y 3 +X 2", {0, 1, 2, 3, 4, 5}}, Order{"-Y 3 -X 2", {1, 0, 3, 2, 5, 4}},
          Order{"+Y 3 -X 2", {5, 4, 3, 2, 1, 0}}, Order{"+Y 3 +X 2", {4, 5, 2, 3, 0, 1}},
          Order{"+X 2 -Y 3", {0, 3, 1, 4, 2, 5}}, Order{"-X 2 -Y 3", {3, 0, 4, 1, 5, 2}},
          Order{"-X 2 +Y 3", {5, 2, 4, 1, 3, 0}}, Order{"+X 2 +Y 3", {2, 5, 1, 4, 0, 3}}}) {
        const Image image =
            ReadFromBytes("a.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n") +
                                       order.size + "\n" + texels);
        ASSERT_EQ(image.width, 2) << order.size;
        ASSERT_EQ(image.height, 3) << order.size;
        for (size_t i = 0; i < 6; ++i) {
            const float expected = std::ldexp(128 / 256.f, 1 + order.at[i]);
            EXPECT_NEAR(Texels<float>(image)[3 * i], expected, 0.01f * expected) << order.size << i;
        }
    }
}

// What was multiplied when it was stored is divided.
TEST(ReadImage, UndoesExposureOfRadianceHdr) {
    const Image image = ReadFromBytes("a.hdr",
                                      "#?RADIANCE\nEXPOSURE=2\nEXPOSURE=  4.0\n"
                                      "COLORCORR=1 2 4\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" +
                                          FromHex("80808084"));
    ExpectNear(Texels<float>(image), {1, 0.5f, 0.25f}, 0.01f);
    // Exposed first, (0.5 * 8)^(1 / 2) is stored as 2.
    const Image raised = ReadFromBytes("a.hdr",
                                       "#?RADIANCE\nGAMMA= 2.0\nEXPOSURE=8\n"
                                       "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" +
                                           FromHex("80402082"));
    ExpectNear(Texels<float>(raised), {0.5f, 0.125f, 0.03125f}, 0.01f);
}

TEST(ReadImage, ConvertsRadianceHdrOfOtherPrimaries) {
    const auto red = [](const std::string& primaries) {
        return Texels<float>(ReadFromBytes("a.hdr", "#?RADIANCE\nPRIMARIES= " + primaries +
                                                        "\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" +
                                                        FromHex("80000081")));
    };
    ExpectNear(red(".708 .292 .17 .797 .131 .046 .3127 .329"), {1.6605f, 0, 0}, 2e-3f);
    // Radiance's own.
    ExpectNear(red("0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333"), {1, 0, 0}, 1e-6f);
}

TEST(ReadImage, ReadsPfmTopDown) {
    const float values[6] = {1, 2, 3, -4, 5e6f, 6};  // the lower row comes first
    std::string pfm = "PF\n1 2\n-1.0\n";
    pfm.append(reinterpret_cast<const char*>(values), sizeof(values));
    EXPECT_EQ(Texels<float>(ReadFromBytes("a.pfm", pfm)),
              (std::vector<float>{-4, 5e6f, 6, 1, 2, 3}));
}

TEST(ReadImage, SaysWhatIsWrong) {
    const TemporaryDirectory directory;
    const auto read = [](const std::string& path) { return ErrorOf([&] { ReadImage(path); }); };
    EXPECT_HAS(read("/nowhere/a.png"), "/nowhere/a.png");
    EXPECT_HAS(read("/nowhere/a.png"), "no such file");
    EXPECT_HAS(read(directory.path.string()), "directory");
    EXPECT_HAS(read(directory.Write("text.png", "hello")), "text.png");
    EXPECT_HAS(read(directory.Write("a.unknown", "hello")), "a.unknown");
    EXPECT_HAS(read(directory.Write("empty.exr", "")), "empty.exr");
    const std::string cut = read(directory.Write("cut.png", FromHex(kRgbPng).substr(0, 50)));
    EXPECT_HAS(cut, "cut.png\": it is cut short");
    const std::string cutPfm =
        read(directory.Write("cut.pfm", "PF\n2 2\n-1.0\n" + std::string(8, 0)));
    // OpenImageIO has a word of its own for it since 3.1.
    EXPECT_TRUE(Contains(cutPfm, "cut.pfm\": it is cut short") ||
                Contains(cutPfm, "cut.pfm\": Premature end of file"))
        << cutPfm;
    EXPECT_HAS(read(directory.Write("huge.png", FromHex(kHugePng))), "60000x60000x3");
    const std::string xyz = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
    EXPECT_HAS(read(directory.Write("a.hdr", xyz + FromHex("80808084"))), "X, Y and Z");
    // 8x2 texels of one bit, which a file need not say.
    const std::string tiff = FromHex(
        "49492a0008000000060000010300010000000800000001010300010000000200000006010300010000000100"
        "00001101040001000000560000001601030001000000020000001701040001000000020000000000000055aa");
    EXPECT_HAS(read(directory.Write("a.tif", tiff)), "one bit a pixel");
}

TEST(ReadImage, RefusesWhatIsCutShort) {
    const TemporaryDirectory directory;
    const ExrChannel grey{"Y", std::vector<float>(120), true};
    WriteExr(directory.File("a.exr"), ExrImage{3, 40, Vec2i::Zero(), {0, 0}, {grey}, {}});
    const auto refuse = [&](const std::string& bytes, size_t most) {
        for (size_t size = 8; size < most; ++size)
            EXPECT_THROW(ReadImage("cut", "", std::as_bytes(std::span(bytes.data(), size))), Error)
                << size << " of " << bytes.size();
        EXPECT_NO_THROW(ReadImage("whole", "", std::as_bytes(std::span(bytes))));
    };
    const std::string exr = directory.Bytes("a.exr");
    refuse(exr, exr.size());
    // The last bytes of a PNG are checksums and the end, which nobody waits for.
    for (const char* png : {kRgbPng, kRgb16Png, kInterlacedPng}) {
        const std::string bytes = FromHex(png);
        refuse(bytes, bytes.size() - 24);
    }
}

TEST(WritePng, EncodesSrgb) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("a.png");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Rgb> pixels = {{0, 0.0031308f, 0.5f},
                                     {1, 2, -1},
                                     {nan, kInfinity, -kInfinity},
                                     {0.214041f, 0.0001f, 0.99f}};
    WritePng(path, pixels, 2, 2);
    // By hand: 255 * 12.92 * 0.0031308 = 10.3; 255 * (1.055 * 0.5^(1/2.4) - 0.055) = 187.5;
    // 0.214041 is the linear value of 0.5: 127.5; 0.0001: 0.33; 0.99: 253.9.
    const auto texels = Texels<uint8_t>(ReadImage(path));
    const std::vector<uint8_t> expected = {0, 10, 188, 255, 255, 0, 0, 255, 0, 128, 0, 254};
    ASSERT_EQ(texels.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(texels[i], expected[i], i == 9 ? 1 : 0) << i;  // 127.5 may go either way

    EXPECT_THROW(WritePng(path, pixels, 2, 3), Error);
    EXPECT_EQ(Texels<uint8_t>(ReadImage(path)), texels);
}

TEST(WritePng, EncodesSixteenBitsToneMapsAndText) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("a.png");
    const std::vector<Rgb> pixels = {{0, 0.5f, 1}, {5.6f, 0.18f, -1}};
    WritePng(path, pixels, 2, 1, {.bits = 16, .text = {{"ToneMap", "none"}}});
    const auto wide = Texels<float>(ReadImage(path));  // 16-bit integers become 0 to 1
    const float expected[] = {0, SrgbFromLinear(0.5f), 1, 1, SrgbFromLinear(0.18f), 0};
    for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(wide[i], expected[i], 1e-5f) << i;
    EXPECT_HAS(ReadBytes(path), std::string("tEXtToneMap\0none", 16));

    WritePng(path, pixels, 2, 1, {.grade = {.toneMap = ToneMap::Filmic}});
    const auto mapped = Texels<uint8_t>(ReadImage(path));
    const float display[] = {0, FilmicToneMap(0.5f), FilmicToneMap(1), 1, FilmicToneMap(0.18f), 0};
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(mapped[i], 255 * SrgbFromLinear(display[i]), 0.501f) << i;
    EXPECT_FALSE(Contains(ReadBytes(path), "ToneMap"));
}

// Colours come multiplied by alpha, and are stored without; alpha is no colour.
TEST(WritePng, StoresAlpha) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("a.png");
    const std::vector<float> row = {0.1f, 0.2f, 0.25f, 0.5f, 1, 1, 1, 0, 0.5f, 0, 2, 1};
    const RowSource rows = [&](int, std::span<float> to) { std::ranges::copy(row, to.begin()); };
    WritePng(path, rows, 3, 1, {.hasAlpha = true});
    const Image image = ReadImage(path);
    EXPECT_EQ(image.channels, 4);
    const auto texels = Texels<uint8_t>(image);
    const uint8_t a = Encode8Bit(0.2f), b = Encode8Bit(0.4f), c = Encode8Bit(0.5f);
    const std::vector<uint8_t> expected = {a, b, c, 128, 0, 0, 0, 0, c, 0, 255, 255};
    EXPECT_EQ(texels, expected);
}

TEST(WritePng, KeepsTheOldFileWhereItFails) {
    const TemporaryDirectory directory;
    const std::vector<Rgb> pixels(4, Rgb::Constant(1));
    EXPECT_HAS(ErrorOf([&] { WritePng(directory.path.string(), pixels, 2, 2); }), "directory");
    EXPECT_THROW(WritePng(directory.File("none/a.png"), pixels, 2, 2), Error);
    EXPECT_EQ(directory.CountFiles(), 0);
}

// Colours are those of the file whatever their alpha, as in PNG.
TEST(ImageIo, WebPKeepsItsColours) {
    for (const char* hex : {kLosslessWebP, kLossyWebP}) {
        const std::string bytes = FromHex(hex);
        const TemporaryDirectory directory;
        for (const Image& image : {ReadImage(directory.Write("a.webp", bytes)),
                                   ReadImage("a", "webp", std::as_bytes(std::span(bytes)))}) {
            ASSERT_EQ(image.channels, 4);
            const std::vector<uint8_t>& texels = Texels<uint8_t>(image);
            ASSERT_EQ(texels.size(), 24u);
            for (size_t i = 0; i < 6; ++i) {
                EXPECT_NEAR(texels[4 * i], 204, 3) << i;
                EXPECT_NEAR(texels[4 * i + 1], 102, 3) << i;
                EXPECT_NEAR(texels[4 * i + 2], 51, 3) << i;
                EXPECT_EQ(texels[4 * i + 3], (std::array{0, 128, 255, 255, 0, 1})[i]);
            }
        }
    }
}

struct HalvingView final : ViewTransform {
    void Apply(float* rgb, size_t pixels) const override {
        for (size_t i = 0; i < 3 * pixels; ++i) rgb[i] /= 2;
    }
    const char* Name() const override { return "screen/half"; }
};

std::vector<float> Shown(const Grade& grade, std::vector<float> rgb) {
    ApplyGrade(grade, rgb);
    return rgb;
}

TEST(Grade, LeavesColoursAsTheyAre) {
    EXPECT_TRUE(Grade().IsPlain());
    EXPECT_EQ(TextOf(Grade()), "");
    EXPECT_EQ(Shown({}, {0, 0.25f, 7}), (std::vector<float>{0, 0.25f, 7}));
}

TEST(Grade, Brightens) {
    const Grade grade{.exposure = 2};
    EXPECT_FALSE(grade.IsPlain());
    EXPECT_EQ(TextOf(grade), "+2 stops");
    EXPECT_EQ(Shown(grade, {0, 0.25f, 7}), (std::vector<float>{0, 1, 28}));
    const std::vector<float> odd = Shown(grade, {-1, std::nanf(""), kInfinity});
    EXPECT_EQ(odd[0], 0);
    EXPECT_EQ(odd[1], 0);
    EXPECT_TRUE(std::isfinite(odd[2]));
}

TEST(Grade, MapsTonesOfBrightenedColours) {
    const Grade grade{.toneMap = ToneMap::Filmic, .exposure = -1};
    EXPECT_EQ(TextOf(grade), "filmic (Hable 2010), -1 stops");
    EXPECT_EQ(Shown(grade, {0.5f, 2, kInfinity}),
              (std::vector<float>{FilmicToneMap(0.25f), FilmicToneMap(1), FilmicToneMap(1e9f)}));
}

// What a view encodes, a display decodes.
TEST(Grade, ShowsWhatAViewEncodes) {
    const Grade grade{.view = std::make_shared<HalvingView>(), .exposure = 1};
    EXPECT_EQ(TextOf(grade), "OpenColorIO screen/half, +1 stops");
    const std::vector<float> shown = Shown(grade, {0.25f, 5, -1});
    EXPECT_FLOAT_EQ(shown[0], LinearFromSrgb(0.25f));
    EXPECT_EQ(shown[1], 1);
    EXPECT_EQ(shown[2], 0);
}

// Values of Hable's formula, computed by hand.
TEST(FilmicToneMap, IsHablesCurve) {
    EXPECT_EQ(FilmicToneMap(0), 0);
    EXPECT_NEAR(FilmicToneMap(0.18f), 0.1283f, 2e-4f);
    EXPECT_NEAR(FilmicToneMap(1), 0.4929f, 2e-4f);
    EXPECT_NEAR(FilmicToneMap(5.6f), 1, 1e-6f);  // the white point at twice the exposure
}

TEST(FilmicToneMap, RisesAndStaysFinite) {
    float last = -1;
    for (float x = 1e-6f; x < 1e30f; x *= 1.5f) {
        const float y = FilmicToneMap(x);
        EXPECT_GE(y, last) << x;
        last = y;
    }
    EXPECT_LT(last, 1.3f);
    EXPECT_EQ(FilmicToneMap(-1), 0);
    EXPECT_EQ(FilmicToneMap(std::nanf("")), 0);
    EXPECT_TRUE(std::isfinite(FilmicToneMap(kInfinity)));
}

}  // namespace

}  // namespace lull
