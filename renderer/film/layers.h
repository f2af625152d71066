// Data of the samples that a render collects in addition to the film.
#pragma once

#include "renderer/film/aov_film.h"
#include "renderer/film/feature_film.h"
#include "renderer/film/film.h"
#include "renderer/film/light_group_film.h"
#include "renderer/film/matte_film.h"
#include "renderer/transport/first_hit.h"

namespace lull {

struct Layers {
    // Of the film's region; null: not collected.
    AovFilm* aovs = nullptr;
    FeatureFilm* features = nullptr;  // for the denoiser
    MatteFilm* mattes = nullptr;
    LightGroupFilm* lights = nullptr;

    explicit operator bool() const { return aovs || features || mattes || lights; }
    // Returns whether they are of this region.
    bool AreOf(const PixelRect& region) const {
        return (!aovs || aovs->Region() == region) && (!features || features->Region() == region) &&
               (!mattes || mattes->alpha.Region() == region) &&
               (!lights || lights->Region() == region);
    }
    // Adds sample `index` of a pixel, whose path met this first. `groups` has its light by groups,
    // where there are `lights`.
    void Add(const Vec2i& pixel, uint32_t index, const FirstHit& hit, const Rgb& radiance,
             const GroupRadiance* groups = nullptr) const {
        if (aovs) aovs->At(pixel).Add(hit, radiance);
        if (features) features->At(pixel).Add(hit, radiance, InHalf(index));
        if (mattes) mattes->Add(pixel, hit, radiance);
        if (lights) lights->Add(pixel, InHalf(index), *groups, hit);
    }
    // Returns whether any of them needs the samples' first hits; noise does not.
    bool NeedFirstHits() const {
        return features || mattes || (aovs && aovs->Wanted().FirstHits());
    }
};

// Calls visit(name, plane, part) for each plane of a film, which may be const, and of the layers;
// `part` is a rectangle of whole tiles, `pixels`, in the coordinates of the plane.
template <typename AnyFilm, typename Visit>
void ForEachPlane(AnyFilm& film, const Layers& layers, const PixelRect& pixels,
                  const Visit& visit) {
    Film::ForEachPlane(film, pixels, visit);
    if (layers.aovs) visit("aovs", *layers.aovs, pixels);
    if (layers.features) visit("features", *layers.features, pixels);
    if (layers.lights)
        layers.lights->ForEachPlane(
            [&](const char* name, auto& plane) { visit(name, plane, pixels); });
    if (!layers.mattes) return;
    visit("alpha", layers.mattes->alpha, pixels);
    if (layers.mattes->crypto) visit("crypto", *layers.mattes->crypto, pixels);
}

// Append the pixels of whole tiles, and set them from bytes appended for the same planes.
// GetPlanes() throws std::runtime_error where the bytes end too early.
void PutPlanes(const Film&, const Layers&, const PixelRect& pixels, StateWriter*);
void GetPlanes(StateReader*, const PixelRect& pixels, Film*, const Layers&);

}  // namespace lull
