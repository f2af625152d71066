// Tabulated isotropic scattering: splines over both cosines and a Fourier series over the
// azimuth between the directions (Jakob et al. 2014). See lobes.h for the interface.
#pragma once

#include <vector>

#include "renderer/bsdf/microfacet.h"

namespace lull {

// f times |cos wi|, between nodes of mu: the cosines of wo and of -wi. Entry (o, i) of a
// table is at o * nodes + i.
struct FourierTable {
    static constexpr int kMaxOrder = 4096;

    struct Series {
        int first, order;  // in coefficients; each channel has `order` of them, luminance first
    };

    float eta = 1;           // index beyond the surface
    int channels = 1;        // 1, or 3: luminance, red, blue
    std::vector<float> mu;   // ascending; two may be equal, but not at the ends
    std::vector<float> cdf;  // integrals of the first coefficient over mu of i, by row
    std::vector<Series> series;
    std::vector<float> coefficients;

    float Mean(int o, int i) const {
        const Series& s = series[size_t(o) * mu.size() + i];
        return s.order > 0 ? coefficients[s.first] : 0;
    }
};

struct FourierLobe {
    static constexpr bool kIsSpecular = false, kTransmits = false, kIsTwoSided = true;
    static constexpr bool kTellsSides = true;
    StoredRgb r;                         // scales f
    StoredPointer<FourierTable> stored;  // outlives the lobe

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const;
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const;
};

}  // namespace lull
