#include "renderer/lab/comparison/compared_files.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/image/image_io.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

constexpr int kWidth = 6, kHeight = 4;

// Writes a grey image of 6x4 pixels at (2, 0) of a larger one; `spp` of each pixel, if there are.
std::string WriteGrey(const TemporaryDirectory& directory, const std::string& name,
                      std::vector<float> spp = {}) {
    ExrImage image;
    image.width = kWidth;
    image.height = kHeight;
    image.origin = {2, 0};
    image.displaySize = {10, 4};
    for (const char* channel : {"R", "G", "B"})
        image.channels.push_back({channel, std::vector<float>(kWidth * kHeight, 0.25f)});
    if (!spp.empty()) image.channels.push_back({"spp", std::move(spp)});
    image.attributes["criterion"] = std::string("fixed:20");
    WriteExr(directory.File(name), image);
    return directory.File(name);
}

std::string WriteDisplay(const TemporaryDirectory& directory, int width = kWidth) {
    WritePng(directory.File("a.png"),
             std::vector<Rgb>(size_t(width) * kHeight, Rgb::Constant(0.25f)), width, kHeight);
    return directory.File("a.png");
}

TEST(ComparedFiles, AreToldByTheirNames) {
    for (const char* name : {"a.exr", "A.EXR", "b.png", "c.Jpg", "d.jpeg", "e.TIF", "f.tiff"})
        EXPECT_TRUE(IsImageFile(name)) << name;
    for (const char* name : {"a.csv", "png", "a.exr.csv", ""}) EXPECT_FALSE(IsImageFile(name));
}

TEST(ComparedFiles, KeepWhatTheyWereMadeWith) {
    const TemporaryDirectory directory;
    std::vector<float> spp(kWidth * kHeight, 20);
    for (size_t i = 0; i < spp.size(); ++i)
        if (i % kWidth >= 3) spp[i] = 60;
    ComparedFile file = ReadComparedFile(WriteGrey(directory, "a.exr", spp), "automatic");
    EXPECT_EQ(file.region, (PixelRect{{2, 0}, {8, 4}}));
    EXPECT_EQ(file.image.rule, "fixed:20");
    EXPECT_EQ(file.image.image.values.size(), size_t(kWidth * kHeight * 3));
    EXPECT_FALSE(file.image.wallSeconds);

    const Comparison comparison =
        ComparisonOf({ReadComparedFile(WriteGrey(directory, "b.exr"), "human"), file}, "a.exr",
                     {.blockSize = 3});
    EXPECT_EQ(comparison.region, file.region);
    EXPECT_EQ(comparison.cap, 60);
    EXPECT_EQ(comparison.blocks.size(), 4u);
    ASSERT_EQ(comparison.images.size(), 2u);
    EXPECT_TRUE(comparison.images[0].costs.empty());  // not known
    EXPECT_EQ(comparison.images[1].costs[0].spp, 20);
    EXPECT_EQ(comparison.images[1].costs[1].spp, 60);
    // Rendered in other blocks, it cannot be told what each took.
    EXPECT_TRUE(ComparisonOf({file}, "a.exr", {.blockSize = 4}).images[0].costs.empty());
}

// Those of other programs are black outside their data; ours are the part that was rendered.
TEST(ComparedFiles, ShowPictures) {
    const TemporaryDirectory directory;
    const std::string own = WriteGrey(directory, "own.exr");
    EXPECT_EQ(ReadShownPicture(own).width, kWidth);
    ExrImage foreign = ReadExr(own);
    foreign.attributes.clear();
    const std::string file = directory.File("foreign.exr");
    WriteExr(file, foreign);
    const RgbImage picture = ReadShownPicture(file);
    ASSERT_EQ(Vec2i(picture.width, picture.height), Vec2i(10, kHeight));
    for (int x = 0; x < 10; ++x)
        EXPECT_EQ(picture.values[size_t(3 * x)], x < 2 || x >= 8 ? 0 : 0.25f) << x;

    // Beside data of the same region they are these, beside all of the picture all of it.
    const ComparedFile part = ReadComparedFile(file, "part");
    EXPECT_EQ(ComparisonOf({part, part}, file, {}).region, part.region);
    foreign.origin = {0, 0};
    WriteExr(file, foreign);
    const Comparison whole = ComparisonOf({part, ReadComparedFile(file, "other")}, file, {});
    EXPECT_EQ(whole.region, (PixelRect{{0, 0}, {10, 4}}));
    EXPECT_EQ(whole.images[0].image.values, picture.values);
    EXPECT_EQ(ReadImageBeside(file, "a", BeginComparison(whole.region, {})).image.width, 10);
}

TEST(ComparedFiles, LetPicturesForDisplaysBeOfAnyPart) {
    const TemporaryDirectory directory;
    const ComparedFile display = ReadComparedFile(WriteDisplay(directory), "automatic"),
                       exr = ReadComparedFile(WriteGrey(directory, "b.exr"), "reference");
    EXPECT_TRUE(display.image.isDisplay);
    EXPECT_NEAR(display.image.image.values[0], 0.25f, 0.005f);
    const Comparison comparison = ComparisonOf({display, exr}, "b.exr", {});
    EXPECT_EQ(comparison.region, exr.region);
    EXPECT_HAS(DisplayNote(comparison), "displays: automatic.");
    EXPECT_EQ(DisplayNote(ComparisonOf({exr}, "b.exr", {})), "");

    Comparison scene = BeginComparison(exr.region, {});
    EXPECT_EQ(ReadImageBeside(directory.File("a.png"), "human", scene).wallSeconds, 0);
    EXPECT_EQ(ReadImageBeside(directory.File("b.exr"), "human", scene).name, "human");
    scene = BeginComparison({{0, 0}, {kWidth, kHeight}}, {});
    EXPECT_HAS(ErrorOf([&] { ReadImageBeside(directory.File("b.exr"), "human", scene); }),
               "b.exr: shows another part of the image than the scene would");
}

