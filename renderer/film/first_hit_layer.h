// Sums up what the first hits of paths are, for AOVs and for the denoiser.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <variant>

#include "renderer/base/math.h"
#include "renderer/film/layer.h"

namespace lull {

// Sums of a pixel, added to in the order of the samples as FilmPixel is.

// For the denoiser, by halves: albedo R, G, B, normal X, Y, Z, weighted by the pixel filter as the
// image is, and one over the depth, which is 0 where nothing is met. Of the samples that are in the
// half (InHalf()), and of the others.
struct FeatureSums {
    std::array<std::array<float, 7>, 2> halves = {};

    void Add(const FirstHit& hit, bool inHalf) {
        std::array<float, 7>& sum = halves[inHalf ? 0 : 1];
        for (size_t c = 0; c < 3; ++c) {
            sum[c] += hit.weight * hit.albedo[int(c)];
            sum[3 + c] += hit.weight * hit.normal[int(c)];
        }
        if (hit.found && hit.depth > 0) sum[6] += 1 / std::max(hit.depth, 1e-12f);
    }
    bool operator==(const FeatureSums&) const = default;
};

struct SurfaceSums {
    std::array<double, 3> albedo = {}, normal = {};

    void Add(const FirstHit& hit) {
        for (int c = 0; c < 3; ++c) {
            albedo[size_t(c)] += double(hit.weight * hit.albedo[c]);
            normal[size_t(c)] += double(hit.weight * hit.normal[c]);
        }
    }
    bool operator==(const SurfaceSums&) const = default;
};

struct PlaceSums {
    std::array<double, 3> position = {};
    double depth = 0;
    int64_t hits = 0;  // samples with a first hit

    void Add(const FirstHit& hit) {
        if (!hit.found) return;
        ++hits;
        depth += double(hit.depth);
        for (int c = 0; c < 3; ++c) position[size_t(c)] += double(hit.position[c]);
    }
    bool operator==(const PlaceSums&) const = default;
};

// Not a sum: numbers cannot be averaged.
struct NearestHit {
    uint32_t object = 0, material = 0;  // of the sample nearest to the centre
    float offset2 = kInfinity;          // its FirstHit::offset2

    void Add(const FirstHit& hit) {
        if (hit.offset2 < offset2) *this = {hit.object, hit.material, hit.offset2};
    }
    bool operator==(const NearestHit&) const = default;
};

class FirstHitLayer {
  public:
    static bool IsWanted(const LayerOptions& o) { return o.features || o.aovs.Hits(); }
    static int Channels(const LayerOptions& o) { return o.aovs.Hits() ? 2 * 12 : 0; }
    FirstHitLayer(const PixelRect& region, const LayerOptions& o) {
        if (o.features) features.emplace(region);
        if (WantsSurface(o)) surface.emplace(region);
        if (WantsPlace(o)) place.emplace(region);
        if (WantsNearest(o)) nearest.emplace(region);
    }

    static bool NeedsFirstHits(const LayerOptions& o) { return o.aovs.Hits(); }
    void Add(const Vec2i& p, const PathSample& sample) {
        if (features) features->At(p).Add(sample.features, InHalf(sample.index));
        if (surface) surface->At(p).Add(sample.hit);
        if (place) place->At(p).Add(sample.hit);
        if (nearest) nearest->At(p).Add(sample.hit);
    }
    static std::string Identity(const LayerOptions& o) { return o.HitsText(); }
    template <typename Self, typename Visit>
    static void ForEachPlane(Self& self, const Visit& visit) {
        if (self.features) visit("features", *self.features);
        if (self.surface) visit("albedo and normal", *self.surface);
        if (self.place) visit("depth and position", *self.place);
        if (self.nearest) visit("object and material", *self.nearest);
    }
    // Free what the denoiser alone reads: all of it, and the rows [y0, y1).
    void ForgetFeatures(const LayerOptions& o) {
        if (!SharesFeatures(o)) features.reset();
    }
    void ForgetFeatures(const LayerOptions& o, int y0, int y1) {
        if (!SharesFeatures(o)) features->ForgetRows(y0, y1);
    }

