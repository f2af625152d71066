// EXRs that lull does not write itself, as OpenEXR writes them.
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

#include "renderer/image/files/exr_header.h"
#include "renderer/image/image_io.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

std::vector<std::string> Sorted(std::vector<std::string> names) {
    SortChannels(&names);
    return names;
}

using Names = std::vector<std::string>;

TEST(ExrChannels, AreSortedAsColoursAndAsVectors) {
    EXPECT_EQ(Sorted({"A", "B", "G", "R", "Z"}), (Names{"R", "G", "B", "A", "Z"}));
    EXPECT_EQ(Sorted({"A", "Y", "spp"}), (Names{"Y", "A", "spp"}));
    EXPECT_EQ(Sorted({"alpha", "blue", "Green", "red"}), (Names{"red", "Green", "blue", "alpha"}));
    EXPECT_EQ(Sorted({"A", "X", "Y", "Z"}), (Names{"X", "Y", "Z", "A"}));
    EXPECT_EQ(Sorted({"B", "G", "N.A", "N.X", "N.Z", "R", "a.b.G", "a.b.R", "spp"}),
              (Names{"R", "G", "B", "spp", "N.X", "N.Z", "N.A", "a.b.R", "a.b.G"}));
    EXPECT_TRUE(IsAlpha("diffuse.Alpha"));
    EXPECT_FALSE(IsAlpha("spp"));
}

