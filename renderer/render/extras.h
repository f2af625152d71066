// Renders with more than the image: layers beside it, and a viewer that sees it grow.
#pragma once

#include "renderer/output/display.h"
#include "renderer/render/aov_film.h"
#include "renderer/render/checkpoint.h"

namespace lull {

// As SampleSource, and says what the sample's path has met first.
using AovSource =
    std::function<PathSample(Sampler&, const Vec2i& pixel, uint32_t index, FirstHit*)>;

// Returns the scene as such a source of samples, the same ones as those of SamplesOf(), and for as
// long.
AovSource AovSamplesOf(const Scene&, PathOptions, const AovSet& wanted);

struct RenderExtras {
    // Layers of the same region as the film, and whence the samples of both come. Null: none.
    AovFilm* aovs = nullptr;
    AovSource aovSource;
    // Is shown every tile when it has been rendered, and every block that stops. Null: none.
    Display* display = nullptr;
};

// Renders as without extras, to the same bits; layers, too, are the same bits for any number of
// ranks. Throws std::invalid_argument for layers of another region, and for a display on several
// ranks.
RenderResult Render(const SampleSource&, const RenderOptions&, Film*,
                    const RenderState* interrupted, const RenderExtras&);

// Write and read checkpoints that have the layers as well. One with layers can be read without, but
// not the other way round. Throw Error.
void WriteCheckpoint(const std::string& path, const RenderIdentity&, const RenderState&,
                     const Film&, std::span<const std::byte> guide, const AovFilm*);
RenderState ReadCheckpoint(const std::string& path, const RenderIdentity&, Film*,
                           std::vector<std::byte>* guide, AovFilm*);

}  // namespace lull
