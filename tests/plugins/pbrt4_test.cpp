// Compares public scenes for pbrt-v4 with pbrt-v4's own means of blocks, pbrt4.csv, by Z-tests with
// both variances known. tests/measurements/against_pbrt4.py wrote these.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"
#include "tests/shared_folder.h"

namespace lull::pbrt4_test {
namespace {

constexpr int kSide = 48, kAcross = 4;  // pixels, blocks

struct Block {
    Eigen::Array3d mean = Eigen::Array3d::Zero(), variance = Eigen::Array3d::Zero();  // of the mean
};
using Blocks = std::vector<Block>;

// Returns pbrt-v4's blocks by the names of scenes.
std::map<std::string, Blocks> ReadTable(const std::string& path) {
    std::map<std::string, Blocks> table;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::stringstream in(line);
        std::string name;
        int index;
        Block b;
        in >> name >> index >> b.mean[0] >> b.mean[1] >> b.mean[2];
        in >> b.variance[0] >> b.variance[1] >> b.variance[2];
        table[name].push_back(b);
    }
    return table;
}

Blocks BlocksOf(const PixelStatistics& pixels, double scale) {
    constexpr int kPixels = kSide / kAcross;
    constexpr double kShare = 1.0 / (kPixels * kPixels);
    Blocks blocks(kAcross * kAcross);
    for (size_t i = 0; i < pixels.mean.size(); ++i) {
        Block& b = blocks[i / kSide / kPixels * kAcross + i % kSide / kPixels];
        b.mean += pixels.mean[i] * kShare * scale;
        b.variance += pixels.variance[i] * (kShare * kShare * scale * scale / pixels.samples);
    }
    return blocks;
}

// Returns by which part of its mean R, G and B of a block may differ. By spectra, light that
// coloured walls reflect repeatedly is darker than by RGB: at most by so much, as measured, in
// these scenes.
Eigen::Array3d AllowedFor(const std::string& name) {
    if (name == "cornell-box/bitterli") return {0.09, 0.02, 0.22};
    if (name == "shimmer/cornell_sphere") return {0.13, 0.04, 0.02};
    if (name == "staircase2") return {0.02, 0.02, 0.04};
    return Eigen::Array3d::Constant(0.005);
}

TEST(Pbrt4Scenes, HaveTheMeansOfPbrt) {
    LULL_SHARED_FILE(root, "pbrt4-scenes");
    const auto table = ReadTable(fmt::format("{}/pbrt4.csv", LULL_PLUGINS_DIR));
    EXPECT_EQ(table.size(), 10u);
    for (const auto& [name, theirs] : table) {
        std::filesystem::path file = root / name;
        file = is_directory(file) ? file / "scene.pbrt" : file.replace_extension(".pbrt");
        CompileOptions options;
        options.film.resolution = Vec2i(kSide, kSide);
        const auto scene = SceneIn(file.string(), options);
        const PixelStatistics pixels =
            MeasurePixels(*scene, Estimator::Combined, SamplerKind::Random,
                          FromEnvironment("LULL_PLUGIN_SAMPLES", 64), 7);
        const Blocks ours = BlocksOf(pixels, double(scene->film.scale));
        double farthest = 0;  // in standard errors
        Eigen::Array3d mean = Eigen::Array3d::Zero(), theirMean = mean;
        for (size_t i = 0; i < ours.size(); ++i) {
            const Eigen::Array3d beyond =
                (ours[i].mean - theirs[i].mean).abs() - AllowedFor(name) * theirs[i].mean;
            const Eigen::Array3d error = (ours[i].variance + theirs[i].variance + 1e-12).sqrt();
            farthest = std::max(farthest, (beyond / error).maxCoeff());
            mean += ours[i].mean;
            theirMean += theirs[i].mean;
        }
        fmt::print("{:<28} mean {:.4f} of pbrt-v4's, blocks up to {:.1f} standard errors off\n",
                   name, mean.sum() / theirMean.sum(), farthest);
        EXPECT_LT(farthest, 4.5) << name;
        EXPECT_EQ(pixels.rejected, 0) << name;
    }
}

}  // namespace
}  // namespace lull::pbrt4_test
