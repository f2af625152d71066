// Represents the scattering at one hit point: a few lobes in a shading frame.
#pragma once

#include <cassert>
#include <memory>
#include <optional>

#include "renderer/bsdf/lobes.h"

namespace lull {

// Selects the lobes of Bsdf::Evaluate and Sample. Next-event estimation with its own BSDF sample
// leaves perfectly specular lobes out, path continuation takes all.
enum class LobeSet { All, NonSpecular };

struct BsdfSample {
    Rgb f;      // 1/sr; for specular lobes, only f / pdf is meaningful
    float pdf;  // 1/sr; of the whole set, or the discrete probability of a specular choice
    Vec3f wi;   // world, unit
    bool isSpecular, isTransmission;
};

// A shading normal that is tilted may send a mirror's light below the surface. Light to such a
// direction wo is scattered in a turned frame, if that is wanted: its normal lies between both
// normals, where the mirror direction just stays above, as in Cycles. Glossy light still scattered
// below is reflected once more. Diffuse lobes alone are pbrt-v3's.

class Bsdf {
  public:
    static constexpr int kMaxLobes = 8;  // as pbrt-v3; materials that could need more are refused

    // Takes the orthonormal shading frame, the geometric normal (both world) and the relative index
    // of refraction across the surface (1 for opaque surfaces), which only the radiance scale of
    // paths through it needs. `turnsNormal` turns the shading normal where it would reflect into
    // the surface.
    Bsdf(const Frame& shading, const Vec3f& ng, float eta = 1, bool turnsNormal = false)
        : shading(shading),
          ng(ng),
          eta(eta),
          alongNg(shading.n.dot(ng)),
          turnsNormal(turnsNormal) {}

    // Adds a lobe, at most kMaxLobes of them.
    void Add(const Lobe& lobe) {
        assert(lobeCount < kMaxLobes && lobe.index() != 0);
        specularCount += IsSpecular(lobe);
        if (turnsNormal && alongNg < kUntilted) mayTurn |= Mirrors(lobe);
        std::construct_at(&lobes[lobeCount++], lobe);
    }
    // Multiplies f of lobes begin to end - 1.
    void Scale(int begin, int end, const Rgb& scale) {
        for (int i = begin; i < end; ++i) lobes[i] = Scaled(lobes[i], scale);
    }
    void SetEta(float e) { eta = e; }
    // Turns the shading frame about its normal, from s to t, by the angle of this cosine and sine.
    void Turn(float cosine, float sine) {
        const Vec3f s = shading.s;
        shading.s = cosine * s + sine * shading.t;
        shading.t = cosine * shading.t - sine * s;
    }

    int LobeCount(LobeSet set) const {
        return set == LobeSet::All ? lobeCount : lobeCount - specularCount;
    }
    // Returns whether lobes not specular can scatter light from the other side to this one.
    bool Transmits() const;
    const Lobe& At(int i) const { return lobes[i]; }
    float Eta() const { return eta; }
    const Frame& Shading() const { return shading; }
    // Returns the frame in which light to wo is scattered, and whether it is not Shading().
    Frame FrameTowards(const Vec3f& wo) const { return IsTurned(wo) ? TurnedFrame(wo) : shading; }
    bool IsTurned(const Vec3f& wo) const {
        return mayTurn && IsTurned(wo.dot(shading.n), wo.dot(ng));
    }

    // Returns f and the density with which Sample(wo, ., set) chooses wi; both 0 for specular
    // lobes. Directions are world, unit, pointing away. As in pbrt-v3 the geometric normal decides
    // between reflection and transmission. Where float cannot hold one value, both are 0.
    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, LobeSet set) const;

    // Makes Sample choose among LobeSet::All by the share of light that each lobe scatters to wo,
    // and Evaluate return the matching density; LobeSet::NonSpecular is still sampled uniformly.
    // Call it when all lobes have been added, with the wo that will be passed to both.
    void ChooseByShare(const Vec3f& wo);
    // Returns the Bsdf as it was before that.
    Bsdf WithoutShares() const;

    // Returns the share of the light from behind that gets straight through smooth thin sheets to
    // wo, and leaves such light out of all that follows.
    Rgb StraightThrough(const Vec3f& wo) const;
    void BlockStraight();

    // Chooses one lobe of the set, uniformly unless ChooseByShare was called, with u.x and a
    // direction from it. Returns nothing if the choice scatters no light (f or the density is 0).
    std::optional<BsdfSample> Sample(const Vec3f& wo, const Vec2f& u, LobeSet set) const;

  private:
    // Normals whose product is not less are the same.
    static constexpr float kUntilted = 0.999999f;

    // Returns whether world directions are on the same side of the surface, so that lobes reflect.
    bool Reflects(const Vec3f& wo, const Vec3f& wi) const { return wi.dot(ng) * wo.dot(ng) > 0; }
    // Takes the cosines of wo with the shading and the geometric normal.
    bool IsTurned(float cosine, float geometric) const {
        const float mirrored = 2 * cosine * alongNg - geometric;
        return (geometric < 0 ? -mirrored : mirrored) < LeastHeight(std::abs(geometric));
    }
    // Returns a mirror direction's least cosine with the geometric normal; it may be as flat as wo.
    static float LeastHeight(float geometric) { return std::min(0.9f * geometric, 0.01f); }
    Frame TurnedFrame(const Vec3f& wo) const;
    Bsdf Turned(const Vec3f& wo) const;

    const Lobe& Choose(int choice, LobeSet set) const;
    // As Evaluate() and Sample(), in the shading frame; `wo` is local, `woWorld` is not.
    BsdfValue EvaluateHere(const Vec3f& wo, const Vec3f& woWorld, const Vec3f& wiWorld,
                           LobeSet set) const;
    std::optional<BsdfSample> SampleHere(const Vec3f& wo, const Vec3f& woWorld, const Vec2f& u,
                                         LobeSet set) const;
    // `below` is the local direction that the surface reflects to wi; null where there is none.
    BsdfValue EvaluateLocal(const Vec3f& wo, const Vec3f& wi, const Vec3f* below, bool reflects,
                            LobeSet set) const;

    Frame shading;
    Vec3f ng;
    float eta;
    float alongNg;  // shading.n . ng
    bool turnsNormal;
    bool mayTurn =
        false;  // turnsNormal, the normals differ, and a lobe favours the mirror direction
    int lobeCount = 0, specularCount = 0;
    bool hasShares = false;
    std::array<float, kMaxLobes> shares;  // probabilities of lobes, where hasShares
    union {
        std::array<Lobe, kMaxLobes> lobes;  // not cleared, which would take longer than most use
    };
};

// Estimates the share of uniform light that is scattered to wo (world, unit), per channel in [0,
// 1]: as EstimatedAlbedo() does, for all lobes together. Denoisers use it as albedo.
Rgb AlbedoOf(const Bsdf& bsdf, const Vec3f& wo);

}  // namespace lull
