// Sums up the first hits of paths: the AOVs that denoisers and compositors read
// ("arbitrary output variables").
#pragma once

#include <string>
#include <vector>

#include "renderer/base/color.h"
#include "renderer/film/pixel_plane.h"
#include "renderer/transport/first_hit.h"

namespace lull {

// Which layers are wanted, and how.
struct AovSet {
    bool albedo = false, normal = false, depth = false, position = false, object = false,
         material = false, noise = false, alpha = false, cryptomatte = false;
    // Follow surfaces with only perfectly specular lobes to the next surface.
    bool throughSpecular = false;

    bool Any() const { return FirstHits() || noise; }
    // Returns whether any layer needs first hits; noise does not.
    bool FirstHits() const {
        return albedo || normal || depth || position || object || material || Mattes();
    }
    // Return whether any layer comes from an AovFilm, and from a MatteFilm.
    bool Sums() const {
        return albedo || normal || depth || position || object || material || noise;
    }
    bool Mattes() const { return alpha || cryptomatte; }
    bool operator==(const AovSet&) const = default;
};

// Names the layers: "albedo,normal,..." in the order above, without throughSpecular.
std::string NameOf(const AovSet&);
// Returns the same in words, with throughSpecular, for checkpoints and headers.
std::string TextOf(const AovSet&);

// Reads such names, in any order. Throws Error naming the first unknown one.
AovSet ParseAovs(const std::vector<std::string>& names);

// The sums of a pixel, added to in the order of the samples as FilmPixel is.
struct AovPixel {
    std::array<double, 3> albedo = {}, normal = {}, position = {};
    double depth = 0;
    double squares = 0;                 // of the samples' luminance
    uint32_t hits = 0;                  // samples with a first hit
    uint32_t object = 0, material = 0;  // of the sample nearest to the centre
    float nearest = kInfinity;          // its FirstHit::offset2

    void Add(const FirstHit& hit, const Rgb& radiance) {
        const double y = Luminance(radiance);
        squares += y * y;
        for (int c = 0; c < 3; ++c) {
            albedo[c] += double(hit.weight * hit.albedo[c]);
            normal[c] += double(hit.weight * hit.normal[c]);
        }
        if (hit.found) {
            ++hits;
            depth += double(hit.depth);
            for (int c = 0; c < 3; ++c) position[c] += double(hit.position[c]);
        }
        if (hit.offset2 < nearest) {
            nearest = hit.offset2;
            object = hit.object;
            material = hit.material;
        }
    }
    bool operator==(const AovPixel&) const = default;
};

// These pixels of the region of a Film, which has their sample counts.
class AovFilm : public PixelPlane<AovPixel> {
  public:
    AovFilm(const PixelRect& region, const AovSet& wanted) : PixelPlane(region), wanted(wanted) {}

    const AovSet& Wanted() const { return wanted; }

  private:
    AovSet wanted;
};

}  // namespace lull
