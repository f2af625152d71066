// What the loop over a path does at each vertex with a guide, and without.
#pragma once

#include "renderer/guiding/guide_record.h"
#include "renderer/transport/path_state.h"

namespace lull {

// Without a guide: what there is anyhow, at no cost.
struct Unguided {
    void Enter(const SurfaceInteraction&, const Bsdf&, bool) {}
    void EnterMedium() {}
    float Pdf(float bsdfPdf, const Vec3f&) const { return bsdfPdf; }
    bool Scatter(const Bsdf& bsdf, const SurfaceInteraction& hit, const Rgb&, Sampler& sampler,
                 Path* path, bool* isTransmission) {
        return lull::Scatter(bsdf, hit, sampler, path, isTransmission);
    }
    bool SurvivesRoulette(float threshold, Sampler& sampler, Path* path) {
        return lull::SurvivesRoulette(threshold, sampler, path);
    }
    void End(const Rgb&) {}
};

// Chooses directions from the guide and the BSDF, and weighs them by the density of both:
// one-sample multiple importance sampling (Veach 1997, section 9.2.4, balance heuristic).
class Guided {
  public:
    // `usual` is the luminance of which found light is a multiple.
    Guided(const Guide& guide, GuideRecord* record, float usual)
        : guide(guide), record(record), usual(usual) {}

    // Comes to a vertex, where directions are guided or, with `mayGuide` false, are not.
    void Enter(const SurfaceInteraction& hit, const Bsdf& bsdf, bool mayGuide) {
        ++vertices;
        fraction = 0;
        mayRecord = false;
        if (!mayGuide || bsdf.LobeCount(LobeSet::NonSpecular) == 0) return;
        mayRecord = record && count < kMost;
        place = guide.Find(hit.p);
        leaf = guide.Leaf(place);
        fraction = leaf.fraction;
        guide.Prefetch(leaf);
    }

    // Comes to a point in a medium.
    void EnterMedium() { ++vertices; }

    // Returns the density of sampling w where the BSDF's alone is `bsdfPdf`. What BSDFs cannot
    // sample is not sampled.
    float Pdf(float bsdfPdf, const Vec3f& w) const {
        if (fraction == 0 || !(bsdfPdf > 0)) return bsdfPdf;
        return fraction * guide.Pdf(leaf, w) + (1 - fraction) * bsdfPdf;
    }

    // Inlined, so that the path needs not lie in memory.
    [[gnu::always_inline]] bool Scatter(const Bsdf& bsdf, const SurfaceInteraction& hit,
                                        const Rgb& L, Sampler& sampler, Path* path,
                                        bool* isTransmission) {
        *isTransmission = false;
        Vec2f u = sampler.Get2D();
        float bsdfPdf, guidePdf = 0;
        Vec3f w;
        Rgb f;
        if (u.x() < fraction) {
            u.x() = std::min(u.x() / fraction, kOneMinusEpsilon);
            w = guide.Sample(leaf, u, &guidePdf);
            const BsdfValue value = bsdf.Evaluate(hit.wo, w, LobeSet::All);
            if (!(value.pdf > 0) || IsBlack(value.f)) return false;
            f = value.f;
            bsdfPdf = value.pdf;
        } else {
            if (fraction > 0)
                u.x() = std::min((u.x() - fraction) / (1 - fraction), kOneMinusEpsilon);
            const auto sample = bsdf.Sample(hit.wo, u, LobeSet::All);
            if (!sample) return false;
            w = sample->wi;
            *isTransmission = sample->isTransmission;
            if (sample->isSpecular) {
                Continue(bsdf, hit, *sample, sample->pdf * (1 - fraction), path);
                density *= 1 - fraction;
                return true;
            }
            f = sample->f;
            bsdfPdf = sample->pdf;
            if (fraction > 0 || mayRecord) guidePdf = guide.Pdf(leaf, w);
        }
        const float pdf = fraction * guidePdf + (1 - fraction) * bsdfPdf;
        const float cosine = std::abs(w.dot(hit.ns));
        path->beta *= f * (cosine / pdf);
        density *= pdf / bsdfPdf;
        path->seesLights = false;
        path->pdf = pdf;
        path->origin = hit.p;
        path->ray = hit.SpawnRay(w);
        if (mayRecord) {
            visited[count] = {hit.p, w, place, pdf, bsdfPdf, guidePdf, 0};
            before[count++] = L;
        }
        return true;
    }

    // Ends paths by what they would carry without a guide: directions with much light are sampled
    // so often that each path there carries little.
    bool SurvivesRoulette(float threshold, Sampler& sampler, Path* path) {
        return lull::SurvivesRoulette(threshold, sampler, path, density);
    }

    // Records the path, which has found L in all.
    void End(const Rgb& L) {
        for (int i = 0; i < count; ++i) {
            visited[i].found = Luminance(L - before[i]) / usual;
            record->Add(guide, visited[i]);
        }
    }

    // Returns how many vertices the path had, beside the camera.
    int Vertices() const { return vertices; }

  private:
    static constexpr int kMost = 32;  // of a path's vertices that are recorded

    const Guide& guide;
    GuideRecord* record;
    float usual;
    uint32_t place = 0;  // of the leaf
    GuideLeaf leaf;
    float fraction = 0;  // of directions at this vertex that come from the guide
    bool mayRecord = false;
    int vertices = 0;
    float density = 1;  // of all directions so far, over that without a guide
    int count = 0;
    std::array<GuideVertex, kMost> visited;
    std::array<Rgb, kMost> before;
};

}  // namespace lull