// Colours of no layer come first, then those of Blender's combined pass, then the only ones.
TEST(ExrChannels, OfPicturesAreTheirColours) {
    const auto chosen = [](Names names) { return PictureChannels(Sorted(std::move(names))); };
    EXPECT_EQ(chosen({"A", "B", "G", "R", "Z"}), (Names{"R", "G", "B", "A"}));
    EXPECT_EQ(chosen({"B", "G", "R", "Z", "aa.B", "aa.G", "aa.R"}), (Names{"R", "G", "B"}));
    EXPECT_EQ(chosen({"Depth.Z", "L.Combined.A", "L.Combined.B", "L.Combined.G", "L.Combined.R",
                      "L.Noisy.B", "L.Noisy.G", "L.Noisy.R"}),
              (Names{"L.Combined.R", "L.Combined.G", "L.Combined.B", "L.Combined.A"}));
    EXPECT_EQ(chosen({"a.Z", "b.B", "b.G", "b.R"}), (Names{"b.R", "b.G", "b.B"}));
    // One that is missing is black.
    EXPECT_EQ(chosen({"G", "R"}), (Names{"R", "G", "B"}));
    // Without colours as they come; two are not a grey value and its alpha.
    EXPECT_EQ(chosen({"A", "Y"}), (Names{"Y", "A"}));
    EXPECT_EQ(chosen({"height.V"}), (Names{"height.V"}));
    EXPECT_EQ(chosen({"U", "V"}), (Names{"U"}));
    EXPECT_EQ(chosen({"N.X", "N.Y", "N.Z"}), (Names{"N.X", "N.Y", "N.Z"}));

    const auto error = [&](Names names) -> std::string {
        try {
            chosen(std::move(names));
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_HAS(error({"a.B", "a.G", "a.R", "b.B", "b.G", "b.R"}),
               "in several layers, such as a and b");
    EXPECT_HAS(error({"BY", "RY", "Y"}), "luminance and chroma");
}

// The matrices of Rec. 2020, which has the same white, and of ACEScg, which is adapted.
TEST(Primaries, BecomeRec709) {
    const auto expect = [](const Primaries& p, const std::array<double, 9>& rows) {
        const Eigen::Matrix3f m = Rec709From(p);
        for (int i = 0; i < 9; ++i) EXPECT_NEAR(m(i / 3, i % 3), rows[size_t(i)], 1e-3) << i;
        EXPECT_NEAR((m * Vec3f::Ones() - Vec3f::Ones()).norm(), 0, 1e-5);
    };
    expect({{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3127f, 0.329f}},
           {1, 0, 0, 0, 1, 0, 0, 0, 1});
    expect({{0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.329f}},
           {1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187});
    expect({{0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f}},
           {1.7051, -0.6218, -0.0833, -0.1303, 1.1408, -0.0105, -0.0240, -0.1290, 1.1530});
    EXPECT_FALSE(Rec709From({{0, 0}, {0, 0}, {0, 0}, {0.3f, 0.3f}}).allFinite());
}

// What all files below hold: 7x5 texels of one channel.
struct OneChannel {
    TemporaryDirectory directory;
    std::string path = directory.File("a.exr");
    Imf::Header header{7, 5};
    std::vector<float> values = std::vector<float>(35);

    explicit OneChannel(Imf::PixelType type = Imf::FLOAT) {
        header.channels().insert("Y", Imf::Channel(type));
        std::iota(values.begin(), values.end(), 1.f);
    }
    Imf::FrameBuffer Frame(Imf::PixelType type, const void* texels) const {
        Imf::FrameBuffer frame;
        frame.insert("Y", Imf::Slice::Make(type, texels, header.dataWindow()));
        return frame;
    }
    // Writes scan lines; the file is whole once it is closed.
    void Write(Imf::PixelType type, const void* texels) const {
        Imf::OutputFile out(path.c_str(), header);
        out.setFrameBuffer(Frame(type, texels));
        out.writePixels(5);
    }
    void ExpectError(const std::string& part) const {
        EXPECT_HAS(ErrorOf([&] { ReadExr(path); }), part);
    }
};

TEST(ExrFile, ReadsTiles) {
    OneChannel file;
    file.header.setTileDescription(Imf::TileDescription(4, 2, Imf::MIPMAP_LEVELS));
    {
        Imf::TiledOutputFile out(file.path.c_str(), file.header);
        out.setFrameBuffer(file.Frame(Imf::FLOAT, file.values.data()));
        for (int level = 0; level < out.numLevels(); ++level)
            out.writeTiles(0, out.numXTiles(level) - 1, 0, out.numYTiles(level) - 1, level);
    }
    const Image image = ReadImage(file.path);
    EXPECT_EQ(image.width, 7);
    EXPECT_EQ(image.height, 5);
    EXPECT_EQ(std::get<std::vector<float>>(image.texels), file.values);
    EXPECT_EQ(ReadExr(file.path).Find("Y")->values, file.values);
}

// As other programs store a pair in one part: those of the first view have no name before theirs.
TEST(ExrFile, TellsItsViews) {
    OneChannel file;
    file.Write(Imf::FLOAT, file.values.data());
    EXPECT_EQ(ReadExr(file.path).views, Names());
    Imf::addMultiView(file.header, {"left", "right"});
    file.header.channels().insert("right.Y", Imf::Channel(Imf::FLOAT));
    file.Write(Imf::FLOAT, file.values.data());
    const ExrImage pair = ReadExr(file.path);
    EXPECT_EQ(pair.views, (Names{"left", "right"}));
    EXPECT_NE(pair.Find("right.Y"), nullptr);
}

TEST(ExrFile, TurnsIntegersIntoZeroToOne) {
    const OneChannel file(Imf::UINT);
    std::vector<uint32_t> integers(35, 1u << 30);
    integers[34] = 0xffffffff;
    file.Write(Imf::UINT, integers.data());
    const auto texels = std::get<std::vector<float>>(ReadImage(file.path).texels);
    EXPECT_EQ(texels[0], 0.25f);
    EXPECT_EQ(texels[34], 1);
    EXPECT_EQ(ReadExr(file.path).Find("Y")->values, texels);
}

TEST(ExrFile, RefusesDeepAndSubsampledData) {
    OneChannel file;
    file.header.channels().insert("RY", Imf::Channel(Imf::HALF, 7, 5));
    { Imf::OutputFile(file.path.c_str(), file.header); }
    file.ExpectError("a.exr\": subsampled channels are not supported (RY)");

    file.header.channels() = Imf::ChannelList();
    file.header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    file.header.setType(Imf::DEEPSCANLINE);
    file.header.compression() = Imf::ZIPS_COMPRESSION;
    { Imf::DeepScanLineOutputFile(file.path.c_str(), file.header); }
    file.ExpectError("deep images are not supported");
}

// The library would allocate them first.
TEST(ExrFile, RefusesAttributesThatAreLongerThanTheFile) {
    OneChannel file;
    file.header.insert("note", Imf::StringAttribute("hello"));
    file.Write(Imf::FLOAT, file.values.data());
    std::string bytes = ReadBytes(file.path);
    const std::string before("note\0string\0\5\0\0\0hello", 21);
    const size_t at = bytes.find(before);
    ASSERT_NE(at, std::string::npos);
    EXPECT_EQ(ReadExr(file.path).Find("Y")->values, file.values);
    const std::string start = bytes.substr(0, at + before.size());
    std::string channels = bytes;
    channels.replace(channels.find("chlist"), 12, std::string("chlist\0\x14\0\0\0Y", 12));
    bytes.replace(at + 12, 4, "\xff\xff\xff\x7f");
    file.directory.Write("a.exr", bytes);
    file.ExpectError("a.exr\": its attribute 'note' has 2147483647 bytes, of which");

    file.directory.Write("a.exr", start);
    file.ExpectError("cut short");

    file.directory.Write("a.exr", channels);
    file.ExpectError("its list of channels is damaged");
}

TEST(ExrFile, KnowsOtherPrimaries) {
    for (const bool isOther : {false, true}) {
        OneChannel file;
        Imf::Chromaticities primaries;
        if (isOther) primaries.red = {0.7347f, 0.2653f};  // ACES
        Imf::addChromaticities(file.header, primaries);
        file.Write(Imf::FLOAT, file.values.data());
        EXPECT_EQ(ReadExr(file.path).attributes.contains("chromaticities"), isOther);
    }
}

// Of pictures, colours of other primaries are converted.
TEST(ExrFile, ConvertsOtherPrimaries) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("a.exr");
    Imf::Header header(1, 1);
    Imf::Chromaticities rec2020({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f});
    Imf::addChromaticities(header, rec2020);
    const float colors[3] = {0.25f, 0.5f, 0.75f};
    Imf::FrameBuffer frame;
    for (int i = 0; i < 3; ++i) {
        const std::string name(1, "RGB"[i]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, colors + i, header.dataWindow()));
    }
    {
        Imf::OutputFile out(path.c_str(), header);
        out.setFrameBuffer(frame);
        out.writePixels(1);
    }
    const auto texels = std::get<std::vector<float>>(ReadImage(path).texels);
    EXPECT_NEAR(texels[0], 1.6605 * 0.25 - 0.5876 * 0.5 - 0.0728 * 0.75, 1e-3);
    EXPECT_NEAR(texels[1], -0.1246 * 0.25 + 1.1329 * 0.5 - 0.0083 * 0.75, 1e-3);
    EXPECT_NEAR(texels[2], -0.0182 * 0.25 - 0.1006 * 0.5 + 1.1187 * 0.75, 1e-3);
}

