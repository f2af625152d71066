// What a render collects of its samples beside the film. Checkpoints, undo and messages between
// ranks know it by the functions here alone.
#pragma once

#include <functional>

#include "renderer/film/aov_film.h"
#include "renderer/film/feature_film.h"
#include "renderer/film/matte_film.h"
#include "renderer/transport/integrator.h"
#include "stopping/base/hdf5_file.h"
#include "stopping/base/state.h"

namespace lull {

// As SampleSource, and says what the sample's path has met first.
using AovSource =
    std::function<PathSample(Sampler&, const Vec2i& pixel, uint32_t index, FirstHit*)>;

// Returns the scene as such a source of samples, the same ones as those of SamplesOf(), and for as
// long.
AovSource AovSamplesOf(const Scene&, PathOptions, const AovSet& wanted);

struct Layers {
    // Of the film's region; null: not collected.
    AovFilm* aovs = nullptr;
    FeatureFilm* features = nullptr;  // what a denoiser is shown
    MatteFilm* mattes = nullptr;
    AovSource source = {};  // where the samples of film and layers come from then

    explicit operator bool() const { return aovs || features || mattes; }
    // Says whether they are of this region.
    bool AreOf(const PixelRect& region) const {
        return (!aovs || aovs->Region() == region) && (!features || features->Region() == region) &&
               (!mattes || mattes->alpha.Region() == region);
    }
    // Takes the next sample of a pixel and adds it to the layers, of which there are some.
    PathSample Take(Sampler&, const Vec2i& pixel, uint32_t index) const;
};

// Append the pixels of a rectangle, and set them to what was appended; they do nothing where there
// are no layers. GetLayers() throws std::runtime_error where the bytes end too early.
void PutLayers(const Layers&, const PixelRect&, StateWriter*);
void GetLayers(StateReader*, const PixelRect&, const Layers&);

// Write and read the pixels of a rectangle as arrays of a checkpoint, where there are layers. Throw
// std::runtime_error; ReadLayers() also where the file has none.
void WriteLayers(const Layers&, const PixelRect&, Hdf5Group*);
void ReadLayers(const Hdf5Group&, const PixelRect&, const Layers&);

}  // namespace lull
