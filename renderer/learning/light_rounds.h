// Traces the light paths of a bidirectional render, in rounds.
//
// Light falls anywhere on the image, whatever block it is traced for. So no block begins a pass of
// the next round before all active blocks have completed this one. At the start of a round its
// light paths are traced, with no other thread at work, into an image that each pixel takes at the
// end of its samples of the round: light path (k, i) belongs to sample k of all pixels, and is in
// the half if that is (InHalf()). It depends on the seed, k and i alone; the image's sums are
// integers. So film, checkpoints and rules see nothing but samples, an interrupted round's light
// is traced again to the same bits, and the memory is that of one image.
//
// How many samples the strategies take follows from the variance that they had in the round before,
// as in stratified sampling (Neyman 1934): in proportion to the root of the variance over the cost.
// A round's shares depend on samples before it alone, so that the mean stays as it is.
#pragma once

#include <functional>
#include <span>

#include "renderer/film/film.h"
#include "renderer/film/splat_plane.h"
#include "renderer/schedule/schedule.h"
#include "renderer/transport/bdpt.h"

namespace lull {

// The samples of all pixels from `first` to `end`, and those that the strategies take.
struct LightRound {
    int first = 0, end = 0;
    BdptShares shares;
};

class LightRounds {
  public:
    // The scene, whose integrator is BdptIntegrator, must outlive it; of the film it is the region
    // and the light groups.
    LightRounds(const Scene&, const Film&, SamplerKind, uint64_t seed);
    LightRounds(const LightRounds&) = delete;
    LightRounds& operator=(const LightRounds&) = delete;

    const LightRound& Round() const { return round; }
    // Returns the spp at which the round ends, 0 where none has begun, and whether it is the cap
    // that ends it there.
    int End() const { return round.end; }
    bool IsCutShort() const { return isCutShort; }

    // Begins the round that the active blocks are in, or come to next. Light paths are the fewer,
    // the fewer pixels are left that wait for them.
    void Begin(const Schedule&);
    // Begins this one, of which no light has been traced.
    void Begin(const LightRound&);
    // Traces one of `parts` of its light, on all threads of the task arena. Returns false if
    // `isCancelled` ended it.
    bool Trace(const std::function<bool()>& isCancelled, int part = 0, int parts = 1);
    // The light that has been traced, to be merged where others trace the other parts: all of it
    // and that of each light group.
    std::vector<SplatPlane>& Planes() { return planes; }

    // At the end of a round: chooses the shares of those to come by the spreads of the film, which
    // it forgets.
    void Learn(Film*);

    // Return what has to be kept to go on with the round, and take it. Take() throws
    // std::runtime_error for other bytes.
    std::vector<std::byte> Save() const;
    void Take(std::span<const std::byte>);

  private:
    friend class RoundLight;
    double FindUnit() const;
    // Returns light of a plane that belongs to a pixel's samples from `from` on.
    SplatLight LightOf(const SplatPlane&, const Vec2i& p, uint32_t from) const;
    void TraceSome(uint32_t sample, uint32_t begin, uint32_t end);

    const Scene& scene;
    const PixelRect region;
    SamplerKind kind;
    uint64_t seed;
    BdptShares learned;  // for all pixels
    LightRound round;
    bool isCutShort = false;
    double unit = 1;
    const LightGroups groups;
    std::vector<SplatPlane> planes;
};

// Adds the light of a round to the pixels of a film, for one thread.
class RoundLight {
  public:
    RoundLight(const LightRounds& rounds, Film* film) : rounds(rounds), film(film) {}

    // To be called before the first and after the last sample of a pixel in the round. These are
    // the samples from `first` on, and in the layers; the film has the pixel without them.
    void Begin(const Vec2i& p);
    void End(const Vec2i& p, uint32_t first, FilmPixel* sums) const;

  private:
    const LightRounds& rounds;
    Film* film;
    std::array<double, kMostLightGroups + 1> before = {};  // luminance of each group
};

}  // namespace lull
