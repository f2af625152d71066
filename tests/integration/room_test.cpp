// Renders the room of scenes/room.
#include <numeric>

#include "tests/integration/run_lull.h"

namespace lull::room_test {
namespace {

namespace fs = std::filesystem;
const fs::path kRoom = fs::path(LULL_SCENES_DIR) / "room";

// Returns the number behind `label` in what `lull info` prints.
int NumberOf(const std::string& info, const std::string& label) {
    const size_t at = info.find("\n" + label + " ");
    return at == std::string::npos ? -1 : std::stoi(info.substr(at + label.size() + 1));
}

TEST(Room, LoadsWithoutWarnings) {
    const TemporaryDirectory directory;
    for (const char* name : {"room.pbrt", "room-glazed.pbrt", "room-night.pbrt"}) {
        const Outcome outcome = RunLull(directory, "info " + (kRoom / name).string());
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(NumberOf(outcome.out, "warnings"), 0) << outcome.out;
        EXPECT_GT(NumberOf(outcome.out, "triangles"), 100000);
        EXPECT_LT(NumberOf(outcome.out, "triangles"), 400000);
    }
}

// Returns the means of R, G and B of a small image.
std::vector<double> MeanOf(const TemporaryDirectory& directory, const std::string& scene) {
    const Outcome outcome =
        RunLull(directory, "render " + (kRoom / scene).string() +
                               " --resolution 64x36 --spp 128 --quiet -o a.exr");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const ExrImage image = ReadExr(directory.File("a.exr"));
    std::vector<double> means;
    for (const char* channel : {"R", "G", "B"}) {
        const auto& values = image.Find(channel)->values;
        means.push_back(std::accumulate(values.begin(), values.end(), 0.0) / values.size());
    }
    return means;
}

void ExpectNear(const std::vector<double>& means, const std::vector<double>& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(means[c], expected[c], 0.04 * expected[c]);
}

// Seeds differ by about 1 % at 128 spp.
TEST(Room, IsAsBrightAsItWas) {
    const TemporaryDirectory directory;
    ExpectNear(MeanOf(directory, "room.pbrt"), {0.422, 0.377, 0.309});
    ExpectNear(MeanOf(directory, "room-night.pbrt"), {0.278, 0.1766, 0.0926});
}

}  // namespace
}  // namespace lull::room_test
