#include "renderer/render/guide_trial.h"

#include "renderer/base/color.h"

namespace lull {

namespace {

constexpr int kPiece = 8;                    // pixels a side
constexpr int64_t kSamplesWanted = 1 << 18;  // of each kind

// Sums up the samples of a pixel.
struct PixelSums {
    double sum = 0, squares = 0;  // of luminance
    int64_t vertices = 0;
};

struct Arm {
    std::vector<PixelSums> pixels;  // row by row
    int64_t Vertices() const {
        int64_t sum = 0;
        for (const PixelSums& pixel : pixels) sum += pixel.vertices;
        return sum;
    }
};

// Each pixel is one thread's at a time, and its samples come in the order of their indices.
std::optional<Arm> TakeSamples(const Scene& scene, const PixelRect& region, const Guide& guide,
                               const RenderOptions& options) {
    Arm arm{std::vector<PixelSums>(size_t(region.Area()))};
    const SampleSource source = [&](Sampler& sampler, const Vec2i& p, uint32_t index) {
        const PathSample sample = RenderSample(scene, guide, sampler, p, index);
        PixelSums& pixel = arm.pixels[size_t(p.y() - region.min.y()) * size_t(region.Width()) +
                                      size_t(p.x() - region.min.x())];
        const double y = double(Luminance(sample.radiance));
        pixel.sum += y;
        pixel.squares += y * y;
        pixel.vertices += sample.vertices;
        return sample;
    };
    Film film(region, {.grid = GridOf(options.schedule)});
    if (Render(source, options, &film).cancelled) return {};
    return arm;
}

// Sums up a piece of the image.
struct PieceSums {
    double luminance = 0, variance = 0;
};

PieceSums SumsOf(const Arm& arm, const PixelRect& region, const PixelRect& piece, int n) {
    PieceSums sums;
    for (int y = piece.min.y(); y < piece.max.y(); ++y)
        for (int x = piece.min.x(); x < piece.max.x(); ++x) {
            const PixelSums& pixel = arm.pixels[size_t(y) * size_t(region.Width()) + size_t(x)];
            sums.luminance += pixel.sum / n;
            sums.variance += std::max(0., pixel.squares - pixel.sum * pixel.sum / n) / (n - 1);
        }
    return sums;
}

// Returns the derivative of CIE lightness L* by luminance; 0 beyond white.
double SlopeUpToWhite(double y) {
    constexpr double kLinear = 0.008856, kSlope = 903.3;
    return y > 1 ? 0 : y > kLinear ? 116. / 3 * std::pow(y, -2. / 3) : kSlope;
}

}  // namespace

std::optional<GuideTrial> TryGuide(const Scene& scene, const PixelRect& region, const Guide& guide,
                                   const RenderOptions& options) {
    const int n =
        int(std::clamp<int64_t>(kSamplesWanted / std::max<int64_t>(1, region.Area()), 4, 8));
    RenderOptions render = options;
    render.schedule.cap = render.schedule.passLength = n;
    // With nothing to say, a guide leaves all samples what they are.
    const auto unguided = TakeSamples(scene, region, Guide(scene.shapes.bounds, 0, 1), render);
    if (!unguided) return {};
    const auto guided = TakeSamples(scene, region, guide, render);
    if (!guided) return {};

    struct Noise {
        double unguided, guided;
    };
    std::vector<Noise> noise;
    for (int y = 0; y < region.Height(); y += kPiece)
        for (int x = 0; x < region.Width(); x += kPiece) {
            const PixelRect piece{
                {x, y},
                {std::min(x + kPiece, region.Width()), std::min(y + kPiece, region.Height())}};
            const PieceSums a = SumsOf(*unguided, region, piece, n);
            const PieceSums b = SumsOf(*guided, region, piece, n);
            const double area = double(piece.Area());
            const double slope = SlopeUpToWhite((a.luminance + b.luminance) / 2 / area);
            const Noise both{slope * std::sqrt(a.variance / area),
                             slope * std::sqrt(b.variance / area)};
            if (both.unguided + both.guided < INFINITY) noise.push_back(both);
        }
    GuideTrial trial{.samples = 2 * n};
    if (unguided->Vertices() > 0)
        trial.vertices = double(guided->Vertices()) / double(unguided->Vertices());
    Noise sum{0, 0};
    for (const Noise& piece : noise) {
        sum.unguided += piece.unguided;
        sum.guided += piece.guided;
    }
    if (noise.size() < 2 || !(sum.unguided > 0)) return trial;
    // The error of a ratio of means, to first order (Cochran 1977, eq. 2.39).
    const double ratio = sum.guided / sum.unguided, count = double(noise.size());
    double squares = 0;
    for (const Noise& piece : noise) squares += Sqr(piece.guided - ratio * piece.unguided);
    trial.variance = ratio * ratio;
    trial.error = 2 * ratio * std::sqrt(squares * count / (count - 1)) / sum.unguided;
    return trial;
}

}  // namespace lull
