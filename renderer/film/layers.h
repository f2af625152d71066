// What a render collects of its samples beside the film. Checkpoints, undo and messages between
// ranks know it by the functions here alone.
#pragma once

#include "renderer/film/aov_film.h"
#include "renderer/film/feature_film.h"
#include "renderer/film/matte_film.h"
#include "stopping/base/hdf5_file.h"
#include "stopping/base/state.h"

namespace lull {

struct Layers {
    // Of the film's region; null: not collected.
    AovFilm* aovs = nullptr;
    FeatureFilm* features = nullptr;  // what a denoiser is shown
    MatteFilm* mattes = nullptr;

    explicit operator bool() const { return aovs || features || mattes; }
    // Says whether they are of this region.
    bool AreOf(const PixelRect& region) const {
        return (!aovs || aovs->Region() == region) && (!features || features->Region() == region) &&
               (!mattes || mattes->alpha.Region() == region);
    }
    // Says whether any of them needs the samples' first hits; noise does not.
    bool NeedFirstHits() const {
        return features || mattes || (aovs && aovs->Wanted().FirstHits());
    }
    // Adds sample `index` of a pixel.
    void Add(const Vec2i& pixel, uint32_t index, const FirstHit&, const Rgb& radiance) const;
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
