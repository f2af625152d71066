#include "renderer/output/film.h"

namespace lull {

namespace {

Rgb Divide(const std::array<double, 3>& sum, uint32_t count) {
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

void Store(const Rgb& c, float* to) {
    for (int i = 0; i < 3; ++i) to[i] = c[i];
}

}  // namespace

uint32_t HalfCount(uint32_t count) {
    // Two of every four; of what is left over, the first or the second pair.
    const uint32_t whole = count & ~3u, rest = count & 3u;
    const uint32_t inFirstPair = std::min(rest, 2u);
    return whole / 2 + (InHalf(whole) ? inFirstPair : rest - inFirstPair);
}

Rgb FilmPixel::Mean() const { return count > 0 ? Divide(sum, count) : Rgb(0, 0, 0); }

Rgb FilmPixel::HalfMean() const {
    const uint32_t half = HalfCount(count);
    return half > 0 ? Divide(halfSum, half) : Mean();
}

void Film::Extract(const PixelRect& rect, bool withHalf, FilmView* view) const {
    view->width = rect.Width();
    view->height = rect.Height();
    view->mean.resize(size_t(rect.Area()) * 3);
    view->halfMean.resize(withHalf ? size_t(rect.Area()) * 3 : 0);
    size_t at = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x, at += 3) {
            const FilmPixel& p = At({x, y});
            Store(p.Mean(), &view->mean[at]);
            if (withHalf) Store(p.HalfMean(), &view->halfMean[at]);
        }
}

std::vector<float> Film::MeanImage() const {
    std::vector<float> image(pixels.size() * 3);
    for (size_t i = 0; i < pixels.size(); ++i) Store(pixels[i].Mean(), &image[3 * i]);
    return image;
}

std::vector<float> Film::SppImage() const {
    std::vector<float> image(pixels.size());
    for (size_t i = 0; i < pixels.size(); ++i) image[i] = float(pixels[i].count);
    return image;
}

int64_t Film::SampleCount() const {
    int64_t n = 0;
    for (const FilmPixel& p : pixels) n += p.count;
    return n;
}

int64_t Film::RejectedCount() const {
    int64_t n = 0;
    for (const FilmPixel& p : pixels) n += p.rejected;
    return n;
}

}  // namespace lull