// Writes a pair whose views have these names, the first brighter than 0.25 in its left half.
std::string WritePair(const TemporaryDirectory& directory, const std::string& name, float brighter,
                      const std::vector<std::string>& views = {"left", "right"}) {
    std::vector<ExrImage> parts;
    std::vector<RowSource> rows;
    for (const std::string& view : views) {
        ExrImage& part = parts.emplace_back(ReadExr(WriteGrey(directory, "grey.exr")));
        part.width = part.height = 20;
        part.attributes["view"] = view;
        rows.push_back([=](int, std::span<float> row) {
            for (size_t i = 0; i < row.size(); ++i)
                row[i] = view == views[0] && i < row.size() / 2 ? 0.25f + brighter : 0.25f;
        });
    }
    WriteExr(directory.File(name), parts, rows);
    return directory.File(name);
}

// Each eye is measured by itself: noise that one has at the seam is no error of the other.
TEST(ComparedFiles, MayBePairs) {
    const TemporaryDirectory directory;
    const ComparedFile pair = ReadComparedFile(WritePair(directory, "a.exr", 0.25f), "automatic"),
                       reference = ReadComparedFile(WritePair(directory, "b.exr", 0), "reference");
    EXPECT_EQ(pair.region, (PixelRect{{2, 0}, {42, 20}}));
    EXPECT_EQ(pair.image.image.values[3 * 9], 0.5f);
    EXPECT_EQ(pair.image.image.values[3 * 10], 0.25f);
    Comparison comparison = ComparisonOf({pair, reference}, "b.exr", {.blockSize = 15});
    EXPECT_EQ(comparison.blocks.size(), 8u);
    Measure(&comparison);
    const ComparedImage& image = comparison.images[0];
    ASSERT_EQ(image.eyes.size(), 2u);
    EXPECT_NEAR(image.eyes[0].rmse, 0.25 * std::sqrt(0.5), 1e-6);
    EXPECT_EQ(image.eyes[1].rmse, 0);
    EXPECT_NEAR(image.figures->rmse, 0.25 * std::sqrt(0.25), 1e-6);
    EXPECT_NEAR(image.figures->psnr, image.eyes[0].psnr + 10 * std::log10(2), 1e-6);
    EXPECT_EQ(image.figures->visibleDifference, image.eyes[0].visibleDifference);
    EXPECT_GT(image.blockFigures[0].flip, 0);
    EXPECT_EQ(image.blockFigures[4].visibleDifference, 0);
    EXPECT_EQ(image.flip.size(), size_t(40 * 20));

    const ComparedFile turned =
        ReadComparedFile(WritePair(directory, "c.exr", 0.25f, {"right", "left"}), "turned");
    EXPECT_EQ(turned.image.image.values[3 * 19], 0.25f);
    EXPECT_EQ(turned.image.image.values[3 * 20], 0.5f);
    const std::string others = WritePair(directory, "d.exr", 0, {"left", "middle", "right"});
    EXPECT_HAS(ErrorOf([&] { ReadComparedFile(others, "x"); }), "its views are left, ");
    EXPECT_HAS(ErrorOf([&] { ReadShownPicture(directory.File("a.exr")); }), "a pair");
}

// Of other programs' layers, as `lull denoise` does.
TEST(ComparedFiles, TakeColoursOfLayers) {
    const TemporaryDirectory directory;
    ExrImage layers;
    layers.width = layers.height = 1;
    for (const char* name : {"Depth.Z", "View.Combined.R", "View.Combined.G", "View.Combined.B"})
        layers.channels.push_back({name, {float(layers.channels.size())}});
    WriteExr(directory.File("a.exr"), layers);
    EXPECT_EQ(ReadComparedFile(directory.File("a.exr"), "x").image.image.values,
              (std::vector<float>{1, 2, 3}));
}

TEST(ComparedFiles, SayWhatDoesNotFit) {
    const TemporaryDirectory directory;
    const ComparedFile wide = ReadComparedFile(WriteDisplay(directory, 7), "automatic"),
                       exr = ReadComparedFile(WriteGrey(directory, "b.exr"), "reference");
    EXPECT_EQ(
        ErrorOf([&] {
            ComparisonOf({wide, exr}, "b.exr", {});
        }),
        "b.exr: images of different sizes: automatic has 7x4 pixels, reference has 6x4 pixels");
    ExrImage grey;
    grey.width = grey.height = 1;
    grey.channels.push_back({"R", {1.f}});
    WriteExr(directory.File("c.exr"), grey);
    EXPECT_HAS(ErrorOf([&] { ReadComparedFile(directory.File("c.exr"), "x"); }),
               "c.exr: it has no channels R, G and B, nor Y; its channels are R");
}

}  // namespace
}  // namespace lull
