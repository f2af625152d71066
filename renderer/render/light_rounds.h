// Traces the light paths of a bidirectional render, in rounds.
//
// Light falls anywhere on the image, whatever block it is traced for. So no block begins a pass of
// the next round before all active blocks have completed this one. At the start of a round its
// light paths are traced, with no other thread at work, into an image that each pixel takes at the
// end of its samples of the round: light path (k, i) belongs to sample k of all pixels, and is in
// the half if that is (InHalf()). It depends on the seed, k and i alone; the image's sums are
// integers. So film, checkpoints and rules see nothing but samples, an interrupted round's light
// is traced again to the same bits, and the memory is that of one image.
#pragma once

#include <atomic>
#include <functional>

#include "renderer/film/light_plane.h"
#include "renderer/film/layers.h"
#include "renderer/render/schedule.h"
#include "renderer/transport/bdpt.h"

namespace lull {

class LightRounds {
  public:
    // The scene, whose integrator is BdptIntegrator, must outlive it.
    LightRounds(const Scene&, const PixelRect& region, SamplerKind, uint64_t seed);
    LightRounds(const LightRounds&) = delete;
    LightRounds& operator=(const LightRounds&) = delete;

    // Returns the samples that the strategies of this round take.
    const BdptShares& Shares() const { return shares; }
    // Returns the spp at which the round ends.
    int End() const { return end; }

    // Sets the round, of blocks that are at `first` spp or beyond.
    void Begin(int first, int end);
    // Traces its light, on all threads of the task arena. Returns false if `isCancelled` ended it.
    bool Trace(const std::function<bool()>& isCancelled);

    // Adds the round's light to a pixel that has its samples from `first` on to the end; `camera`
    // is the sum of their luminance.
    void AddTo(const Vec2i& p, uint32_t first, double camera, FilmPixel*, const Layers&) const;

    static int64_t Bytes(const PixelRect& region) { return LightPlane::Bytes(region); }

  private:
    double FindUnit() const;
    void TraceSome(uint32_t sample, uint32_t begin, uint32_t end);

    const Scene& scene;
    const PixelRect region;
    SamplerKind kind;
    uint64_t seed;
    BdptShares shares;
    int first = 0, end = 0;
    double unit = 1;
    LightPlane plane;
};

}  // namespace lull
