// Sums up the light of surfaces that are seen directly, of which the denoiser leaves small ones as
// they are.
#pragma once

#include "renderer/film/film_pixel.h"
#include "renderer/film/layer.h"

namespace lull {

// The sums of a pixel, R, G, B, of the samples that are in the half (InHalf()), and of the others.
struct EmissionSums {
    std::array<std::array<float, 3>, 2> halves = {};

    bool operator==(const EmissionSums&) const = default;
};

class EmissionLayer {
  public:
    // Groups of lights are denoised one by one, each with its lamps.
    static bool IsWanted(const LayerOptions& o) { return o.features && o.groups.Count() == 0; }
    static int64_t Bytes(const LayerOptions&) { return int64_t(sizeof(EmissionSums)); }
    static int Channels(const LayerOptions&) { return 0; }
    EmissionLayer(const PixelRect& region, const LayerOptions&) : plane(region) {}

    static bool NeedsFirstHits(const LayerOptions&) { return true; }
    void Add(const Vec2i& p, const PathSample& sample) {
        const Rgb& emission = sample.hit.emission;
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

}  // namespace lull