    // Return the sums of a pixel; those that are wanted are there.
    SurfaceSums SurfaceAt(const Vec2i& p) const {
        if (surface) return surface->At(p);
        SurfaceSums sums;
        for (const std::array<float, 7>& half : features->At(p).halves)
            for (size_t c = 0; c < 3; ++c) {
                sums.albedo[c] += double(half[c]);
                sums.normal[c] += double(half[3 + c]);
            }
        return sums;
    }
    const FeatureSums& FeaturesAt(const Vec2i& p) const { return features->At(p); }
    const PlaceSums& PlaceAt(const Vec2i& p) const { return place->At(p); }
    const NearestHit& NearestAt(const Vec2i& p) const { return nearest->At(p); }

  private:
    static bool WantsMeans(const LayerOptions& o) { return o.aovs.albedo || o.aovs.normal; }
    // Returns whether these AOVs are of the same hits as the denoiser's features.
    static bool SharesFeatures(const LayerOptions& o) {
        return WantsMeans(o) && o.features && o.aovs.throughSpecular;
    }
    static bool WantsSurface(const LayerOptions& o) { return WantsMeans(o) && !SharesFeatures(o); }
    static bool WantsPlace(const LayerOptions& o) { return o.aovs.depth || o.aovs.position; }
    static bool WantsNearest(const LayerOptions& o) { return o.aovs.object || o.aovs.material; }

    std::optional<PixelPlane<FeatureSums>> features;
    std::optional<PixelPlane<SurfaceSums>> surface;
    std::optional<PixelPlane<PlaceSums>> place;
    std::optional<PixelPlane<NearestHit>> nearest;
};

// Sums up the light of surfaces seen directly, of which the denoiser leaves small ones as they are.

// The sums of a pixel, R, G, B, of the samples that are in the half (InHalf()), and of the others.
struct EmissionSums {
    std::array<std::array<float, 3>, 2> halves = {};

    bool operator==(const EmissionSums&) const = default;
};

class EmissionLayer {
  public:
    // Groups of lights are denoised one by one, each with its lamps.
    static bool IsWanted(const LayerOptions& o) { return o.features && o.groups.Count() == 0; }
    static int Channels(const LayerOptions&) { return 0; }
    EmissionLayer(const PixelRect& region, const LayerOptions&) : plane(region) {}

    static bool NeedsFirstHits(const LayerOptions&) { return false; }
    void Add(const Vec2i& p, const PathSample& sample) {
        const Rgb& emission = sample.features.emission;
        if (IsBlack(emission)) return;
        std::array<float, 3>& sum = plane.At(p).halves[InHalf(sample.index) ? 0 : 1];
        for (size_t c = 0; c < 3; ++c) sum[c] += emission[int(c)];
    }
    static std::string Identity(const LayerOptions&) { return ""; }
    template <typename Self, typename Visit>
    static void ForEachPlane(Self& self, const Visit& visit) {
        visit("lamps for the denoiser", self.plane);
    }

    const EmissionSums& At(const Vec2i& p) const { return plane.At(p); }

  private:
    // Few pixels show lamps: the others take no memory.
    PixelPlane<EmissionSums, ZeroAllocator<EmissionSums>> plane;
};

// Sums up the squares of the samples' luminance, which tell the noise of pixels.

class SquareLayer {
  public:
    static bool IsWanted(const LayerOptions& o) { return o.features || o.aovs.noise; }
    static int Channels(const LayerOptions& o) { return o.aovs.noise ? 2 : 0; }
    // The denoiser, which has little use for the rest of a double, halves the memory.
    SquareLayer(const PixelRect& region, const LayerOptions& o)
        : plane(o.features ? Plane(PixelPlane<float>(region)) : Plane(PixelPlane<double>(region))) {
    }

