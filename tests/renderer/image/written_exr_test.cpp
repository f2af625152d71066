// EXRs as lull writes them.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "renderer/image/image_io.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

// Makes an image whose values all differ and are halves.
ExrImage MakeExr(int width, int height, const std::vector<std::string>& names, bool isHalf) {
    ExrImage image{width, height, Vec2i::Zero(), {0, 0}, {}, {}};
    for (size_t c = 0; c < names.size(); ++c) {
        ExrChannel& channel = image.channels.emplace_back(ExrChannel{names[c], {}, isHalf});
        for (int i = 0; i < width * height; ++i)
            channel.values.push_back(float(i) * 0.25f + float(c) * 64);
    }
    return image;
}

TEST(Exr, RefusesAbsurdSizes) {
    const TemporaryDirectory directory;
    WriteExr(directory.File("a.exr"), MakeExr(3, 40, {"R", "G", "B"}, true));
    const std::string exr = directory.Bytes("a.exr");
    const std::string key("dataWindow\0box2i\0\x10\0\0\0", 21);
    const size_t at = exr.find(key) + key.size();
    ASSERT_GT(at, key.size());
    for (const std::array<int, 4>& window : {std::array<int, 4>{0, 0, 65535, 65535},
                                             {0, 0, 65536, 0},
                                             {0, 0, 0x7ffffffe, 0x7ffffffe},
                                             {-0x7fffffff, -0x7fffffff, 0x7fffffff, 0x7fffffff},
                                             {0, 5, 10, 0},
                                             {0, 0, 59999, 59999}}) {
        std::string bytes = exr;
        std::memcpy(&bytes[at], window.data(), sizeof(window));
        const std::string path = directory.Write("b.exr", bytes);
        EXPECT_HAS(ErrorOf([&] { ReadImage(path); }), "b.exr\": ") << window[2];
        EXPECT_HAS(ErrorOf([&] { ReadExr(path); }), "b.exr\": ") << window[2];
    }
}

TEST(Exr, KeepsHalfAndFloat) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("a.exr");
    WriteExr(path, MakeExr(3, 2, {"R", "G", "B"}, true));
    const Image half = ReadImage(path);
    EXPECT_EQ(half.channels, 3);
    EXPECT_EQ(std::get<std::vector<Half>>(half.texels)[0], Half(0));
    EXPECT_EQ(std::get<std::vector<Half>>(half.texels)[3 * 5 + 2], Half(5 * 0.25f + 128));

    WriteExr(path, MakeExr(3, 2, {"R", "G", "B"}, false));
    EXPECT_EQ(std::get<std::vector<float>>(ReadImage(path).texels)[3 * 5 + 2], 5 * 0.25f + 128);

    WriteExr(path, MakeExr(3, 2, {"Y"}, true));
    EXPECT_EQ(ReadImage(path).channels, 1);
    WriteExr(path, MakeExr(3, 2, {"R", "G", "B", "A"}, true));
    EXPECT_EQ(ReadImage(path).channels, 4);
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(Exr, RoundTripsChannelsAttributesAndWindows) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("a.exr");
    ExrImage image = MakeExr(5, 4, {"R", "G", "B"}, true);
    image.channels.push_back({"spp", std::vector<float>(20, 9980), false});
    image.channels.push_back({"variance.R", std::vector<float>(20, 1e-20f), false});
    image.channels[0].values[7] = 1e6f;  // too large for half
    image.channels[3].values[3] = 123456.75f;
    image.origin = {10, 20};
    image.displaySize = {100, 50};
    Mat4d matrix;
    matrix << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16.5;
    image.attributes = {{"worldToCamera", matrix},
                        {"worldToNDC", Mat4d(2 * matrix)},
                        {"sampler", std::string("sobol")},
                        {"rejectedSamples", 17},
                        {"renderTimeSeconds", 1.5f}};
    EXPECT_EQ(WriteExr(path, image), 1);  // clamped

    const ExrImage read = ReadExr(path);
    EXPECT_EQ(read.width, 5);
    EXPECT_EQ(read.height, 4);
    EXPECT_EQ(read.origin, Vec2i(10, 20));
    EXPECT_EQ(read.displaySize, Vec2i(100, 50));
    ASSERT_EQ(read.channels.size(), 5u);
    for (const ExrChannel& c : image.channels) {
        const ExrChannel* same = read.Find(c.name);
        ASSERT_NE(same, nullptr) << c.name;
        EXPECT_EQ(same->isHalf, c.isHalf) << c.name;
        if (c.name == "R")
            EXPECT_EQ(same->values[7], kLargestHalf);
        else
            EXPECT_EQ(same->values, c.values) << c.name;
    }
    EXPECT_EQ(read.Find("Z"), nullptr);
    for (const auto& [name, value] : image.attributes) {
        ASSERT_TRUE(read.attributes.count(name)) << name;
        EXPECT_EQ(read.attributes.at(name), value) << name;
    }
    // As a picture, the file is its first three channels.
    EXPECT_EQ(ReadImage(path).channels, 3);

    // Other programs must find the matrix under this very name, row by row as pbrt writes it.
    const std::string bytes = ReadBytes(path);
    const std::string key("worldToCamera\0m44f\0\x40\0\0\0", 23);
    const size_t at = bytes.find(key);
    ASSERT_NE(at, std::string::npos);
    float values[16];
    std::memcpy(values, bytes.data() + at + key.size(), sizeof(values));
    EXPECT_EQ(values[1], 2);
    EXPECT_EQ(values[15], 16.5f);
    EXPECT_HAS(bytes, std::string("worldToNDC\0m44f\0", 16));
    EXPECT_HAS(bytes, std::string("compression\0compression\0\1\0\0\0\3", 29));
}

TEST(Exr, RefusesToWriteWhatDoesNotFit) {
    const TemporaryDirectory directory;
    const std::string path = directory.Write("a.exr", "old");
    ExrImage image = MakeExr(2, 2, {"R", "G", "B"}, true);
    image.channels[1].values.pop_back();
    EXPECT_THROW(WriteExr(path, image), Error);
    EXPECT_THROW(WriteExr(path, ExrImage{}), Error);
    EXPECT_EQ(ReadBytes(path), "old");
    EXPECT_EQ(directory.CountFiles(), 1);
    image = MakeExr(2, 2, {"R", "G", "B"}, true);
    EXPECT_THROW(WriteExr(directory.path.string(), image), Error);
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_THROW(WriteExr("/dev/full", image), Error);
    }
}

}  // namespace
}  // namespace lull
