#include "renderer/denoise/denoise.h"

#include <cmath>

namespace lull {

namespace {

constexpr float kFireflyLimit = 4;  // standard deviations
constexpr float kLeastLuminance = 1e-3f;
constexpr int kNoiseRadius = 10;                  // pixels over which halves say how large noise is
constexpr int kVarianceReach = kNoiseRadius + 1;  // pixels, from which a variance depends on others
constexpr float kLeastVariance = 1e-10f;
// Lamps are small where this share of the pixels within the radius shows them.
constexpr int kLampRadius = 3;
constexpr float kMostOfLamps = 0.3f;
constexpr float kGlint = 4;  // times the brightest neighbour

// Writes nothing where nothing changes, which would take memory.
void MakeSane(Halves* halves) {
    for (Planes* half : {&halves->a, &halves->b})
        for (float& v : half->values)
            if (const float sane = Sane(v); !(v == sane) || std::signbit(v)) v = sane;
}

Planes Channel(const Planes& image, int c) {
    Planes channel(image.width, image.height, 1);
    std::copy_n(image.Plane(c), image.Area(), channel.values.begin());
    return channel;
}

// Scales a channel of the variance to the difference of the halves in the pixels around, since
// stratified samples have less noise than their squares suggest.
void ScaleVariance(const Halves& colour, int c, Planes* variance) {
    const Planes said = BoxMean(Channel(*variance, c), kNoiseRadius);
    const Planes seen =
        BoxMean(VarianceOf(Channel(colour.a, c), Channel(colour.b, c)), kNoiseRadius);
    for (size_t i = 0; i < variance->Area(); ++i)
        variance->Plane(c)[i] *=
            std::clamp(seen.values[i] / std::max(said.values[i], 1e-12f), 0.2f, 5.f);
}

Planes WithLeast(Planes variance) {
    for (float& v : variance.values) v = std::max(v, kLeastVariance);
    return variance;
}

// Keeps the emission of lamps of few pixels: edges of others are filtered like all edges.
void KeepSmallLamps(Halves* emission) {
    Planes lit(emission->a.width, emission->a.height, 1);
    for (size_t i = 0; i < lit.Area(); ++i)
        lit.values[i] = LuminanceOf(emission->a, i) + LuminanceOf(emission->b, i) > 0;
    lit = BoxMean(std::move(lit), kLampRadius);
    for (size_t i = 0; i < lit.Area(); ++i)
        for (int c = 0; c < kColours && lit.values[i] > kMostOfLamps; ++c)
            for (Planes* half : {&emission->a, &emission->b})
                if (half->Plane(c)[i] != 0) half->Plane(c)[i] = 0;
}

// Lowers the variance of the mean, where it is known, to the variance of the rest of a pixel.
void ForgetVariance(const Halves& rest, size_t pixel, Planes* ofMean) {
    if (ofMean->count == 0) return;
    const float difference = LuminanceOf(rest.a, pixel) - LuminanceOf(rest.b, pixel);
    ofMean->values[pixel] = std::min(ofMean->values[pixel], Sqr(difference) / 4);
}

void TakeEmission(NoisyPicture* picture) {
    Halves &colour = picture->colour, &emission = picture->emission;
    MakeSane(&emission);
    KeepSmallLamps(&emission);
    const auto subtract = [](const Planes& from, Planes* half) {
        for (size_t i = 0; i < from.values.size(); ++i) half->values[i] -= from.values[i];
    };
    subtract(emission.a, &colour.a);
    subtract(emission.b, &colour.b);
    for (size_t i = 0; i < picture->variance.values.size(); ++i) {
        if (!(LuminanceOf(emission.a, i) + LuminanceOf(emission.b, i) > 0)) continue;
        ForgetVariance(colour, i, &picture->variance);
    }
}

float BrightestBeside(const Halves& colour, int x, int y) {
    const int width = colour.a.width, height = colour.a.height;
    float most = 0;
    for (int v = std::max(0, y - 1); v < std::min(height, y + 2); ++v)
        for (int u = std::max(0, x - 1); u < std::min(width, x + 2); ++u) {
            if (u == x && v == y) continue;
            const size_t i = size_t(v) * size_t(width) + size_t(u);
            most = std::max({most, LuminanceOf(colour.a, i), LuminanceOf(colour.b, i)});
        }
    return most;
}

// Moves what single pixels have above their neighbours in both halves to the emission, which is not
// filtered: no other patch resembles those with such a pixel, which would stay noisy.
void TakeGlints(NoisyPicture* picture) {
    Halves& colour = picture->colour;
    const int width = colour.a.width, height = colour.a.height;
    std::vector<std::pair<size_t, float>> glints;  // and their brightest neighbours
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const size_t i = size_t(y) * size_t(width) + size_t(x), beside = x > 0 ? i - 1 : i + 1;
            const float least = std::min(LuminanceOf(colour.a, i), LuminanceOf(colour.b, i));
            if (width < 2 || !(least > kGlint * LuminanceOf(colour.a, beside))) continue;
            const float most = BrightestBeside(colour, x, y);
            if (least > kGlint * most) glints.emplace_back(i, most);
        }
    if (glints.empty()) return;
    if (picture->emission.a.count == 0)
        picture->emission = {Planes(width, height, kColours), Planes(width, height, kColours)};
    for (const auto& [i, most] : glints) {
        const auto take = [&](Planes* from, Planes* to) {
            const float above = 1 - most / LuminanceOf(*from, i);
            for (int c = 0; c < kColours; ++c) {
                const float taken = from->Plane(c)[i] * above;
                from->Plane(c)[i] -= taken;
                to->Plane(c)[i] += taken;
            }
        };
        take(&colour.a, &picture->emission.a);
        take(&colour.b, &picture->emission.b);
        ForgetVariance(colour, i, &picture->variance);
    }
}

// By the samples' squares of luminance, shared out by colour, and scaled.
Planes VarianceIn(const Halves& colour, const Planes& ofMean) {
    if (ofMean.count == 0) return WithLeast(BoxMean(BoxMean(VarianceOf(colour.a, colour.b), 1), 1));
    Planes variance(ofMean.width, ofMean.height, kColours);
    for (size_t i = 0; i < variance.Area(); ++i) {
        Rgb mean;
        for (int c = 0; c < kColours; ++c)
            mean[c] = std::max(kLeastLuminance, (colour.a.Plane(c)[i] + colour.b.Plane(c)[i]) / 2);
        const float y = Luminance(mean);
        const float relative = 2 * Sane(ofMean.values[i]) / (y * y);
        for (int c = 0; c < kColours; ++c)
            variance.Plane(c)[i] = std::min(relative * mean[c] * mean[c], kLargest);
    }
    for (int c = 0; c < kColours; ++c) ScaleVariance(colour, c, &variance);
    return WithLeast(BoxMean(std::move(variance), 1));
}

void AddEmission(const Halves& emission, DenoisedPicture* picture) {
    const auto add = [](const Planes& to, Planes* half) {
        for (size_t i = 0; i < to.values.size(); ++i)
            half->values[i] = Sane(half->values[i] + to.values[i]);
    };
    for (Halves* halves : {&picture->halves, &picture->noisy}) {
        add(emission.a, &halves->a);
        add(emission.b, &halves->b);
    }
    const int width = emission.a.width, height = emission.a.height;
    ForEachTile(width, height, [&](const ImageTile& tile) {
        const ImageTile crop = tile.Grown(1).Within(width, height);
        const Halves part = Crop(emission, crop);
        Planes sum = Crop(picture->variance, crop);
        add(BoxMean(VarianceOf(part.a, part.b), 1), &sum);
        Paste(sum, tile.In(crop), tile.x0, tile.y0, &picture->variance);
    });
}

}  // namespace

