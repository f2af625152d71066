#include "renderer/lab/metrics/seams.h"

#include <limits>

namespace lull {

namespace {

constexpr int kDepth = 10, kLength = 20;

double RootMeanSquare(std::span<const float> noise, int width, const PixelRect& rect) {
    double sum = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x)
            sum += Sqr(double(noise[size_t(y) * width + x]));
    return std::sqrt(sum / double(rect.Area()));
}

// Averages jumps.
struct Jumps {
    std::span<const float> noise;
    int width;
    double sum = 0;
    int count = 0;

    // Adds the jumps across x = `line` between the rows `begin` and `end`, or with `upright` false
    // across y = `line` between those columns.
    void Add(bool upright, int line, int begin, int end) {
        for (int at = begin; at + kLength <= end; at += kLength) {
            const auto level = [&](int from, int to) {
                const PixelRect rect = upright ? PixelRect{{from, at}, {to, at + kLength}}
                                               : PixelRect{{at, from}, {at + kLength, to}};
                return RootMeanSquare(noise, width, rect);
            };
            sum += std::abs(level(line - kDepth, line) - level(line, line + kDepth));
            ++count;
        }
    }
    double Mean() const { return count > 0 ? sum / count : 0; }
};

// Adds the border between two blocks of which the second is to the right of the first or below.
void AddBorder(const PixelRect& a, const PixelRect& b, Jumps* jumps) {
    const auto deepEnough = [](int sideA, int sideB) { return std::min(sideA, sideB) >= kDepth; };
    if (a.max.x() == b.min.x() && a.min.y() == b.min.y() && deepEnough(a.Width(), b.Width()))
        jumps->Add(true, b.min.x(), a.min.y(), a.max.y());
    if (a.max.y() == b.min.y() && a.min.x() == b.min.x() && deepEnough(a.Height(), b.Height()))
        jumps->Add(false, b.min.y(), a.min.x(), a.max.x());
}

}  // namespace

double Seams::Ratio() const {
    return border > 0 && inside > 0 ? border / inside : std::numeric_limits<double>::quiet_NaN();
}

Seams MeasureSeams(std::span<const float> noise, int width, std::span<const PixelRect> blocks) {
    Jumps border{noise, width}, inside{noise, width};
    for (const PixelRect& a : blocks) {
        for (const PixelRect& b : blocks) AddBorder(a, b, &border);
        if (a.Width() >= 2 * kDepth)
            inside.Add(true, (a.min.x() + a.max.x()) / 2, a.min.y(), a.max.y());
        if (a.Height() >= 2 * kDepth)
            inside.Add(false, (a.min.y() + a.max.y()) / 2, a.min.x(), a.max.x());
    }
    return {border.Mean(), inside.Mean()};
}

}  // namespace lull
