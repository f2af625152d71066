#include "renderer/film/layers.h"

#include <cstring>

#include "renderer/base/error.h"

namespace lull {

namespace {

constexpr int kAovSums = 11, kAlphaSums = 5;  // of a pixel
constexpr size_t kFeatureSums = sizeof(FeaturePixel) / sizeof(float);
static_assert(kFeatureSums * sizeof(float) == sizeof(FeaturePixel));

std::array<int64_t, 3> CryptoShape(const PixelRect& rect) {
    return {rect.Height(), rect.Width(), int64_t(2 * kMatteShares)};
}

// Calls visit(place) for the pixels of a rectangle, row by row.
template <typename Visit>
void ForEachPlace(const PixelRect& rect, Visit visit) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x) visit(Vec2i(x, y));
}

void WriteAovs(Hdf5Group& group, const PixelRect& rect, const AovFilm& aovs) {
    std::vector<double> sums;
    std::vector<float> nearest;
    std::vector<int32_t> numbers;
    ForEachPlace(rect, [&](const Vec2i& p) {
        const AovPixel& pixel = aovs.At(p);
        for (const auto& sum : {pixel.albedo, pixel.normal, pixel.position})
            sums.insert(sums.end(), sum.begin(), sum.end());
        sums.insert(sums.end(), {pixel.depth, pixel.squares});
        nearest.push_back(pixel.nearest);
        numbers.insert(numbers.end(),
                       {int32_t(pixel.hits), int32_t(pixel.object), int32_t(pixel.material)});
    });
    const std::array<int64_t, 3> shape = {rect.Height(), rect.Width(), kAovSums};
    group.AddArray<double>("aov_sums", shape, sums);
    group.AddArray<float>("aov_nearest", std::span(shape).first(2), nearest);
    group.AddArray<int32_t>("aov_numbers", std::array<int64_t, 3>{shape[0], shape[1], 3}, numbers);
}

void ReadAovs(const Hdf5Group& group, const PixelRect& rect, AovFilm* aovs) {
    const std::array<int64_t, 3> shape = {rect.Height(), rect.Width(), kAovSums};
    const auto sums = group.Array<double>("aov_sums", shape);
    const auto nearest = group.Array<float>("aov_nearest", std::span(shape).first(2));
    const auto numbers =
        group.Array<int32_t>("aov_numbers", std::array<int64_t, 3>{shape[0], shape[1], 3});
    size_t i = 0;
    ForEachPlace(rect, [&](const Vec2i& p) {
        AovPixel& pixel = aovs->At(p);
        const double* sum = &sums[kAovSums * i];
        for (auto* to : {&pixel.albedo, &pixel.normal, &pixel.position}) {
            std::copy_n(sum, 3, to->begin());
            sum += 3;
        }
        pixel.depth = sum[0];
        pixel.squares = sum[1];
        pixel.nearest = nearest[i];
        if (std::min({numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]}) < 0)
            throw Error("it has impossible numbers in its layers");
        pixel.hits = uint32_t(numbers[3 * i]);
        pixel.object = uint32_t(numbers[3 * i + 1]);
        pixel.material = uint32_t(numbers[3 * i + 2]);
        ++i;
    });
}

// Returns the pixels of a rectangle, row by row.
std::vector<FeaturePixel> CopyOf(const FeatureFilm& features, const PixelRect& rect) {
    std::vector<FeaturePixel> pixels;
    pixels.reserve(size_t(rect.Area()));
    ForEachPlace(rect, [&](const Vec2i& p) { pixels.push_back(features.At(p)); });
    return pixels;
}

void SetPixels(const std::vector<FeaturePixel>& pixels, const PixelRect& rect,
               FeatureFilm* features) {
    size_t i = 0;
    ForEachPlace(rect, [&](const Vec2i& p) { features->At(p) = pixels[i++]; });
}

std::array<int64_t, 3> FeatureShape(const PixelRect& rect) {
    return {rect.Height(), rect.Width(), int64_t(kFeatureSums)};
}

void WriteFeatures(Hdf5Group& group, const PixelRect& rect, const FeatureFilm& features) {
    const std::vector<FeaturePixel> pixels = CopyOf(features, rect);
    std::vector<float> sums(pixels.size() * kFeatureSums);
    std::memcpy(sums.data(), pixels.data(), sums.size() * sizeof(float));
    group.AddArray<float>("feature_sums", FeatureShape(rect), sums);
}

void ReadFeatures(const Hdf5Group& group, const PixelRect& rect, FeatureFilm* features) {
    const std::vector<float> sums = group.Array<float>("feature_sums", FeatureShape(rect));
    std::vector<FeaturePixel> pixels(size_t(rect.Area()));
    std::memcpy(static_cast<void*>(pixels.data()), sums.data(), sums.size() * sizeof(float));
    SetPixels(pixels, rect, features);
}