// Writes parts that show one pixel, with data of `wider[i]` more; the value of part i is i / 4.
std::string WriteParts(const TemporaryDirectory& directory, const std::vector<Names>& channels,
                       const std::vector<int>& wider = {}) {
    const std::string path = directory.File("parts.exr");
    std::vector<Imf::Header> headers;
    for (size_t i = 0; i < channels.size(); ++i) {
        const int right = wider.empty() ? 0 : wider[i];
        headers.emplace_back(Imath::Box2i({0, 0}, {0, 0}), Imath::Box2i({0, 0}, {right, 0}));
        headers.back().setName("part" + std::to_string(i));
        headers.back().setType(Imf::SCANLINEIMAGE);
        for (const std::string& name : channels[i])
            headers.back().channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
        for (int i = 0; i < int(headers.size()); ++i) {
            const std::vector<float> values(9, float(i) / 4);
            Imf::FrameBuffer frame;
            for (const std::string& name : channels[size_t(i)])
                frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(),
                                                    headers[size_t(i)].dataWindow()));
            Imf::OutputPart part(file, i);
            part.setFrameBuffer(frame);
            part.writePixels(1);
        }
    }
    return path;
}

// The rules for layers hold over all parts.
TEST(ExrFile, ReadsPartsAsLayers) {
    const TemporaryDirectory directory;
    const Names colours = {"R", "G", "B"}, albedo = {"albedo.R", "albedo.G", "albedo.B"},
                combined = {"L.Combined.R", "L.Combined.G", "L.Combined.B"};
    const auto texelsOf = [&](const std::vector<Names>& parts) {
        return std::get<std::vector<float>>(ReadImage(WriteParts(directory, parts)).texels);
    };
    const std::vector<float> second = {0.25f, 0.25f, 0.25f};
    EXPECT_EQ(texelsOf({{"Z"}, colours, colours}), second);
    EXPECT_EQ(texelsOf({{"L.Depth.Z"}, combined, {"L.Noisy.R", "L.Noisy.G", "L.Noisy.B"}}), second);
    EXPECT_EQ(texelsOf({albedo, colours}), second);
    EXPECT_EQ(texelsOf({{"R", "G"}, colours}), second);
    EXPECT_HAS(ErrorOf([&] {
                   texelsOf({{"left.R", "left.G", "left.B"}, {"right.R", "right.G", "right.B"}});
               }),
               "in several layers");
    // All are there, but for those of another size.
    const ExrImage exr = ReadExr(
        WriteParts(directory, {{"Z"}, colours, albedo, {"X", "Y", "Z"}, {"id"}}, {0, 0, 0, 0, 2}));
    const auto valueOf = [&](const char* name) { return exr.Find(name)->values; };
    EXPECT_EQ(exr.channels.size(), 10u);
    EXPECT_EQ(valueOf("Z"), (std::vector<float>{0}));
    EXPECT_EQ(valueOf("G"), (std::vector<float>{0.25f}));
    EXPECT_EQ(valueOf("albedo.B"), (std::vector<float>{0.5f}));
    EXPECT_EQ(valueOf("part3.Z"), (std::vector<float>{0.75f}));
}

