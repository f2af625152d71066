// Accumulates the coverage of each pixel, for compositing: by the scene, and by which objects
// and materials how much.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "renderer/film/layer.h"

namespace lull {

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

// Which share of a pixel one object or material has: its number (FirstHit), 0 for none, and
// the weights of its samples.
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
    static int64_t Bytes(const LayerOptions& o) {
        return int64_t(sizeof(AlphaPixel) + (o.aovs.cryptomatte ? sizeof(CryptoPixel) : 0));
    }
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
