// Describes the image that is wanted: its size, crop and scale. (The film itself is in film/.)
#pragma once

#include <optional>
#include <string>

#include "renderer/base/math.h"
#include "renderer/base/sampling.h"
#include "renderer/input/description.h"

namespace lull {

struct FilmSettings {
    Vec2i resolution = {1280, 720};  // of the whole image, pixels
    Vec2i cropMin = {0, 0};          // the pixels rendered: [cropMin, cropMax)
    Vec2i cropMax = {1280, 720};
    float diagonal = 0.035f;  // of the whole image on the film, metres (realistic cameras)
    std::string filename;     // empty: none is given
    float scale = 1;          // multiplies every sample, exposure included
    float exposure = 0;       // in stops
    float maxSampleLuminance = kInfinity;  // a brighter sample is scaled down to this
    // Of scenes for pbrt-v4: the largest component of a sample once it is multiplied by the scale,
    // beyond which it is scaled down, and what colours are multiplied by.
    float maxComponent = kInfinity;
    std::optional<Mat3f> colorMatrix;

    bool isPair = false;  // of two eyes, the right one's beside the left one's

    Vec2i Size() const { return cropMax - cropMin; }  // of one eye
    // Returns the pixels of the film: of a pair, those of the right eye follow to the right.
    PixelRect Region() const { return {cropMin, cropMax + Vec2i(isPair ? Size().x() : 0, 0)}; }
};

// Overrides of the scene's Film directive, from the command line.
struct FilmOverrides {
    std::optional<Vec2i> resolution;
    std::optional<std::array<float, 4>> crop;        // x0, x1, y0, y1 in [0, 1]
    std::optional<std::array<int, 4>> cropInPixels;  // instead: the pixels [x0, x1) x [y0, y1)
};

// Reads Film "image". Throws Error for sizes that are not positive or beyond 2^28 pixels.
FilmSettings MakeFilmSettings(const Description&, const FilmOverrides&, Warnings&);

// Samples the pixel filter: every sample belongs to one pixel, at an offset drawn from the filter
// and with a weight, so that blocks are independent (anchored on pbrt 4th ed., 8.8, in place of
// pbrt-v3's splatting; the expected image is the same).

struct FilterSample {
    Vec2f offset;  // from the pixel's centre, pixels
    float weight;  // filter / density / integral; its mean is 1
};

class Filter {
  public:
    // Makes pbrt-v3's default: a box of half a pixel.
    Filter() = default;
    // Reads PixelFilter box, gaussian, mitchell, sinc or triangle. Throws Error for others and for
    // widths that are not positive.
    Filter(const Description&, Warnings&);

    FilterSample Sample(const Vec2f& u) const {
        if (!tabulated) return {(2 * u - Vec2f::Ones()).cwiseProduct(radius), 1};
        return SampleTable(u);
    }

    // Returns the weight of light that arrives at an offset from the pixel's centre, as if all
    // within the radius were sampled evenly: its integral over the offsets is 1.
    float Evaluate(const Vec2f& offset) const;
    const Vec2f& Radius() const { return radius; }  // pixels; beyond it the filter is 0

  private:
    // Every filter here is a product of one function of x and one of y.
    struct Axis {
        std::vector<float> values;  // signed, at the middles of the bins over [-radius, radius]
        Distribution1D density;     // proportional to their magnitude
        float weightScale = 1;      // integral of |f| over integral of f
    };
    FilterSample SampleTable(const Vec2f& u) const;

    Vec2f radius = {0.5f, 0.5f};
    bool tabulated = false;  // a box needs no table
    std::array<Axis, 2> axes;
};

}  // namespace lull
