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
// How many samples the strategies take is learned from the variance that they had in the round
// before, as in stratified sampling (Neyman 1934): in proportion to the root of the variance over
// the cost.
#pragma once

#include <functional>

#include "renderer/film/film.h"
#include "renderer/film/layer.h"
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
    // With few connections the weights leave to other strategies all that these can find.
    static constexpr BdptShares kFirst{.lightPaths = 0.3f, .connections = 0.05f};
    // Shares below which no strategy falls: it has to be seen where it would bring much.
    static constexpr BdptShares kLeast{.lightPaths = 0.05f, .connections = 0.03f};

    // The scene, with a BdptIntegrator, must outlive it; of the film it is region and light groups.
    LightRounds(const Scene&, const Film&, const Sampler&);
    LightRounds(const LightRounds&) = delete;
    LightRounds& operator=(const LightRounds&) = delete;

    const LightRound& Round() const { return round; }
    // Returns the spp at which the round ends, 0 where none has begun, and whether by the cap.
    int End() const { return round.end; }
    bool IsCutShort() const { return isCutShort; }

    // Return and set the shares that were learned for all pixels, of an interrupted render.
    const BdptShares& Shares() const { return shares; }
    void SetShares(const BdptShares& learned) { shares = learned; }

    // Begins the round that the active blocks are in, or come to next. Light paths are the fewer,
    // the fewer pixels are left that wait for them.
    void Begin(const Schedule&);
    // Begins this one, of which no light has been traced.
    void Begin(const LightRound&);
    // Traces one of `parts` of its light, on all threads. Returns false if `isCancelled` ended it.
    bool Trace(const std::function<bool()>& isCancelled, int part = 0, int parts = 1);
    // The light traced, to be merged where others trace other parts: all, and of each light group.
    std::vector<SplatPlane>& Planes() { return planes; }
    // With no thread at work: learns the shares from the spreads of the round, which the film then
    // forgets. If the render ends here, or is interrupted, whoever goes on has to know them.
    void Learn(Film*);

  private:
    friend class SplatAdder;
    double FindUnit() const;
    // Returns light of a plane that belongs to a pixel's samples from `from` on.
    SplatLight LightOf(const SplatPlane&, const Vec2i& p, uint32_t from) const;
    void Add(const Splat&, bool inHalf);

    const Scene& scene;
    const PixelRect region;
    const Sampler start;  // of all light paths
    BdptShares shares = kFirst;
    LightRound round;
    bool isCutShort = false;
    double unit = 1;
    const LightGroups groups;
    std::vector<SplatPlane> planes;
};

// Adds the light of a round to the pixels of a film, for one thread.
class SplatAdder {
  public:
    SplatAdder(const LightRounds& rounds, Film* film) : rounds(rounds), film(film) {}

    // To be called before the first and after the last sample of a pixel in the round. These are
    // the samples from `first` on, and in the layers; the film has the pixel without them.
    void Begin(const Vec2i& p);
    void End(const Vec2i& p, uint32_t first, FilmPixel* sums) const;
    // Returns the squares of luminance of the round's light paths in a pixel, one by one.
    double SquaresAt(const Vec2i& p) const { return rounds.planes[0].SumsAt(p).squares; }

  private:
    const LightRounds& rounds;
    Film* film;
    std::array<double, kMostLightGroups + 1> before = {};  // luminance of each group
};

}  // namespace lull
