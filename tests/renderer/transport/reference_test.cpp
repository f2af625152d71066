// Compares renders of the real scenes with pbrt-v3's own: means by Z-tests with both variances
// known, and the variance of one sample, which is what human thresholds transfer by.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"
#include "tests/shared_folder.h"

namespace lull {
namespace {

// Returns the two-sided normal quantile z that `tests` independent tests exceed with probability
// 1 % in all (Sidak), by bisection on erfc.
double SidakQuantile(double tests) {
    const double alpha = -std::expm1(std::log1p(-0.01) / tests);
    double low = 0, high = 40;
    for (int i = 0; i < 200; ++i)
        (std::erfc((low + high) / 2 / std::sqrt(2.0)) > alpha ? low : high) = (low + high) / 2;
    return high;
}

struct Comparison {
    double energyRatio, energySigma;           // ours over pbrt-v3's; distance in standard errors
    double pixelsOut, tilesOut;                // shares beyond the Sidak quantile
    double varianceMedian;                     // over tiles, of ours over pbrt-v3's
    double varianceTotal, varianceTotalSigma;  // ratio of sums; its rough standard error
};

double Median(std::vector<double> values) {
    if (values.empty()) return 1;
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

Comparison Compare(const PixelStatistics& ours, const PixelStatistics& theirs) {
    constexpr int kTile = 8;
    const double n = ours.samples, m = theirs.samples;
    const size_t count = ours.mean.size();
    const double perMean = 1 / n + 1 / m;
    // Pool both estimates of the variance: either alone misses rare bright samples.
    const auto pooled = [&](size_t i) -> Eigen::Array3d {
        return ((n - 1) * ours.variance[i] + (m - 1) * theirs.variance[i]) / (n + m - 2);
    };

    Comparison result{};
    double sumOurs = 0, sumTheirs = 0, sumVariance = 0;
    double varianceOurs = 0, varianceTheirs = 0, squaresOurs = 0, squaresTheirs = 0;
    const double zPixel = SidakQuantile(3.0 * count);
    size_t out = 0;
    for (size_t i = 0; i < count; ++i) {
        const Eigen::Array3d variance = pooled(i) * perMean;
        const Eigen::Array3d difference = ours.mean[i] - theirs.mean[i];
        bool isOut = false;
        for (int c = 0; c < 3; ++c) {
            // Half of a 16-bit float's last place is what the reference itself may be off by.
            const double rounding = std::abs(theirs.mean[i][c]) * 0x1p-11;
            isOut |= std::abs(difference[c]) > zPixel * std::sqrt(variance[c]) + rounding + 1e-7;
        }
        out += isOut;
        sumOurs += ours.mean[i].sum();
        sumTheirs += theirs.mean[i].sum();
        sumVariance += 3 * variance.sum();  // channels are nearly fully correlated
        const double vo = ours.variance[i].sum(), vt = theirs.variance[i].sum();
        varianceOurs += vo;
        varianceTheirs += vt;
        squaresOurs += vo * vo;
        squaresTheirs += vt * vt;
    }
    result.energyRatio = sumOurs / sumTheirs;
    result.energySigma = (sumOurs - sumTheirs) / std::sqrt(sumVariance);
    result.pixelsOut = double(out) / count;
    result.varianceTotal = varianceOurs / varianceTheirs;
    // A few pixels carry most of a heavy-tailed total; their number bounds its precision.
    result.varianceTotalSigma =
        result.varianceTotal * std::sqrt(squaresOurs / (varianceOurs * varianceOurs) +
                                         squaresTheirs / (varianceTheirs * varianceTheirs));

    const int across = ours.width / kTile, down = ours.height / kTile;
    const double zTile = SidakQuantile(3.0 * across * down);
    size_t tilesOut = 0;
    std::vector<double> ratios;
    for (int ty = 0; ty < down; ++ty)
        for (int tx = 0; tx < across; ++tx) {
            Eigen::Array3d difference = Eigen::Array3d::Zero(), variance = difference;
            double vo = 0, vt = 0;
            for (int y = 0; y < kTile; ++y)
                for (int x = 0; x < kTile; ++x) {
                    const size_t i = size_t(ty * kTile + y) * ours.width + tx * kTile + x;
                    difference += ours.mean[i] - theirs.mean[i];
                    variance += pooled(i) * perMean;
                    vo += ours.variance[i].sum();
                    vt += theirs.variance[i].sum();
                }
            if (vt > 1e-9) ratios.push_back(vo / vt);
            tilesOut += ((difference.abs() > zTile * variance.sqrt() + 1e-6).any());
        }
    result.tilesOut = double(tilesOut) / (across * down);
    result.varianceMedian = Median(ratios);
    return result;
}

// Returns whether pbrt-v3's texture filtering shows at 128x128: it looks up small images of bump
// maps and textures from the camera, which smooths them. Bump maps of contemporary-bathroom also
// send mirrored light below the surface, which pbrt-v3 loses.
//   staircase               nine imagemaps, a bump map
//   contemporary-bathroom   eight imagemaps, three float ones, a bump map
//   crown                   bump maps of most of the gold
bool ShowsTextureFiltering(const std::string& name) {
    return name == "staircase" || name == "contemporary-bathroom" || name == "crown";
}

class ReferenceTest : public testing::TestWithParam<std::tuple<const char*, Estimator>> {};

TEST_P(ReferenceTest, MeanAndVarianceArePbrtV3s) {
    const std::string name = std::get<0>(GetParam());
    const Estimator estimator = std::get<1>(GetParam());
    LULL_SHARED_FILE(file, "references/" + name + ".exr");
    CompileOptions options;
    options.lightsAsPbrtV3 = estimator == Estimator::PbrtV3;
    options.film.resolution = Vec2i(128, 128);
    const auto scene =
        SceneIn((SharedFolder() / "pbrt-scenes" / name / "scene.pbrt").string(), options);
    const PixelStatistics reference = ReadStatistics(file.string());
    const int samples = FromEnvironment("LULL_REFERENCE_SPP", 64);

    const PixelStatistics ours = MeasurePixels(*scene, estimator, SamplerKind::Random, samples, 1);
    EXPECT_EQ(ours.rejected, 0);
    const Comparison c = Compare(ours, reference);
    std::printf(
        "%s", fmt::format("| {} | {} | {:.4f} ({:+.1f}) | {:.2f} % | {:.2f} % | {:.3f} | "
                          "{:.3f} +- {:.3f} |\n",
                          name, samples, c.energyRatio, c.energySigma, 100 * c.pixelsOut,
                          100 * c.tilesOut, c.varianceMedian, c.varianceTotal, c.varianceTotalSigma)
                  .c_str());
    // The energy has to agree to 0.5 %, or as well as so many samples can tell.
    const bool isFiltered = ShowsTextureFiltering(name);
    EXPECT_TRUE(std::abs(c.energyRatio - 1) < (isFiltered ? 0.012 : 0.005) ||
                std::abs(c.energySigma) < 3)
        << "energy ratio " << c.energyRatio;
    EXPECT_LE(c.pixelsOut, isFiltered ? 0.04 : 0.01);
    EXPECT_LE(c.tilesOut, isFiltered ? 0.07 : 0.01);
    // Few samples miss the rare bright ones that carry much of the variance, so with fewer than the
    // reference has it can seem too small, but not too large.
    EXPECT_LT(c.varianceMedian, 1.05);
    EXPECT_LT(c.varianceTotal, 1 + 4 * c.varianceTotalSigma);
    if (estimator == Estimator::PbrtV3 && samples >= reference.samples) {
        EXPECT_GT(c.varianceMedian, 0.95);
        EXPECT_GT(c.varianceTotal, 1 - 4 * c.varianceTotalSigma);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, ReferenceTest,
    testing::Combine(testing::Values("cornell-box", "veach-mis", "veach-bidir", "killeroo-simple",
                                     "staircase2", "veach-ajar", "staircase", "caustic-glass",
                                     "matpreview", "breakfast", "bathroom", "coffee-splash",
                                     "contemporary-bathroom", "dining-room", "crown", "classroom",
                                     "living-room"),
                     testing::Values(Estimator::PbrtV3, Estimator::Combined)),
    [](const auto& info) {
        std::string name = std::get<0>(info.param);
        std::replace(name.begin(), name.end(), '-', '_');
        return name + (std::get<1>(info.param) == Estimator::Combined ? "_combined" : "_pbrt_v3");
    });

}  // namespace
}  // namespace lull
