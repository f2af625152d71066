// Structure that no feature sees. Much of the contrast of wires and of the contact shadow is lost
// without RestoreStructure().
#include <fmt/format.h>

#include "tests/hard_cases/hard_case.h"
#include "tests/renderer/denoise/example_pictures.h"

namespace lull {

namespace structure_cases {
namespace {

constexpr int kPatternWidth = 140, kPatternHeight = 110, kPatternBorder = 10;
constexpr double kPatternLevel = 0.3;

// What is added to a grey wall.
using Pattern = std::function<double(double x, double y)>;

double Soft(double distance, double width) {
    return std::exp(-distance * distance / (2 * width * width));
}

// The distance of a point from the line through (x0, y0) at an angle.
double FromLine(double x, double y, double x0, double y0, double angle) {
    return (y - y0) * std::cos(angle) - (x - x0) * std::sin(angle);
}

// Returns the share of a pattern that the denoised picture has, which is 1 if nothing is lost.
// `noise` is that of a pixel of the mean.
HardCaseResult Left(const Pattern& pattern, double noise, double tolerance,
                    const HardCaseOptions& o) {
    const Planes truth = MakePlanes(kPatternWidth, kPatternHeight, 3, [&](int, int x, int y) {
        return kPatternLevel + pattern(x, y);
    });
    double left = 0;
    const int trials = o.isLong ? 8 : 2;
    for (int trial = 0; trial < trials; ++trial) {
        const Planes picture = Denoise(AddNoise(truth, FlatFeatures(kPatternWidth, kPatternHeight),
                                                noise * std::sqrt(2.0), unsigned(o.seed) + trial))
                                   .picture;
        double both = 0, whole = 0;
        for (int y = kPatternBorder; y < kPatternHeight - kPatternBorder; ++y)
            for (int x = kPatternBorder; x < kPatternWidth - kPatternBorder; ++x) {
                const double p = pattern(x, y);
                both += p * (double(picture.Row(1, y)[x]) - kPatternLevel);
                whole += p * p;
            }
        left += both / whole / trials;
    }
    return {1, left, tolerance, "share of its contrast that is left"};
}

HardCaseResult Wires(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            double wires = 0;
            for (const double angle : {0.15, 0.8, 1.45})
                wires += std::abs(FromLine(x, y, 70, 55, angle)) < 0.7;
            return wires > 0 ? -0.12 : 0;
        },
        0.04, 0.45, o);
}

// Strokes two pixels wide, in boxes of 12 x 16.
HardCaseResult Lettering(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            const int u = int(x) % 16, v = int(y) % 22, letter = (int(x) / 16 + int(y) / 22) % 3;
            if (u > 11 || v > 15) return 0.0;
            const bool isStem = u < 2, isTop = v<2, isMiddle = v> 6 && v<9, isFoot = v> 13;
            const bool isInk = letter == 0   ? isStem || isTop || isMiddle  // F
                               : letter == 1 ? isStem || isFoot             // L
                                             : isTop || (u > 4 && u < 7);   // T
            return isInk ? -0.06 : 0.0;
        },
        0.015, 0.25, o);
}

HardCaseResult ContactShadow(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            const double below = FromLine(x, y, 70, 50, 0.1);
            return below > 0 ? -0.1 * std::exp(-below / 3) : 0;
        },
        0.0375, 0.38, o);
}

HardCaseResult SoftCaustic(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            return 0.12 * Soft(std::hypot(x - 70, y - 20) - 45, 2) +
                   0.12 * Soft(std::hypot(x - 70, y - 95) - 45, 2);
        },
        0.06, 0.2, o);
}

// Window bars, mirrored by a floor, that fade towards the camera.
HardCaseResult Reflection(const HardCaseOptions& o) {
    return Left(
        [](double x, double y) {
            const bool isBar = std::fmod(x + 0.1 * y, 24) < 5;
            return isBar ? -0.07 * (1 - y / 150) : 0;
        },
        0.025, 0.3, o);
}

HardCaseResult BarShadow(const HardCaseOptions& o) {
    return Left([](double x, double y) { return -0.17 * Soft(FromLine(x, y, 70, 55, 0.3), 2.5); },
                0.075, 0.2, o);
}

}  // namespace
}  // namespace structure_cases

std::vector<HardCase> StructureCases() {
    using namespace structure_cases;
    const char* what = "melts away";
    return {
        {"structure", "wires 1 pixel wide, 3 times as strong as the noise", what, Wires},
        {"structure", "lettering, 4 times as strong as the noise", what, Lettering},
        {"structure", "a contact shadow, 2.7 times as strong as the noise", what, ContactShadow},
        {"structure", "soft caustics, twice as strong as the noise", what, SoftCaustic},
        {"structure", "a reflection in a floor, 2.8 times as strong as the noise", what,
         Reflection},
        {"structure", "the shadow of a bar, 2.3 times as strong as the noise", what, BarShadow}};
}

}  // namespace lull