Planes EstimateVariance(const Halves& colour, const Planes& ofMean) {
    const int width = colour.a.width, height = colour.a.height;
    Planes variance(width, height, kColours);
    ForEachTile(width, height, [&](const ImageTile& tile) {
        const ImageTile crop = tile.Grown(kVarianceReach).Within(width, height);
        const Planes made = VarianceIn(Crop(colour, crop), Crop(ofMean, crop));
        Paste(made, tile.In(crop), tile.x0, tile.y0, &variance);
    });
    return variance;
}

void ForgetFireflies(const std::vector<Firefly>& fireflies, const Halves& without, Planes* ofMean) {
    for (const Firefly& f : fireflies) ForgetVariance(without, f.pixel, ofMean);
}

DenoisedPicture Denoise(NoisyPicture in, Effort effort, const ShareListener& onShare) {
    if (in.emission.a.count > 0) TakeEmission(&in);
    MakeSane(&in.colour);
    TakeGlints(&in);
    const bool hasEmission = in.emission.a.count > 0;
    DenoisedPicture result;
    result.noisy = std::move(in.colour);
    result.fireflies = TakeFireflies(kFireflyLimit, &result.noisy);
    ForgetFireflies(result.fireflies, result.noisy, &in.variance);
    result.variance = EstimateVariance(result.noisy, in.variance);
    in.variance = {};  // a large picture needs the memory, here and below
    result.halves =
        FilterColours(result.noisy, std::move(in.features), result.variance, effort, onShare);
    RestoreStructure(result.noisy, result.variance, &result.halves);
    if (hasEmission) AddEmission(in.emission, &result);
    in.emission = {};

    const Planes& size = result.variance;
    result.picture = Planes(size.width, size.height, kColours);
    for (size_t i = 0; i < result.picture.values.size(); ++i)
        result.picture.values[i] =
            Sane((result.halves.a.values[i] + result.halves.b.values[i]) / 2);
    result.returned = GiveBack(result.fireflies, &result.picture);
    return result;
}

