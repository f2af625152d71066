// Gives tests samples without a scene.
#pragma once

#include <atomic>
#include <cmath>

#include "renderer/render/render.h"

namespace lull {

inline FirstHit SyntheticHit(const Vec2f& u, const Vec2i& pixel, uint32_t index) {
    return {.albedo = Rgb(u.x(), u.y(), 0.1f),
            .normal = Vec3f(u.y(), 0, 1),
            .position = Vec3f(1e5f * u.x(), 1, 2),
            .depth = u.x(),
            .object = index,
            .material = uint32_t(pixel.x()),
            .found = u.x() < 0.7f,
            .emission = pixel.x() % 3 == 0 ? Rgb(u.y(), 0, 1e-6f) : Rgb(Rgb::Zero()),
            .weight = 1,
            .offset2 = u.y()};
}

// Returns noise around a smooth image. Like any source it depends only on pixel, index and seed.
// The sums are inexact in double, so that the order of additions shows in the last bits.
inline void SyntheticSample(Sampler& sampler, const Vec2i& pixel, uint32_t index,
                            PathSample* sample) {
    sampler.StartSample(pixel, index);
    const Vec2f u = sampler.Get2D();
    sample->index = index;
    if (sample->AsksForHits())
        sample->hit = sample->features = SyntheticHit(sampler.Get2D(), pixel, index);
    const float smooth = 0.5f + 0.4f * std::sin(0.02f * float(pixel.x() + 2 * pixel.y()));
    const float spike = u.y() < 1e-3f ? 1e9f : 1.f;
    sample->radiance = Rgb(smooth * u.x() * spike, smooth * 1e-5f * u.y(), u.x() * u.y());
    sample->rejected = u.x() < 1e-3f;
}

// Returns the same as a source that counts its samples.
template <typename Count>
SampleSource Counted(std::atomic<Count>* taken) {
    return [taken](Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
        ++*taken;
        SyntheticSample(sampler, pixel, index, sample);
    };
}

// Returns the options of a render of such samples onto a film.
inline RenderOptions Onto(Film* film, RenderOptions options,
                          const SampleSource& source = SyntheticSample) {
    options.source = source;
    options.film = film;
    return options;
}

// Returns whether all sums of both films are the same bits.
inline bool SamePixels(const Film& a, const Film& b) {
    if (!(a.Region() == b.Region())) return false;
    for (int y = a.Region().min.y(); y < a.Region().max.y(); ++y)
        for (int x = a.Region().min.x(); x < a.Region().max.x(); ++x) {
            const FilmPixel p = a.At({x, y}), q = b.At({x, y});
            if (p.sum != q.sum || p.halfSum != q.halfSum || p.count != q.count) return false;
        }
    return a.RejectedCount() == b.RejectedCount();
}

// Returns whether the sums of their layers are, too, however the films are cut into tiles.
inline bool SameSums(const Film& a, const Film& b) {
    const auto layersOf = [](const Film& film) {
        StateWriter writer;
        film.layers.ForEach([&]<typename Kind>(const Kind& kind) {
            Kind::ForEachPlane(
                kind, [&](const char*, const auto& plane) { plane.Put(film.Region(), &writer); });
        });
        return std::move(writer.bytes);
    };
    return SamePixels(a, b) && PlanesOf(a) == PlanesOf(b) && layersOf(a) == layersOf(b);
}

// Stops at a given spp, and records its views.
class ScriptedCriterion : public Criterion {
  public:
    explicit ScriptedCriterion(int stopAt) : stopAt(stopAt) {}
    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }
    Decision Observe(const BlockView& view) override {
        Decision decision;
        decision.checked = true;
        decision.value = view.spp;
        decision.threshold = stopAt;
        decision.stop = view.spp >= stopAt;
        return decision;
    }

  private:
    int stopAt;
};

// A render without a scene that keeps the inputs of a denoiser.

inline const PixelRect kPictureRegion = {{3, 5}, {63, 45}};

struct FeatureRender {
    Film film{kPictureRegion, {.layers = {.features = true}}};

    explicit FeatureRender(int threads, int spp = 36,
                           const SampleSource& source = SyntheticSample) {
        RenderOptions options;
        options.schedule = {.blockSize = 30, .passLength = 6, .cap = spp};
        options.threads = threads;
        options.makeCriterion = [](const BlockInfo&) {
            return std::make_unique<ScriptedCriterion>(1000);
        };
        Render(Onto(&film, options, source));
    }
};

}  // namespace lull
