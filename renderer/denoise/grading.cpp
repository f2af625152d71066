#include "renderer/denoise/grading.h"

#include "stopping/base/parallel.h"

namespace lull {

namespace {

// Relative, and absolute for black.
constexpr float kStep = 0.05f, kLeastStep = 1e-4f;

// Copies a row of an image to R, G, B of each pixel, or back.
void CopyRow(const Planes& image, int y, std::span<float> rgb) {
    for (int c = 0; c < kColours; ++c)
        for (int x = 0; x < image.width; ++x) rgb[size_t(kColours * x + c)] = image.Row(c, y)[x];
}

void CopyRow(std::span<const float> rgb, int y, Planes* image) {
    for (int c = 0; c < kColours; ++c)
        for (int x = 0; x < image->width; ++x)
            image->Row(c, y)[x] = Sane(rgb[size_t(kColours * x + c)]);
}

// A row of a picture as it is shown, and the derivative of its values.
struct GradedRow {
    std::vector<float> shown, slope;
};

GradedRow GradeRow(std::span<const float> rgb, const Grading& grading) {
    GradedRow row{{rgb.begin(), rgb.end()}, {rgb.begin(), rgb.end()}};
    for (float& v : row.slope) v += kStep * v + kLeastStep;
    grading(row.shown);
    grading(row.slope);
    for (size_t i = 0; i < rgb.size(); ++i) {
        const float step = kStep * rgb[i] + kLeastStep;
        row.slope[i] = Sane((row.slope[i] - row.shown[i]) / step);
    }
    return row;
}

}  // namespace

DenoisedPicture Graded(const DenoisedPicture& linear, const Grading& grading) {
    DenoisedPicture shown = linear;
    if (!grading) return shown;
    const int width = linear.picture.width;
    ForEachIndex(linear.picture.height, [&](int y) {
        std::vector<float> rgb(size_t(kColours * width));
        CopyRow(linear.picture, y, rgb);
        const GradedRow row = GradeRow(rgb, grading);
        CopyRow(row.shown, y, &shown.picture);
        const auto scaled = [&](const Planes& image, int c, int x) {
            const size_t i = size_t(kColours * x + c);
            return Sane(row.shown[i] + row.slope[i] * (image.Row(c, y)[x] - rgb[i]));
        };
        for (int x = 0; x < width; ++x) {
            Rgb slope;
            for (int c = 0; c < kColours; ++c) {
                slope[c] = row.slope[size_t(kColours * x + c)];
                shown.halves.a.Row(c, y)[x] = scaled(linear.halves.a, c, x);
                shown.halves.b.Row(c, y)[x] = scaled(linear.halves.b, c, x);
                shown.noisy.a.Row(c, y)[x] = scaled(linear.noisy.a, c, x);
                shown.noisy.b.Row(c, y)[x] = scaled(linear.noisy.b, c, x);
                shown.variance.Row(c, y)[x] = Sane(Sqr(slope[c]) * linear.variance.Row(c, y)[x]);
            }
            shown.returned.Row(0, y)[x] = Sane(Luminance(slope) * linear.returned.Row(0, y)[x]);
        }
    });
    return shown;
}

}  // namespace lull
