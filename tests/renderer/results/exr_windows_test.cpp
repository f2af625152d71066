#include "renderer/results/image_files.h"

#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"

namespace lull::exr_windows_test {
namespace {

// An image whose data are 1, 2, ... over 3x2 pixels at `origin` of a picture of 4x3.
ExrImage Numbered(const Vec2i& origin) {
    return {3, 2, origin, {4, 3}, {{"R", {1, 2, 3, 4, 5, 6}}}, {}};
}

std::vector<float> Shown(ExrImage image) {
    MoveTo(ShownWindow(image, "a.exr"), &image);
    EXPECT_EQ(DataWindow(image), (PixelRect{{0, 0}, {4, 3}}));
    return image.channels[0].values;
}

TEST(ExrWindows, AreBlackOutsideTheDataAndCutAtThePicture) {
    using Values = std::vector<float>;
    EXPECT_EQ(Shown(Numbered({1, 0})), (Values{0, 1, 2, 3, 0, 4, 5, 6, 0, 0, 0, 0}));
    EXPECT_EQ(Shown(Numbered({-1, -1})), (Values{5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(Shown(Numbered({3, 2})), (Values{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(Shown(Numbered({9, 0})), Values(12));
    EXPECT_EQ(MovedTo({{1, 0}, {2, 2}}, {{0, 0}, {2, 2}}, 2, {1, 2, 3, 4, 5, 6, 7, 8}),
              (Values{3, 4, 7, 8}));
}

TEST(ExrWindows, AreThePartOfOwnRenders) {
    ExrImage image = Numbered({1, 0});
    image.attributes["criterion"] = std::string("fixed:4");
    EXPECT_EQ(ShownWindow(image, "a.exr"), DataWindow(image));
}

TEST(ExrWindows, AreRefusedBeyondAnyMemory) {
    ExrImage image = Numbered({0, 0});
    image.displaySize = {1 << 30, 1 << 30};
    EXPECT_TRUE(Contains(ErrorOf([&] { ShownWindow(image, "a.exr"); }), "a.exr: its display"));
}

}  // namespace
}  // namespace lull::exr_windows_test
