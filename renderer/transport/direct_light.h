// Estimates the light that arrives at a vertex of a path directly from lights.
#pragma once

#include "renderer/transport/path_media.h"

namespace lull {

// Returns the light that a sample of light `index` brings to the vertex, weighted against sampling
// of directions. `pmf` is the probability of having chosen the light.
template <typename Media, typename Vertex>
[[gnu::always_inline]] inline Rgb SampleLight(const PathContext<Media>& context, const Vertex& v,
                                              int index, float pmf) {
    const LightTable& lights = context.scene.lights;
    const auto light = lights.Sample(index, v.Position(), context.sampler.Get2D());
    if (!light || IsBlack(light->L)) return Rgb::Zero();
    // With a BSDF ray of its own, direct light is sampled without the specular lobes; the ray that
    // continues the path is sampled from all of them. A light that rays cannot hit keeps
    // pbrt-v3's weight in both, so that the mean stays the same.
    const bool asPbrtV3 = context.estimator == Estimator::PbrtV3;
    const bool hasOwnRay = asPbrtV3 || light->isHidden;
    const BsdfValue value = !hasOwnRay ? v.Evaluate(light->wi, LobeSet::All)
                            : asPbrtV3 ? v.Evaluate(light->wi, LobeSet::NonSpecular)
                                       : v.EvaluateEvenly(light->wi);
    if (IsBlack(value.f)) return Rgb::Zero();
    const float weight = light->isDelta ? 1
                         : hasOwnRay    ? PowerHeuristic(light->pdf, value.pdf)
                                        : PowerHeuristic(light->pdf * pmf, value.pdf);
    const float cosine = v.Cosine(light->wi);
    const Rgb L = value.f * light->L * (cosine * weight / (light->pdf * pmf));
    if constexpr (!Media::kExist) {
        if (IsBlack(L)) return Rgb::Zero();
        const auto seen = context.media.See(context, v, *light);
        Rgb arriving = L;
        if constexpr (Media::kLetThrough) {
            if (IsBlack(seen)) return Rgb::Zero();
            arriving *= seen;
        } else if (!seen) {
            return Rgb::Zero();
        }
        return light->isOnMap ? Rgb(arriving * lights.Radiance(index, *light)) : arriving;
    } else {
        const auto visibility = context.media.See(context, v, *light);
        if (IsBlack(visibility.share)) return Rgb::Zero();
        const Rgb share = light->isOnMap ? Rgb(visibility.share * lights.Radiance(index, *light))
                                         : visibility.share;
        if (light->isDelta || hasOwnRay || !visibility.isOutOfReach.any()) return L * share;
        // Light that no ray can reach keeps pbrt-v3's weight, too.
        const float evenly = PowerHeuristic(light->pdf, v.EvaluateEvenly(light->wi).pdf);
        return visibility.isOutOfReach.select(
                   value.f * light->L * (cosine * evenly / (light->pdf * pmf)), L) *
               share;
    }
}

// Returns the light that a direction sampled for it finds on light `index`: the other half of
// pbrt-v3's direct light. Takes a copy of the context, which so can stay in registers.
template <typename Media, typename Vertex>
Rgb SampleDirectionForLight(PathContext<Media> context, const Vertex& v, int index, float pmf) {
    const Vec2f u = context.sampler.Get2D();
    const Light& light = context.scene.lights[index];
    if (!IsVisible(light)) return Rgb::Zero();
    const auto sample = v.Sample(u, LobeSet::NonSpecular);
    if (!sample) return Rgb::Zero();
    LightHit lightHit;
    Rgb L;
    float lightPdf;
    if (TypeOf(light) == LightType::Infinite) {
        const Emitted found = LeAndPdf(light, v.Position(), sample->wi);
        if (found.pdf == 0 || !context.media.LeavesScene(context, v, sample->wi, &lightHit))
            return Rgb::Zero();
        L = found.L;
        lightPdf = found.pdf;
    } else {
        if (!context.media.MeetsLight(context, v, sample->wi, index, &lightHit)) return Rgb::Zero();
        const SurfaceInteraction& at = lightHit.at;
        L = Le(light, at.n, -sample->wi, lightHit.found);
        lightPdf = Pdf(light, v.Position(), at.p, at.n);
        if (lightPdf == 0) return Rgb::Zero();
    }
    return sample->f * L * lightHit.share *
           (v.Cosine(sample->wi) * PowerHeuristic(sample->pdf, lightPdf) / (sample->pdf * pmf));
}

// Samples direct light as the estimator says, after PlaceOf(): chooses one light of those at the
// vertex, tells the path how likely each was, and the recorder of its light.
template <typename Media, typename Vertex, typename Recorder>
[[gnu::always_inline]] inline Rgb SampleDirectLight(const PathContext<Media>& context,
                                                    const Vertex& v, Recorder& recorder,
                                                    Path* path) {
    path->choice = v.Choice(context.scene.lights, path->lightPlace);
    float pmf;
    const int index = path->choice.Sample(context.sampler.Get1D(), &pmf);
    if (!(pmf > 0)) return Rgb::Zero();
    Rgb L = SampleLight(context, v, index, pmf);
    if (context.estimator == Estimator::PbrtV3)
        L += SampleDirectionForLight(context, v, index, pmf);
    recorder.FindLight(*path, index, L);
    return L;
}

}  // namespace lull
