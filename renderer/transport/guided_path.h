// Steps of the path loop at each vertex, with and without a guide.
#pragma once

#include "renderer/guiding/guide_record.h"
#include "renderer/transport/path_state.h"

namespace lull {

// Without a guide, at no cost.
struct Unguided {
    void Enter(const SurfaceVertex&, bool) {}
    void Enter(const MediumVertex&) {}
    float Pdf(float pdf, const Vec3f&) const { return pdf; }
    template <typename Vertex>
    bool Scatter(const Vertex& v, Sampler& sampler, Path* path, bool* isTransmission) {
        return lull::Scatter(v, sampler, path, isTransmission);
    }
    template <typename Media>
    bool SurvivesRoulette(const PathContext<Media>& context, int bounces, Path* path) {
        return lull::SurvivesRoulette(context, bounces, path);
    }
    void End(const Path&) {}
};

// Chooses directions from the guide and the BSDF or phase function, and weighs them by the density
// of both: one-sample multiple importance sampling (Veach 1997, section 9.2.4, balance heuristic).
class Guided {
  public:
    // `usual` is the luminance of which found light is a multiple.
    Guided(const Guide& guide, GuideRecord* record, float usual)
        : guide(guide), record(record), usual(usual) {}

    // Comes to a vertex, where directions are guided or, with `mayGuide` false, are not.
    void Enter(const SurfaceVertex& v, bool mayGuide) {
        LookUp(v.hit.p, mayGuide && v.bsdf.LobeCount(LobeSet::NonSpecular) > 0);
    }
    void Enter(const MediumVertex& v) { LookUp(v.p, true); }

    // Returns the density of sampling w, where `pdf` is that of the BSDF, or phase function, alone.
    // Directions that these cannot sample are not sampled.
    float Pdf(float pdf, const Vec3f& w) const {
        if (fraction == 0 || !(pdf > 0)) return pdf;
        return fraction * guide.Pdf(leaf, w) + (1 - fraction) * pdf;
    }

    // Continues the path; returns false where it ends. Inlined, so that the path needs not lie in
    // memory.
    template <typename Vertex>
    [[gnu::always_inline]] bool Scatter(const Vertex& v, Sampler& sampler, Path* path,
                                        bool* isTransmission) {
        Vec2f u = sampler.Get2D();
        BsdfSample sample;
        float guidePdf = 0;
        if (u.x() < fraction) {
            u.x() = std::min(u.x() / fraction, kOneMinusEpsilon);
            const Vec3f w = guide.Sample(leaf, u, &guidePdf);
            const BsdfValue value = v.Evaluate(w, LobeSet::All);
            if (!(value.pdf > 0) || IsBlack(value.f)) return false;
            sample = {value.f, value.pdf, w, false, false};
        } else {
            if (fraction > 0)
                u.x() = std::min((u.x() - fraction) / (1 - fraction), kOneMinusEpsilon);
            const auto chosen = v.Sample(u, LobeSet::All);
            if (!chosen) return false;
            sample = *chosen;
            if ((fraction > 0 || mayRecord) && !sample.isSpecular)
                guidePdf = guide.Pdf(leaf, sample.wi);
        }
        const float pdf = fraction * guidePdf + (1 - fraction) * sample.pdf;
        Continue(v, sample, pdf, path);
        *isTransmission = sample.isTransmission;
        density *= pdf / sample.pdf;
        if (mayRecord && !sample.isSpecular) {
            visited[count] = {v.Position(), sample.wi, place, pdf, sample.pdf, guidePdf, 0};
            before[count++] = path->L;
        }
        return true;
    }

    // Ends paths by the throughput that they would have without a guide: directions with much light
    // are sampled so often that each path there carries little.
    template <typename Media>
    bool SurvivesRoulette(const PathContext<Media>& context, int bounces, Path* path) {
        return lull::SurvivesRoulette(context, bounces, path, density);
    }

    // Records the path.
    void End(const Path& path) {
        for (int i = 0; i < count; ++i) {
            visited[i].found = Luminance(path.L - before[i]) / usual;
            record->Add(guide, visited[i]);
        }
    }

    // Returns the number of vertices of the path, without the camera.
    int Vertices() const { return vertices; }

  private:
    static constexpr int kMost = 32;  // of a path's vertices that are recorded

    void LookUp(const Vec3f& p, bool mayGuide) {
        ++vertices;
        fraction = 0;
        mayRecord = false;
        if (!mayGuide) return;
        mayRecord = record && count < kMost;
        place = guide.Find(p);
        leaf = guide.Leaf(place);
        fraction = leaf.fraction;
        guide.Prefetch(leaf);
    }

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
