// Subpaths of bidirectional path tracing, from the camera or from a light, and the weights of the
// ways in which a path can be put together from two of them.
//
// A path of k vertices is found by k + 1 strategies: with s vertices from a light and t = k - s
// from the camera. Veach's power heuristic (1997, section 9.2; exponent 2) weighs one by n_i p_i,
// the samples that it takes times its density. Sums over the strategies of fewer vertices on one's
// own side follow from vertex to vertex (van Antwerpen 2011; Georgiev 2012), so that a weight costs
// the same at any length. With P(i) the density of vertex i by area from its own side, and Q(i)
// that from the other side,
//
//     sum(i) = (Q(i) / P(i))^2 [c(i) + (Q(i-1) / P(i-1))^2 [c(i-1) + ...]],
//
// where c(i) is n^2 of the strategy that has i vertices on this side, 0 if one of the two vertices
// that it connects scatters into one direction only.
#pragma once

#include "renderer/scene/lights/light_emission.h"
#include "renderer/transport/path_state.h"

namespace lull {

// The way of a subpath from its last vertex to the next.
struct Segment {
    Ray ray;               // of unit direction
    Rgb beta;              // radiance, or power, over the density of the subpath
    float pdf = 1;         // of the direction, 1/sr; from lights at infinity 1/m^2 across it
    Vec3f p, n;            // the last vertex; n zero if it has none
    double density = 1;    // P of the last vertex
    double sum = 0;        // c(i) + (Q(i-1) / P(i-1))^2 [...] of the last vertex
    bool connects = true;  // the last vertex scatters into more than one direction
    bool fromInfinity = false;
};

// Densities of a vertex at which a subpath arrives.
struct Arrival {
    double density = 0;  // P(i)
    double own = 0;      // c(i), if the vertex itself can be connected
    double fewer = 0;    // times the square of the density, 1/sr, of going back: the rest
    // Returns sum(i) / Q(i)^2, where `back` is that density.
    double Sum(float back) const { return (own + Sqr(double(back)) * fewer) / Sqr(density); }
};

// Returns the factor of a density by solid angle, which makes it one by area at a point of normal n
// seen from afar.
inline double PerArea(const Vec3f& n, const Vec3f& d, double distance2) {
    return std::abs(double(n.dot(d))) / distance2;
}

// Arrives at the surface that the segment's ray meets. `own` is c(i).
inline Arrival Arrive(const Segment& segment, const Vec3f& p, const Vec3f& n, double own) {
    const double distance2 = std::max(double((p - segment.p).squaredNorm()), 1e-30);
    const Vec3f& d = segment.ray.d;
    const double across = std::abs(double(n.dot(d)));
    const double back = segment.fromInfinity ? 1 : PerArea(segment.n, d, distance2);
    Arrival arrival;
    arrival.density = double(segment.pdf) * (segment.fromInfinity ? across : across / distance2);
    arrival.own = own;
    arrival.fewer = Sqr(back / segment.density) * segment.sum;
    return arrival;
}

// A surface where a subpath scatters.
struct SubpathVertex {
    SurfaceInteraction hit;  // wo points back along the subpath
    Bsdf bsdf;
    Rgb beta;
    Arrival arrival;

    SubpathVertex(const Scene& scene, const SurfaceInteraction& at, const Rgb& beta,
                  const Arrival& arrival)
        : hit(at),
          bsdf(scene.materials.MakeBsdf(scene.textures, &hit)),
          beta(beta),
          arrival(arrival) {}

    bool Connects() const { return bsdf.LobeCount(LobeSet::NonSpecular) > 0; }

    // Returns the density of wi for light or importance that comes from wo.
    float Pdf(const Vec3f& wo, const Vec3f& wi) const {
        return bsdf.Evaluate(wo, wi, LobeSet::All).pdf;
    }

    // Return f times cosines for the ways from the camera and from a light: light that arrives from
    // wi along wo, with the density of wi; and light that has come from wo along wi, by the square
    // of the indices' ratio and the normals of shading (Veach 1997, 5.3.2), with the density of
    // going from wi to wo.
    BsdfValue TowardsLight(const Vec3f& wi) const {
        BsdfValue value = bsdf.Evaluate(hit.wo, wi, LobeSet::All);
        value.f *= std::abs(wi.dot(hit.ns));
        return value;
    }
    BsdfValue TowardsCamera(const Vec3f& wi) const {
        BsdfValue value = bsdf.Evaluate(wi, hit.wo, LobeSet::All);
        value.f *= ShadingFactor() * std::abs(wi.dot(hit.n));
        return value;
    }
    float ShadingFactor() const {
        const float cosine = std::abs(hit.wo.dot(hit.n));
        return cosine > 0 ? std::abs(hit.wo.dot(hit.ns)) / cosine : 0;
    }
};

// Whether a subpath comes from the camera, and carries importance, or from a light.
enum class Origin { Camera, Light };

// Scatters a subpath at a vertex: makes the segment to the next. Returns false where it ends.
bool Scatter(Origin, const SubpathVertex&, const Vec2f& u, Segment*, bool* isSpecular,
             bool* isTransmission);

// Returns the share of light that gets from one point of a surface to another.
Rgb ShareBetween(const Scene&, const SurfaceInteraction& a, const SurfaceInteraction& b,
                 float time);

// Ends dim subpaths at random as paths end by Estimator::Combined; `brightest` is their throughput.
// Returns false where it ends.
bool SurvivesRoulette(float brightest, int bounces, float threshold, Sampler& sampler, Rgb* beta);

}  // namespace lull
