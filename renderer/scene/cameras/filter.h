// Samples the pixel filter: every sample belongs to one pixel, at an offset drawn from the filter
// and with a weight, so that blocks are independent (anchored on pbrt 4th ed., 8.8, in place of
// pbrt-v3's splatting; the expected image is the same).
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/input/description.h"

namespace lull {

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
