// Compares renders of small scenes, which show one plug-in each, with pbrt-v3's own (make.py):
// energy, tiles and pixels by Z-tests with both variances known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull {
namespace {

namespace fs = std::filesystem;

struct Comparison {
    double energyRatio = 0, energySigma = 0;  // ours over pbrt-v3's; distance in standard errors
    double pixelsOut = 0, tilesOut = 0;       // shares beyond 4.5 standard errors
};

Comparison Compare(const PixelStatistics& ours, const PixelStatistics& theirs) {
    constexpr int kTile = 4;
    constexpr double kFar = 4.5;
    const double perMean = 1.0 / ours.samples + 1.0 / theirs.samples;
    const int across = ours.width / kTile;
    std::vector<double> tileDifference(size_t(across) * (ours.height / kTile));
    std::vector<double> tileVariance(tileDifference.size()), tileRounding(tileDifference.size());
    Comparison result;
    double sumOurs = 0, sumTheirs = 0, sumVariance = 0;
    for (size_t i = 0; i < ours.mean.size(); ++i) {
        // Pool both estimates of the variance: either alone misses rare bright samples.
        const double n = ours.samples, m = theirs.samples;
        const Eigen::Array3d pooled =
            ((n - 1) * ours.variance[i] + (m - 1) * theirs.variance[i]) / (n + m - 2) * perMean;
        // Half of a 16-bit float's last place is what the reference itself may be off by.
        const Eigen::Array3d rounding = theirs.mean[i].abs() * 0x1p-11 + 1e-6;
        const Eigen::Array3d difference = (ours.mean[i] - theirs.mean[i]).abs();
        result.pixelsOut += (difference > kFar * pooled.sqrt() + rounding).any();
        const size_t tile = (i / ours.width) / kTile * across + (i % size_t(ours.width)) / kTile;
        tileDifference[tile] += (ours.mean[i] - theirs.mean[i]).sum();
        tileVariance[tile] += 3 * pooled.sum();  // the channels are nearly fully correlated
        tileRounding[tile] += rounding.sum();    // that of a constant colour adds up
        sumOurs += ours.mean[i].sum();
        sumTheirs += theirs.mean[i].sum();
        sumVariance += 3 * pooled.sum();
    }
    for (size_t k = 0; k < tileVariance.size(); ++k)
        result.tilesOut +=
            std::abs(tileDifference[k]) > kFar * std::sqrt(tileVariance[k]) + tileRounding[k];
    result.pixelsOut /= double(ours.mean.size());
    result.tilesOut /= double(tileVariance.size());
    result.energyRatio = sumOurs / sumTheirs;
    result.energySigma = (sumOurs - sumTheirs) / std::sqrt(sumVariance);
    return result;
}

class Plugins : public testing::TestWithParam<std::string> {};

TEST_P(Plugins, LookAsInPbrt) {
    const auto scene = SceneIn(fmt::format("{}/scenes/{}.pbrt", LULL_PLUGINS_DIR, GetParam()));
    const PixelStatistics theirs =
        ReadStatistics(fmt::format("{}/references/{}.exr", LULL_PLUGINS_DIR, GetParam()));
    const int samples = FromEnvironment("LULL_PLUGIN_SAMPLES", 256);
    for (const Estimator estimator : {Estimator::PbrtV3, Estimator::Combined}) {
        const PixelStatistics ours =
            MeasurePixels(*scene, estimator, SamplerKind::Random, samples, 7);
        const Comparison c = Compare(ours, theirs);
        const std::string line = fmt::format(
            "{:<24} {:<8} energy {:.4f} ({:+.1f} sigma), pixels out {:.2f} %, tiles out {:.2f} %",
            GetParam(), estimator == Estimator::PbrtV3 ? "pbrt-v3" : "combined", c.energyRatio,
            c.energySigma, 100 * c.pixelsOut, 100 * c.tilesOut);
        fmt::print("{}\n", line);
        EXPECT_TRUE(std::abs(c.energyRatio - 1) < 0.002 || std::abs(c.energySigma) < 3.5) << line;
        EXPECT_LE(c.pixelsOut, 0.01) << line;  // single samples have tails that the normal has not
        EXPECT_EQ(c.tilesOut, 0) << line;
        EXPECT_EQ(ours.rejected, 0);
    }
}

std::vector<std::string> SceneNames() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(fs::path(LULL_PLUGINS_DIR) / "references"))
        if (entry.path().extension() == ".exr") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

INSTANTIATE_TEST_SUITE_P(All, Plugins, testing::ValuesIn(SceneNames()), [](const auto& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace lull