// Writes Y = 1, 2, ... over the data window, of which a picture shows the display window.
std::string WriteWindows(const TemporaryDirectory& directory, const Imath::Box2i& display,
                         const Imath::Box2i& data, Imf::PixelType type = Imf::FLOAT) {
    const std::string path = directory.File("windows.exr");
    Imf::Header header(display, data);
    header.channels().insert("Y", Imf::Channel(type));
    const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
    std::vector<float> floats(size_t(width * height));
    std::iota(floats.begin(), floats.end(), 1.f);
    std::vector<Half> halves;
    for (const float v : floats) halves.emplace_back(v);
    const void* texels = type == Imf::HALF ? static_cast<const void*>(halves.data())
                                           : static_cast<const void*>(floats.data());
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(type, texels, data));
    Imf::OutputFile out(path.c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(height);
    return path;
}

Imath::Box2i Window(int x0, int y0, int x1, int y1) { return {{x0, y0}, {x1, y1}}; }

TEST(ExrFile, ShowsTheDisplayWindow) {
    const TemporaryDirectory directory;
    const auto texels = [&](const Imath::Box2i& display, const Imath::Box2i& data) {
        const Image image = ReadImage(WriteWindows(directory, display, data));
        EXPECT_EQ(image.width, display.max.x - display.min.x + 1);
        EXPECT_EQ(image.height, display.max.y - display.min.y + 1);
        return std::get<std::vector<float>>(image.texels);
    };
    using Floats = std::vector<float>;
    // Cropped; cropped, with other coordinates; larger than it; beyond two edges; beside it.
    EXPECT_EQ(texels(Window(0, 0, 3, 2), Window(2, 0, 3, 1)),
              (Floats{0, 0, 1, 2, 0, 0, 3, 4, 0, 0, 0, 0}));
    EXPECT_EQ(texels(Window(-5, 7, -4, 8), Window(-5, 8, -5, 8)), (Floats{0, 0, 1, 0}));
    EXPECT_EQ(texels(Window(0, 0, 1, 1), Window(-1, -1, 2, 2)), (Floats{6, 7, 10, 11}));
    EXPECT_EQ(texels(Window(0, 0, 2, 1), Window(2, 1, 3, 5)), (Floats{0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(texels(Window(0, 0, 1, 0), Window(5, 5, 6, 6)), (Floats{0, 0}));
    // More rows than are read at once, as halves.
    const Image tall =
        ReadImage(WriteWindows(directory, Window(0, 0, 0, 999), Window(0, 300, 0, 899), Imf::HALF));
    const auto& halves = std::get<std::vector<Half>>(tall.texels);
    EXPECT_EQ(float(halves[299]), 0);
    EXPECT_EQ(float(halves[300]), 1);
    EXPECT_EQ(float(halves[899]), 600);
    EXPECT_EQ(float(halves[900]), 0);
    // All of the data, with its place, is there for those who ask for the file.
    const ExrImage exr = ReadExr(WriteWindows(directory, Window(0, 0, 3, 2), Window(2, 0, 3, 1)));
    EXPECT_EQ(exr.origin, Vec2i(2, 0));
    EXPECT_EQ(exr.Find("Y")->values, (Floats{1, 2, 3, 4}));
}

}  // namespace
}  // namespace lull
