// Computes the share of light that a smooth interface reflects.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Returns the reflectance of an interface between dielectrics for unpolarised light, in [0, 1]
// (Fresnel; 1 at total internal reflection). `cosI` in [-1, 1] is on the side of the normal where
// positive; `eta` is the index beyond the surface over the index on the normal's side.
inline float FresnelDielectric(float cosI, float eta) {
    if (!(cosI > 0)) {
        eta = 1 / eta;
        cosI = -cosI;
    }
    cosI = std::min(cosI, 1.f);
    const float sin2T = (1 - Sqr(cosI)) / Sqr(eta);
    if (!(sin2T < 1)) return 1;
    const float cosT = std::sqrt(1 - sin2T);
    const float parallel = (eta * cosI - cosT) / (eta * cosI + cosT);
    const float perpendicular = (cosI - eta * cosT) / (cosI + eta * cosT);
    return 0.5f * (Sqr(parallel) + Sqr(perpendicular));
}

// A colour in four lanes, one of them padding: roots and quotients take one instruction.
using RgbLanes = Eigen::Array4f;

// Returns the reflectance of a conductor of index n + i k, relative to the medium around it, for
// unpolarised light (Born and Wolf 1999, section 14.4). `cosI` in [0, 1].
inline Rgb FresnelConductor(float cosI, const RgbLanes& n, const RgbLanes& k) {
    const float cos2 = std::min(Sqr(cosI), 1.f), sin2 = 1 - cos2;
    const RgbLanes n2 = n * n, k2 = k * k;
    const RgbLanes t0 = n2 - k2 - sin2;
    const RgbLanes a2b2 = (t0 * t0 + 4 * n2 * k2).sqrt();
    const RgbLanes a = (0.5f * (a2b2 + t0)).max(0.f).sqrt();
    const RgbLanes t1 = a2b2 + cos2, t2 = (2 * std::min(cosI, 1.f)) * a;
    const RgbLanes t3 = cos2 * a2b2 + Sqr(sin2), t4 = t2 * sin2;
    // Rs = (t1 - t2) / (t1 + t2) and Rp = Rs (t3 - t4) / (t3 + t4); their mean is one quotient.
    // The denominator vanishes only for eta = k = 0 seen head-on or edge-on.
    constexpr float kTiny = std::numeric_limits<float>::min();
    const RgbLanes r = ((t1 - t2) * t3).max(0.f) / ((t1 + t2) * (t3 + t4)).max(kTiny);
    return r.head<3>();
}

// Returns the weight of the reflectance at grazing incidence in Schlick's approximation (1994).
inline float SchlickWeight(float cosine) {
    const float m = std::clamp(1 - cosine, 0.f, 1.f);
    return Sqr(Sqr(m)) * m;
}

// Returns Schlick's approximation (1994) for reflectance r0 at normal incidence; `cosI` in [0, 1].
inline Rgb FresnelSchlick(const Rgb& r0, float cosI) {
    const float c = std::max(0.f, 1 - cosI);
    return r0 + (Sqr(Sqr(c)) * c) * (1 - r0);
}

// Stores an Rgb in a trivially copyable way, which Eigen's types are not; a variant of non-trivial
// structs would be copied through a table of functions.
struct StoredRgb {
    float r, g, b;

    StoredRgb(const Rgb& c) : r(c.x()), g(c.y()), b(c.z()) {}
    operator Rgb() const { return {r, g, b}; }
    StoredRgb& operator*=(const Rgb& s) { return *this = StoredRgb(Rgb(*this) * s); }
};

// Stores a pointer with the alignment of a float: with its own it would make every lobe longer.
template <typename T>
class StoredPointer {
  public:
    StoredPointer(const T* pointer) : bits(std::bit_cast<Bits>(pointer)) {}
    operator const T*() const { return std::bit_cast<const T*>(bits); }
    const T* operator->() const { return *this; }

  private:
    using Bits = std::array<uint32_t, sizeof(void*) / sizeof(uint32_t)>;
    Bits bits;
};

// The interfaces that a reflecting lobe may have; each maps the cosine to a reflectance.
struct DielectricInterface {
    float eta;  // index beyond the surface over the index on the normal's side
    float operator()(float cosI) const { return FresnelDielectric(cosI, eta); }
};
class ConductorInterface {
  public:
    // The index is eta + i k.
    ConductorInterface(const Rgb& eta, const Rgb& k)
        : eta{eta.x(), eta.y(), eta.z(), 1}, k{k.x(), k.y(), k.z(), 0} {}
    Rgb operator()(float cosI) const {
        return FresnelConductor(std::abs(cosI), RgbLanes::Map(eta), RgbLanes::Map(k));
    }

  private:
    float eta[4], k[4];  // in lanes, so that no hit has to assemble them
};
// Follows Schlick's approximation, from f0 at normal incidence to 1 at grazing.
struct SchlickInterface {
    float f0;
    float operator()(float cosI) const { return f0 + (1 - f0) * SchlickWeight(std::abs(cosI)); }
};
struct PerfectMirror {
    float operator()(float) const { return 1; }
};

// Computes the direction that w, on the side of the unit normal n, is refracted to; `etaRatio` is
// the index on w's side over the one beyond. Returns false at total internal reflection.
inline bool Refract(const Vec3f& w, const Vec3f& n, float etaRatio, Vec3f* refracted) {
    const float cosI = n.dot(w);
    const float sin2T = Sqr(etaRatio) * std::max(0.f, 1 - Sqr(cosI));
    if (!(sin2T < 1)) return false;
    *refracted = (etaRatio * cosI - std::sqrt(1 - sin2T)) * n - etaRatio * w;
    return true;
}

// Return the integral over cosines from 0 to 1 of F cos and F cos^2, F for light that comes from
// the inside of a dielectric of index `eta` (below 1: from the outside of one of 1 / eta): fits of
// d'Eon and Irving 2011, "A Quantized-Diffusion Model for Rendering Translucent Materials".
inline double FresnelMoment1(double eta) {
    if (eta < 1)
        return 0.45966 +
               eta * (-1.73965 +
                      eta * (3.37668 + eta * (-3.904945 + eta * (2.49277 - eta * 0.68441))));
    return -4.61686 +
           eta * (11.1136 + eta * (-10.4646 + eta * (5.11455 + eta * (-1.27198 + eta * 0.12746))));
}
inline double FresnelMoment2(double eta) {
    if (eta < 1)
        return 0.27614 +
               eta * (-0.87350 +
                      eta * (1.12077 + eta * (-0.65095 + eta * (0.07883 + eta * 0.04860))));
    const double r = 1 / eta;
    return -547.033 + r * (458.843 + r * (-218.725 + r * 45.3087)) +
           eta * (404.557 + eta * (-189.519 + eta * (54.9327 + eta * (-9.00603 + eta * 0.63942))));
}

}  // namespace lull