    static bool NeedsFirstHits(const LayerOptions&) { return false; }
    void Add(const Vec2i& p, const PathSample& sample) {
        if (auto* floats = std::get_if<PixelPlane<float>>(&plane))
            floats->At(p) += Sqr(Luminance(sample.radiance));
        else
            std::get<PixelPlane<double>>(plane).At(p) += Sqr(double(Luminance(sample.radiance)));
    }
    void AddSplats(const Vec2i& p, const PixelSplats& splats) {
        std::visit(
            [&](auto& sums) {
                auto& sum = sums.At(p);
                sum += std::remove_reference_t<decltype(sum)>(splats.all.Squares());
            },
            plane);
    }
    static std::string Identity(const LayerOptions&) { return ""; }
    template <typename Self, typename Visit>
    static void ForEachPlane(Self& self, const Visit& visit) {
        const char* name = self.plane.index() == 0 ? "noise for the denoiser" : "noise";
        std::visit([&](auto& sums) { visit(name, sums); }, self.plane);
    }

    double At(const Vec2i& p) const {
        return std::visit([&](const auto& sums) { return double(sums.At(p)); }, plane);
    }

  private:
    using Plane = std::variant<PixelPlane<float>, PixelPlane<double>>;
    Plane plane;
};

// Accumulates the coverage of each pixel, for compositing: by the scene, by objects and materials.

// The sums of a pixel, added to in the order of the samples as FilmPixel is.
struct AlphaPixel {
    std::array<double, 3> background = {};  // the radiance of samples that met nothing
    double weight = 0, covered = 0;         // filter weights of all samples, of those that did

    void Add(const FirstHit& hit, const Rgb& radiance) {
        weight += double(hit.weight);
        if (hit.found)
            covered += double(hit.weight);
        else
            for (int c = 0; c < 3; ++c) background[size_t(c)] += double(radiance[c]);
    }
    // Returns the share of the pixel that is covered, from 0 to 1.
    float Alpha() const { return weight != 0 ? float(std::clamp(covered / weight, 0., 1.)) : 0; }
    bool operator==(const AlphaPixel&) const = default;
};

// An object's or material's share of a pixel: its number (FirstHit), 0: none, and its weights.
struct MatteShare {
    uint32_t number = 0;
    float weight = 0;
    bool operator==(const MatteShare&) const = default;
};

// The shares of the first few objects and materials that a pixel's samples met. Where there
// are more, those that came late are left out.
inline constexpr size_t kMatteShares = 8;
struct CryptoPixel {
    std::array<MatteShare, kMatteShares> objects = {}, materials = {};

    void Add(const FirstHit& hit) {
        AddTo(&objects, hit.object, hit.weight);
        AddTo(&materials, hit.material, hit.weight);
    }
    bool operator==(const CryptoPixel&) const = default;

  private:
    static void AddTo(std::array<MatteShare, kMatteShares>* shares, uint32_t number, float weight) {
        if (number == 0) return;
        for (MatteShare& share : *shares) {
            if (share.number != 0 && share.number != number) continue;
            share.number = number;
            share.weight += weight;
            return;
        }
    }
};

class MatteLayer {
  public:
    static bool IsWanted(const LayerOptions& o) { return o.aovs.Mattes(); }
    static int Channels(const LayerOptions&) { return 25; }
    MatteLayer(const PixelRect& region, const LayerOptions& o) : alpha(region) {
        if (o.aovs.cryptomatte) crypto.emplace(region);
    }

    static bool NeedsFirstHits(const LayerOptions&) { return true; }
    void Add(const Vec2i& p, const PathSample& sample) {
        alpha.At(p).Add(sample.hit, sample.radiance);
        if (crypto) crypto->At(p).Add(sample.hit);
    }
    static std::string Identity(const LayerOptions& o) { return o.HitsText(); }
    template <typename Self, typename Visit>
    static void ForEachPlane(Self& self, const Visit& visit) {
        visit("alpha", self.alpha);
        if (self.crypto) visit("cryptomatte", *self.crypto);
    }

    const AlphaPixel& AlphaAt(const Vec2i& p) const { return alpha.At(p); }
    const PixelPlane<AlphaPixel>& Alpha() const { return alpha; }
    const PixelPlane<CryptoPixel>& Crypto() const { return *crypto; }  // it is wanted

  private:
    PixelPlane<AlphaPixel> alpha;
    std::optional<PixelPlane<CryptoPixel>> crypto;
};

}  // namespace lull