namespace {

void AddEnlarged(const Planes& half, Planes* image) {
    const auto neighbour = [](int i, int size) {
        return std::clamp(i / 2 + (i % 2 == 0 ? -1 : 1), 0, size - 1);
    };
    for (int c = 0; c < image->count; ++c)
        for (int y = 0; y < image->height; ++y) {
            const float* near = half.Row(c, y / 2);
            const float* far = half.Row(c, neighbour(y, half.height));
            float* to = image->Row(c, y);
            for (int x = 0; x < image->width; ++x) {
                const int u = x / 2, v = neighbour(x, half.width);
                to[x] += (9 * near[u] + 3 * (near[v] + far[u]) + far[v]) / 16;
            }
        }
}

}  // namespace

Planes Halved(const Planes& image) {
    Planes half((image.width + 1) / 2, (image.height + 1) / 2, image.count);
    for (int c = 0; c < half.count; ++c)
        for (int y = 0; y < half.height; ++y) {
            const float* first = image.Row(c, 2 * y);
            const float* second = image.Row(c, std::min(2 * y + 1, image.height - 1));
            for (int x = 0; x < half.width; ++x) {
                const int u = 2 * x, v = std::min(u + 1, image.width - 1);
                half.Row(c, y)[x] = (first[u] + first[v] + second[u] + second[v]) / 4;
            }
        }
    return half;
}

Planes Doubled(const Planes& image, int width, int height) {
    Planes doubled(width, height, image.count);
    AddEnlarged(image, &doubled);
    return doubled;
}

Planes WithCoarsePart(Planes fine, const Planes& coarse) {
    Planes change = Halved(fine);
    for (size_t i = 0; i < change.values.size(); ++i)
        change.values[i] = coarse.values[i] - change.values[i];
    AddEnlarged(change, &fine);
    return fine;
}

}  // namespace lull
