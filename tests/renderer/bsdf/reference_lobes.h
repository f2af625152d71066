// Computes scattering again for comparison, in double and in the textbook forms with angles.
#pragma once

#include <complex>

#include "renderer/base/math.h"

namespace lull::test {

using Vec3d = Eigen::Vector3d;

// Returns the reflectance of an interface into index n (relative, complex for conductors) from the
// complex amplitudes of both polarisations.
inline double ReferenceFresnel(double cosI, std::complex<double> n) {
    const std::complex<double> sinT = std::sqrt(1 - cosI * cosI) / n;
    std::complex<double> cosT = std::sqrt(1.0 - sinT * sinT);
    if (cosT.imag() * n.real() < 0) cosT = -cosT;  // the wave that decays
    const std::complex<double> s = (cosI - n * cosT) / (cosI + n * cosT);
    const std::complex<double> p = (n * cosI - cosT) / (n * cosI + cosT);
    return (std::norm(s) + std::norm(p)) / 2;
}

// Returns the reflectance between dielectrics, seen from the side given by the sign of the cosine.
inline double ReferenceDielectric(double cosI, double eta) {
    const double n = cosI > 0 ? eta : 1 / eta;
    const double c = std::abs(cosI);
    if (std::sqrt(1 - c * c) >= n) return 1;
    return ReferenceFresnel(c, n);
}

struct ReferenceDistribution {
    double ax, ay;

    // Walter et al. 2007, eq. 33, with Heitz 2014, eq. 85, for two alphas.
    double D(const Vec3d& h) const {
        const double tan2 = (h.x() * h.x() + h.y() * h.y()) / (h.z() * h.z());
        const double phi = std::atan2(h.y(), h.x());
        const double e = tan2 * (std::pow(std::cos(phi) / ax, 2) + std::pow(std::sin(phi) / ay, 2));
        return 1 / (std::numbers::pi * ax * ay * std::pow(h.z(), 4) * std::pow(1 + e, 2));
    }
    // Heitz 2014, eq. 72 and 80.
    double Lambda(const Vec3d& w) const {
        const double tan = std::hypot(w.x(), w.y()) / std::abs(w.z());
        const double phi = std::atan2(w.y(), w.x());
        const double alpha = std::hypot(ax * std::cos(phi), ay * std::sin(phi));
        return (std::sqrt(1 + std::pow(alpha * tan, 2)) - 1) / 2;
    }
    double G(const Vec3d& a, const Vec3d& b) const { return 1 / (1 + Lambda(a) + Lambda(b)); }
    double VisibleD(const Vec3d& w, const Vec3d& h) const {
        return D(h) / (1 + Lambda(w)) * std::abs(w.dot(h) / w.z());
    }
};

struct ReferenceValue {
    double f, pdf;
};

// `fresnel` is a function of wi . h, h being on the side of the normal.
template <typename Fresnel>
ReferenceValue ReferenceReflection(const ReferenceDistribution& d, const Fresnel& fresnel,
                                   const Vec3d& wo, const Vec3d& wi) {
    Vec3d h = (wo + wi).normalized();
    if (h.z() < 0) h = -h;
    const double f = d.D(h) * d.G(wo, wi) * fresnel(wi.dot(h)) / (4 * std::abs(wo.z() * wi.z()));
    return {f, wo.z() * wi.z() > 0 ? d.VisibleD(wo, h) / (4 * std::abs(wo.dot(h))) : 0};
}

inline ReferenceValue ReferenceTransmission(const ReferenceDistribution& d, double eta,
                                            const Vec3d& wo, const Vec3d& wi) {
    const double ratio = wo.z() > 0 ? eta : 1 / eta;
    Vec3d h = (wo + ratio * wi).normalized();
    if (h.z() < 0) h = -h;
    if (wo.z() * wi.z() > 0 || wo.dot(h) * wi.dot(h) > 0) return {0, 0};
    const double denominator = std::pow(wo.dot(h) + ratio * wi.dot(h), 2);
    const double f = (1 - ReferenceDielectric(wo.dot(h), eta)) * d.D(h) * d.G(wo, wi) *
                     std::abs(wo.dot(h) * wi.dot(h) / (wo.z() * wi.z())) / denominator;
    return {f, d.VisibleD(wo, h) * ratio * ratio * std::abs(wi.dot(h)) / denominator};
}

// Oren and Nayar 1994, eq. 30; sigma in degrees.
inline double ReferenceOrenNayar(double sigma, const Vec3d& wo, const Vec3d& wi) {
    const double s2 = std::pow(sigma * std::numbers::pi / 180, 2);
    const double to = std::acos(std::abs(wo.z())), ti = std::acos(std::abs(wi.z()));
    const double dphi = std::atan2(wo.y(), wo.x()) - std::atan2(wi.y(), wi.x());
    return (1 - 0.5 * s2 / (s2 + 0.33) +
            0.45 * s2 / (s2 + 0.09) * std::max(0.0, std::cos(dphi)) * std::sin(std::max(to, ti)) *
                std::tan(std::min(to, ti))) /
           std::numbers::pi;
}

}  // namespace lull::test
