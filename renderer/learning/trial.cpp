#include "renderer/learning/trial.h"

#include "renderer/base/color.h"
#include "renderer/learning/learner_state.h"
#include "stopping/signals/lightness.h"

namespace lull {

double MeanLuminance(const Film& film) {
    double sum = 0;
    const std::vector<float> means = film.MeanImage();
    for (size_t i = 0; i < means.size(); i += 3)
        sum += double(Luminance(Rgb(means[i], means[i + 1], means[i + 2])));
    return sum / double(std::max<int64_t>(1, film.Region().Area()));
}

namespace {

// Returns the derivative of CIE lightness L* by luminance; 0 beyond white.
double SlopeUpToWhite(double y) { return y > 1 ? 0 : LightnessAt(y).slope; }

// Returns the mean luminance of each tile.
std::vector<double> LuminanceOf(const Film& film) {
    std::vector<double> luminance(film.TileCount()), pixels(luminance.size());
    const PixelRect& region = film.Region();
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x) {
            const size_t tile = film.TileAt({x, y});
            luminance[tile] += double(Luminance(film.At({x, y}).Mean()));
            ++pixels[tile];
        }
    for (size_t i = 0; i < luminance.size(); ++i) luminance[i] /= std::max(1., pixels[i]);
    return luminance;
}

// Compares the noise of tiles. The error of a ratio of means is to first order (Cochran 1977, eq.
// 2.39).
struct NoiseRatio {
    double ratio = 1, error = 0;  // of noise
    int tiles = 0;                // that have both
};

NoiseRatio RatioOf(std::span<const TileNoise> noise) {
    NoiseRatio r;
    double unguided = 0, guided = 0;
    for (const TileNoise& tile : noise) {
        r.tiles += tile.unguided > 0 || tile.guided > 0;
        unguided += double(tile.unguided);
        guided += double(tile.guided);
    }
    if (r.tiles < 2 || !(unguided > 0)) return r;
    r.ratio = guided / unguided;
    double squares = 0;
    for (const TileNoise& tile : noise)
        squares += Sqr(double(tile.guided) - r.ratio * double(tile.unguided));
    r.error = std::sqrt(squares * r.tiles / (r.tiles - 1)) / unguided;
    return r;
}

}  // namespace

std::vector<TileNoise> GuideTally::Noise(const Film& film) const {
    std::vector<TileNoise> noise(std::min(unguided.size(), guided.size()));
    const std::vector<double> luminance = LuminanceOf(film);
    for (size_t i = 0; i < noise.size(); ++i) {
        const SampleSpread &a = unguided[i], &b = guided[i];
        if (a.freedom <= 0 || b.freedom <= 0) continue;
        const double slope = SlopeUpToWhite(luminance[i]);
        const TileNoise both{float(slope * std::sqrt(a.squares / double(a.freedom))),
                             float(slope * std::sqrt(b.squares / double(b.freedom)))};
        if (both.unguided + both.guided < kInfinity) noise[i] = both;
    }
    return noise;
}

GuideComparison GuideTally::Compare(std::span<const TileNoise> noise) const {
    double unguidedVertices = 0, guidedVertices = 0;
    for (size_t i = 0; i < unguided.size() && i < guided.size(); ++i) {
        const SampleSpread &a = unguided[i], &b = guided[i];
        if (a.freedom <= 0 || b.freedom <= 0) continue;
        unguidedVertices += double(a.vertices) / double(a.samples);
        guidedVertices += double(b.vertices) / double(b.samples);
    }
    GuideComparison comparison;
    if (unguidedVertices > 0) comparison.vertices = guidedVertices / unguidedVertices;
    const NoiseRatio r = RatioOf(noise);
    comparison.variance = Sqr(r.ratio);
    comparison.error = 2 * r.ratio * r.error;
    return comparison;
}

double VarianceOf(std::span<const TileNoise> noise, const Film& film, const PixelRect& part) {
    std::vector<char> isIn(noise.size());
    for (int y = part.min.y(); y < part.max.y(); ++y)
        for (int x = part.min.x(); x < part.max.x(); ++x)
            if (const size_t tile = film.TileAt({x, y}); tile < isIn.size()) isIn[tile] = 1;
    std::vector<TileNoise> of;
    for (size_t i = 0; i < noise.size(); ++i)
        if (isIn[i]) of.push_back(noise[i]);
    const NoiseRatio r = RatioOf(of);
    if (r.tiles < kTilesEnough) return 1;
    return std::clamp(Sqr(r.ratio) + 2 * r.ratio * r.error, 1e-3, 1.);
}

void Trial::Begin(const Film& film) {
    tally.unguided = tally.guided = std::vector<SampleSpread>(film.TileCount());
}

Verdict Trial::Decide(const Film& film, double perSample, double perVertex) {
    std::vector<TileNoise> tiles = tally.Noise(film);
    const GuideComparison c = comparison = tally.Compare(tiles);
    const double work = perVertex > 0 ? c.vertices * perVertex : perSample;
    if ((c.variance + 2 * c.error) * work < 1) {
        noise = std::move(tiles);
        End();
        return Verdict::Pays;
    }
    tally.guided.assign(tally.guided.size(), {});
    return (c.variance - 2 * c.error) * work > 1 ? Verdict::DoesNotPay : Verdict::Open;
}

void Trial::Put(StateWriter* writer) const {
    writer->PutVector(tally.unguided);
    writer->PutVector(tally.guided);
    writer->PutVector(noise);
    writer->Put(comparison);
}

void Trial::Get(StateReader* reader, bool isUnderWay, bool pays, size_t tiles, const char* damaged,
                const char* foreign) {
    tally.unguided = reader->GetVector<SampleSpread>(damaged);
    tally.guided = reader->GetVector<SampleSpread>(damaged);
    noise = reader->GetVector<TileNoise>(damaged);
    comparison = reader->Get<GuideComparison>();
    for (const TileNoise& tile : noise)
        Require(tile.unguided >= 0 && tile.guided >= 0 && tile.unguided + tile.guided < kInfinity,
                damaged);
    const size_t compared = isUnderWay ? tiles : 0;
    Require(tally.unguided.size() == compared && tally.guided.size() == compared &&
                noise.size() == (pays ? tiles : 0),
            foreign);
}

}  // namespace lull
