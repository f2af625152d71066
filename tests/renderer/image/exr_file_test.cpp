// EXRs that lull does not write itself, as OpenEXR writes them.
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <numeric>

#include "renderer/image/files/exr_channels.h"
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

// What all files below hold: 7x5 texels of one channel.
struct OneChannel {
    TemporaryDirectory directory;
    std::string path = directory.File("a.exr");
    Imf::Header header{7, 5};
    std::vector<float> values = std::vector<float>(35);

    OneChannel() { std::iota(values.begin(), values.end(), 1.f); }
    Imf::FrameBuffer Frame(Imf::PixelType type, const void* texels) const {
        Imf::FrameBuffer frame;
        frame.insert("Y", Imf::Slice::Make(type, texels, header.dataWindow()));
        return frame;
    }
};

TEST(ExrFile, ReadsTiles) {
    OneChannel file;
    file.header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
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

TEST(ExrFile, TurnsIntegersIntoZeroToOne) {
    OneChannel file;
    file.header.channels().insert("Y", Imf::Channel(Imf::UINT));
    std::vector<uint32_t> integers(35, 1u << 30);
    integers[34] = 0xffffffff;
    {
        Imf::OutputFile out(file.path.c_str(), file.header);
        out.setFrameBuffer(file.Frame(Imf::UINT, integers.data()));
        out.writePixels(5);
    }
    const auto texels = std::get<std::vector<float>>(ReadImage(file.path).texels);
    EXPECT_EQ(texels[0], 0.25f);
    EXPECT_EQ(texels[34], 1);
    EXPECT_EQ(ReadExr(file.path).Find("Y")->values, texels);
}

TEST(ExrFile, RefusesDeepAndSubsampledData) {
    OneChannel file;
    file.header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    file.header.channels().insert("RY", Imf::Channel(Imf::HALF, 7, 5));
    { Imf::OutputFile(file.path.c_str(), file.header); }
    const std::string subsampled = ErrorOf([&] { ReadImage(file.path); });
    EXPECT_TRUE(Contains(subsampled, "a.exr\": subsampled channels are not supported (RY)"))
        << subsampled;

    file.header.channels() = Imf::ChannelList();
    file.header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    file.header.setType(Imf::DEEPSCANLINE);
    file.header.compression() = Imf::ZIPS_COMPRESSION;
    { Imf::DeepScanLineOutputFile(file.path.c_str(), file.header); }
    const std::string deep = ErrorOf([&] { ReadExr(file.path); });
    EXPECT_TRUE(Contains(deep, "deep images are not supported")) << deep;
}

// The library would allocate them first.
TEST(ExrFile, RefusesAttributesThatAreLongerThanTheFile) {
    OneChannel file;
    file.header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    file.header.insert("note", Imf::StringAttribute("hello"));
    {
        Imf::OutputFile out(file.path.c_str(), file.header);
        out.setFrameBuffer(file.Frame(Imf::FLOAT, file.values.data()));
        out.writePixels(5);
    }
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
    const std::string tooLong = ErrorOf([&] { ReadExr(file.path); });
    EXPECT_TRUE(Contains(tooLong, "a.exr")) << tooLong;
    EXPECT_TRUE(Contains(tooLong, "attribute 'note' has 2147483647 bytes, of which")) << tooLong;

    file.directory.Write("a.exr", start);
    const std::string cut = ErrorOf([&] { ReadExr(file.path); });
    EXPECT_TRUE(Contains(cut, "cut short")) << cut;

    file.directory.Write("a.exr", channels);
    const std::string damaged = ErrorOf([&] { ReadExr(file.path); });
    EXPECT_TRUE(Contains(damaged, "its list of channels is damaged")) << damaged;
}

TEST(ExrFile, KnowsOtherPrimaries) {
    for (const bool isOther : {false, true}) {
        OneChannel file;
        file.header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        Imf::Chromaticities primaries;
        if (isOther) primaries.red = {0.7347f, 0.2653f};  // ACES
        Imf::addChromaticities(file.header, primaries);
        {
            Imf::OutputFile out(file.path.c_str(), file.header);
            out.setFrameBuffer(file.Frame(Imf::FLOAT, file.values.data()));
            out.writePixels(5);
        }  // the file is whole once it is closed
        EXPECT_EQ(ReadExr(file.path).attributes.contains("chromaticities"), isOther);
    }
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