void WriteMattes(Hdf5Group& group, const PixelRect& rect, const MatteFilm& mattes) {
    std::vector<double> sums;
    for (const AlphaPixel& pixel : mattes.alpha.Copy(rect)) {
        sums.insert(sums.end(), pixel.background.begin(), pixel.background.end());
        sums.insert(sums.end(), {pixel.weight, pixel.covered});
    }
    group.AddArray<double>("alpha_sums",
                           std::array<int64_t, 3>{rect.Height(), rect.Width(), kAlphaSums}, sums);
    if (!mattes.crypto) return;
    std::vector<int32_t> numbers;
    std::vector<float> weights;
    for (const CryptoPixel& pixel : mattes.crypto->Copy(rect))
        for (const auto* shares : {&pixel.objects, &pixel.materials})
            for (const MatteShare& share : *shares) {
                numbers.push_back(int32_t(share.number));
                weights.push_back(share.weight);
            }
    const std::array<int64_t, 3> shape = CryptoShape(rect);
    group.AddArray<int32_t>("crypto_numbers", shape, numbers);
    group.AddArray<float>("crypto_weights", shape, weights);
}

void ReadMattes(const Hdf5Group& group, const PixelRect& rect, MatteFilm* mattes) {
    const auto sums = group.Array<double>(
        "alpha_sums", std::array<int64_t, 3>{rect.Height(), rect.Width(), kAlphaSums});
    std::vector<AlphaPixel> alpha;
    for (size_t i = 0; i < sums.size(); i += kAlphaSums)
        alpha.push_back({{sums[i], sums[i + 1], sums[i + 2]}, sums[i + 3], sums[i + 4]});
    mattes->alpha.Set(alpha, rect);
    if (!mattes->crypto) return;
    const auto numbers = group.Array<int32_t>("crypto_numbers", CryptoShape(rect));
    const auto weights = group.Array<float>("crypto_weights", CryptoShape(rect));
    std::vector<CryptoPixel> crypto(size_t(rect.Area()));
    size_t i = 0;
    for (CryptoPixel& pixel : crypto)
        for (auto* shares : {&pixel.objects, &pixel.materials})
            for (MatteShare& share : *shares) {
                if (numbers[i] < 0) throw Error("it has impossible numbers in its layers");
                share = {uint32_t(numbers[i]), weights[i]};
                ++i;
            }
    mattes->crypto->Set(crypto, rect);
}

template <typename Pixel>
void PutPlane(const PixelPlane<Pixel>& plane, const PixelRect& rect, StateWriter* writer) {
    const std::vector<Pixel> pixels = plane.Copy(rect);
    writer->PutAll(std::span<const Pixel>(pixels));
}

template <typename Pixel>
void GetPlane(StateReader* reader, const PixelRect& rect, PixelPlane<Pixel>* plane) {
    std::vector<Pixel> pixels(size_t(rect.Area()));
    reader->GetAll(std::span(pixels));
    plane->Set(pixels, rect);
}

}  // namespace

void Layers::Add(const Vec2i& pixel, uint32_t index, const FirstHit& firstHit,
                 const Rgb& radiance) const {
    if (aovs) aovs->At(pixel).Add(firstHit, radiance);
    if (features) features->At(pixel).Add(firstHit, radiance, InHalf(index));
    if (mattes) mattes->Add(pixel, firstHit, radiance);
}

void PutLayers(const Layers& layers, const PixelRect& rect, StateWriter* writer) {
    if (layers.aovs) {
        std::vector<AovPixel> pixels;
        layers.aovs->Copy(rect, &pixels);
        writer->PutAll(std::span<const AovPixel>(pixels));
    }
    if (layers.features)
        writer->PutAll(std::span<const FeaturePixel>(CopyOf(*layers.features, rect)));
    if (!layers.mattes) return;
    PutPlane(layers.mattes->alpha, rect, writer);
    if (layers.mattes->crypto) PutPlane(*layers.mattes->crypto, rect, writer);
}

void GetLayers(StateReader* reader, const PixelRect& rect, const Layers& layers) {
    if (layers.aovs) {
        std::vector<AovPixel> pixels(size_t(rect.Area()));
        reader->GetAll(std::span(pixels));
        layers.aovs->Set(pixels.data(), rect);
    }
    if (layers.features) {
        std::vector<FeaturePixel> pixels(size_t(rect.Area()));
        reader->GetAll(std::span(pixels));
        SetPixels(pixels, rect, layers.features);
    }
    if (!layers.mattes) return;
    GetPlane(reader, rect, &layers.mattes->alpha);
    if (layers.mattes->crypto) GetPlane(reader, rect, &*layers.mattes->crypto);
}

void WriteLayers(const Layers& layers, const PixelRect& rect, Hdf5Group* group) {
    if (layers.aovs) WriteAovs(*group, rect, *layers.aovs);
    if (layers.features) WriteFeatures(*group, rect, *layers.features);
    if (layers.mattes) WriteMattes(*group, rect, *layers.mattes);
}

void ReadLayers(const Hdf5Group& group, const PixelRect& rect, const Layers& layers) {
    if (layers.aovs) ReadAovs(group, rect, layers.aovs);
    if (layers.features) ReadFeatures(group, rect, layers.features);
    if (layers.mattes) ReadMattes(group, rect, layers.mattes);
}

}  // namespace lull
