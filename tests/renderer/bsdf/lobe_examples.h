// Lists lobes for tests over all of them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "renderer/bsdf/bsdf.h"

namespace lull::test {

using DielectricReflection = MicrofacetReflection<DielectricInterface>;
using ConductorReflection = MicrofacetReflection<ConductorInterface>;

struct NamedLobe {
    std::string name;
    Lobe lobe;
};

// Returns lobes of every kind that spreads light: smallest to largest alpha, anisotropic both ways,
// either side of the interface denser.
inline std::vector<NamedLobe> SpreadLobes() {
    const Rgb color(0.9f, 0.5f, 0.2f);
    std::vector<NamedLobe> lobes = {
        {"Lambertian reflection", LambertianReflection{color}},
        {"Lambertian transmission", LambertianTransmission{color}},
        {"Oren-Nayar 20", OrenNayar(color, 20)},
        {"Oren-Nayar 90", OrenNayar(color, 90)},
        {"Disney base", DisneyDiffuse{color, 0.3f, DisneyDiffuse::Part::Base}},
        {"Disney subsurface", DisneyDiffuse{color, 0.3f, DisneyDiffuse::Part::FakeSubsurface}},
        {"Disney retro", DisneyDiffuse{color, 0.8f, DisneyDiffuse::Part::RetroReflection}},
        {"Disney whole", DisneyDiffuse{color, 0.3f, DisneyDiffuse::Part::Whole}},
        {"Disney sheen", DisneyDiffuse{color, 0, DisneyDiffuse::Part::Sheen}},
        {"Disney clearcoat", DisneyClearcoat{color, 0.1f}},
        {"Disney reflection",
         DisneyReflection{color, {0.2f, 0.4f}, {Rgb(0.1f, 0.2f, 0.9f), 0.6f, 1.5f}}},
    };
    const Vec2f alphas[] = {{1e-4f, 1e-4f}, {0.01f, 0.01f}, {0.1f, 0.1f}, {0.5f, 0.5f},
                            {1.62f, 1.62f}, {0.05f, 0.4f},  {1, 0.2f}};
    for (const Vec2f& a : alphas) {
        const TrowbridgeReitz d(a.x(), a.y());
        const std::string suffix = fmt::format(" {} {}", a.x(), a.y());
        for (float eta : {1.5f, 1 / 1.5f}) {
            const std::string index = fmt::format("{} index {}", suffix, eta);
            lobes.push_back({"dielectric reflection" + index,
                             DielectricReflection{color, d, DielectricInterface{eta}}});
            lobes.push_back({"transmission" + index, MicrofacetTransmission{color, d, eta}});
        }
        const ConductorInterface copper{Rgb(0.2f, 0.92f, 1.1f), Rgb(3.9f, 2.45f, 2.14f)};
        lobes.push_back({"conductor reflection" + suffix, ConductorReflection{color, d, copper}});
        lobes.push_back({"Fresnel blend" + suffix, FresnelBlend{color, Rgb(0.04f, 0.3f, 1), d}});
    }
    for (const float alpha : {1e-4f, 0.01f, 0.1f, 0.5f, 1.f}) {
        const std::string suffix = fmt::format(" {}", alpha);
        const InterfaceAbove plastic{0.04f, 1}, dense{0.5f, 0.7f};
        const Rgb white(1, 1, 1), gold(1, 0.7f, 0.3f);
        const auto add = [&](const char* name, const Lobe& lobe) {
            lobes.push_back({name + suffix, lobe});
        };
        add("white base below plastic",
            LayeredReflection(white, Rgb::Constant(0.04f), 1, alpha, plastic, 0));
        add("base below dense interface",
            LayeredReflection(color, Rgb(0.5f, 0.1f, 0.3f), 0.7f, alpha, dense, 0));
        add("metal", LayeredReflection(Rgb::Zero(), gold, 1, alpha, plastic, 0));
        add("half metal, coated",
            LayeredReflection(0.5f * color, 0.5f * gold + 0.02f, 1, alpha, plastic, 0.8f));
        add("thin sheet", ThinTransmission{color, alpha, plastic, 0});
        add("thin coated sheet", ThinTransmission{white, alpha, dense, 1});
        // A ridge of 0.0001 by 0.3 fails with conductors as well.
        if (alpha > 0.0005f)
            add("coated reflection",
                MicrofacetReflection<CoatedInterface>{white, TrowbridgeReitz(alpha, 0.3f),
                                                      CoatedInterface{gold, 1, 0.5f}});
        add("stretched interface",
            MicrofacetReflection<StretchedInterface, SeparableMasking>{
                white, TrowbridgeReitz(alpha, alpha), StretchedInterface{gold, 1, 1.5f}});
        if (alpha > 0.05f) add("sheen", CharlieSheen{color, alpha});
        static const CoatTable coats(1.5f, 0.01f);
        float blend;
        const CoatRow* row = coats.RowOf(alpha, &blend);
        add("coated base", CoatedDiffuseLobe{color, TrowbridgeReitz(alpha, alpha), row, blend});
        add("clear coat", MicrofacetReflection<SchlickInterface>{
                              white, TrowbridgeReitz(alpha, alpha), SchlickInterface{0.04f}});
    }
    static const CoatTable smooth(0, 1.5f, 0.01f);
    float blend;
    lobes.push_back(
        {"base below a smooth coat", CoatedDiffuseLobe{color, {0, 0}, smooth.RowOf(0, &blend), 0}});
    return lobes;
}

// Returns lobes of every kind that is perfectly specular.
inline std::vector<NamedLobe> SpecularLobes() {
    const Rgb r(0.9f, 0.5f, 0.2f), t(0.7f, 0.8f, 0.1f);
    std::vector<NamedLobe> lobes = {
        {"mirror", SpecularReflection<PerfectMirror>{r, {}}},
        {"smooth conductor",
         SpecularReflection<ConductorInterface>{r,
                                                {Rgb(0.2f, 0.92f, 1.1f), Rgb(3.9f, 2.45f, 2.14f)}}},
    };
    lobes.push_back({"smooth stretched interface",
                     SpecularReflection<StretchedInterface>{r, {Rgb(0.1f * t), 1, 1.5f}}});
    for (float eta : {1.f, 1.0001f, 1.5f, 1 / 1.5f, 3.f}) {
        const std::string suffix = fmt::format(" {}", eta);
        lobes.push_back({"coat" + suffix, SpecularReflection<DielectricInterface>{r, {eta}}});
        lobes.push_back({"refraction" + suffix, SpecularTransmission{t, eta}});
        lobes.push_back({"glass" + suffix, FresnelSpecular{r, t, eta}});
    }
    lobes.push_back({"thin dielectric", ThinDielectricLobe{r, 1.5f}});
    lobes.push_back({"smooth coat", SpecularReflection<CoatInterface>{r, {1.5f}}});
    lobes.push_back(
        {"coated gold", SpecularReflection<CoatedConductorInterface>{
                            r, {1.5f, 0.01f, Rgb(0.05f, 0.3f, 1), Rgb(3.7f, 1.6f, 1.1f)}}});
    lobes.push_back({"thin glass",
                     ThinSpecular{Rgb(0.04f, 0.04f, 0.04f), 1, t, InterfaceAbove{0.04f, 1}, 0.5f}});
    return lobes;
}

// Returns the alphas of a lobe's distribution, (1, 1) for a lobe that has none.
inline Vec2f AlphasOf(const Lobe& lobe) {
    return VisitLobe(lobe, [](const auto& l) -> Vec2f {
        if constexpr (requires { l.distribution; })
            return {l.distribution.AlphaX(), l.distribution.AlphaY()};
        else if constexpr (requires { l.alpha; })
            return Vec2f::Constant(std::max(l.alpha, 1e-3f));
        else
            return {1, 1};
    });
}

// Returns whether wi is reached from wo over a microfacet whose outside wo sees. Elsewhere
// MicrofacetTransmission has pbrt-v3's values, but is never sampled.
inline bool IsFrontFacing(const Lobe& lobe, const Vec3f& wo, const Vec3f& wi) {
    const auto* t = std::get_if<MicrofacetTransmission>(&lobe);
    if (!t) return true;
    const Vec3f h = wo + (wo.z() > 0 ? t->eta : 1 / t->eta) * wi;
    return wo.dot(h) * wo.z() * h.z() > 0;
}

// Returns a direction that the Bsdf scatters to, but for specular ones.
inline std::optional<Vec3f> SampleSpread(const Bsdf& bsdf, const Vec3f& wo, const Vec2f& u,
                                         LobeSet set) {
    const auto s = bsdf.Sample(wo, u, set);
    return s && !s->isSpecular ? std::optional(s->wi) : std::nullopt;
}

// Makes a Bsdf whose frame is the axes.
inline Bsdf MakeBsdf(const std::vector<Lobe>& lobes, const Vec3f& ng = Vec3f::UnitZ()) {
    Bsdf bsdf({Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()}, ng);
    for (const Lobe& lobe : lobes) bsdf.Add(lobe);
    return bsdf;
}

// Makes the Bsdf of a surface in the plane z = 0, whose map tilts the normal.
inline Bsdf Tilted(const Lobe& lobe, const Vec3f& normal) {
    Frame frame{{}, {}, normal};
    CoordinateSystem(normal, &frame.s, &frame.t);
    Bsdf bsdf(frame, Vec3f::UnitZ(), 1, true);
    bsdf.Add(lobe);
    return bsdf;
}

}  // namespace lull::test
