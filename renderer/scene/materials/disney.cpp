#include "renderer/scene/materials/disney.h"

#include "renderer/base/color.h"

namespace lull {

Disney::Disney(const MaterialReader& in)
    : color(in.ShareOfColors("color", 0.5f)),
      scatterDistance(in.Spectrum("scatterdistance", 0)),
      metallic(in.Share("metallic", 0)),
      eta(in.Float("eta", 1.5f)),
      rough(in.Float("roughness", 0.5f)),
      specularTint(in.Share("speculartint", 0)),
      anisotropic(in.Share("anisotropic", 0)),
      sheen(in.Share("sheen", 0)),
      sheenTint(in.Share("sheentint", 0.5f)),
      clearcoat(in.Share("clearcoat", 0)),
      clearcoatGloss(in.Share("clearcoatgloss", 1)),
      specTrans(in.Share("spectrans", 0)),
      thin(in.entity.parameters.GetBool("thin", false)),
      flatness(in.Share("flatness", 0)),
      diffTrans(in.Float("difftrans", 1)) {}

MaterialTraits Disney::Traits(const MaterialReader& in) const {
    const auto canBe = [](const FloatTexture& t) { return !(t.IsConstant() && t.constant <= 0); };
    // Base, retro-reflection and specular reflection; in addition of thin ones a flat base and
    // transmission.
    const int most = 3 + 2 * thin + canBe(sheen) + canBe(clearcoat) + canBe(specTrans);
    MaterialTraits traits =
        in.TraitsOf(most, color, scatterDistance, metallic, eta, rough, specularTint, anisotropic,
                    sheen, sheenTint, clearcoat, clearcoatGloss, specTrans, flatness, diffTrans);
    if (!(anisotropic.IsConstant() && anisotropic.constant == 0))
        traits.needs = traits.needs | kNeedsTangents;
    if (!thin && !IsAlwaysBlack(scatterDistance)) traits.Need(kScattersBelow | kNeedsTangents);
    return traits;
}

void Disney::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    using Part = DisneyDiffuse::Part;
    const Rgb c = in.Color(color);
    const float metal = in(metallic), index = in.Index(eta), through = in(specTrans);
    const float roughness = in(rough), transmitted = in(diffTrans) / 2;
    const float diffuse = (1 - metal) * (1 - through);
    const float luminance = Luminance(c);
    const Rgb tint = luminance > 0 ? Rgb(c / luminance) : Rgb(Rgb::Ones());
    const auto tinted = [&](float amount) { return Rgb((1 - amount) + amount * tint); };
    // As in pbrt-v3 a part whose weight is black stays among those to choose from.
    const auto add = [&](const Rgb& r, Part part) {
        bsdf->Add(DisneyDiffuse{Rgb(r.max(0.f)), roughness, part});
    };
    if (diffuse > 0) {
        if (thin) {
            const float flat = in(flatness);
            add(diffuse * (1 - flat) * (1 - transmitted) * c, Part::Base);
            add(diffuse * flat * (1 - transmitted) * c, Part::FakeSubsurface);
        } else {
            if (Profile(in))
                bsdf->Add(SpecularTransmission{Rgb(1, 1, 1), index});
            else
                add(diffuse * c, Part::Base);
        }
        add(diffuse * c, Part::RetroReflection);
        if (const float weight = in(sheen); weight > 0)
            add(diffuse * weight * tinted(in(sheenTint)), Part::Sheen);
    }

    const float aspect = std::sqrt(std::max(0.01f, 1 - in(anisotropic)*0.9f));
    const auto distribution = [&](float r) {
        return TrowbridgeReitz(Sqr(r) / aspect, Sqr(r) * aspect);
    };
    const Rgb dielectricR0 = Sqr((index - 1) / (index + 1)) * tinted(in(specularTint));
    const Rgb r0 = (1 - metal) * dielectricR0 + metal * c;
    bsdf->Add(
        DisneyReflection{Rgb(1, 1, 1), distribution(roughness), DisneyInterface{r0, metal, index}});
    if (const float weight = in(clearcoat); weight > 0) {
        // A coat of alpha 1 would be a quotient of zeros.
        const float alpha = std::clamp(Lerp(in(clearcoatGloss), 0.1f, 0.001f), 1e-4f, 0.99f);
        bsdf->Add(DisneyClearcoat{Rgb(weight, weight, weight), alpha});
    }
    if (through > 0) {
        // Its root, since light goes through two surfaces of a body.
        const Rgb t = through * c.sqrt();
        if (thin)
            bsdf->Add(MicrofacetTransmission{t, distribution((0.65f * index - 0.35f) * roughness),
                                             ResolvableIndex(index)});
        else
            bsdf->Add(DisneyTransmission{t, distribution(roughness), ResolvableIndex(index)});
    }
    if (thin) bsdf->Add(LambertianTransmission{Rgb((transmitted * c).max(0.f))});
}

std::optional<SubsurfaceProfile> Disney::Profile(const MaterialInputs& in) const {
    if (thin || IsAlwaysBlack(scatterDistance)) return {};
    const Rgb distance = in.Color(scatterDistance);
    const float diffuse = (1 - in(metallic)) * (1 - in(specTrans));
    if (!(diffuse > 0) || IsBlack(distance)) return {};
    return SubsurfaceProfile(BurleyProfile(diffuse * in.Color(color), distance), in.Index(eta));
}

}  // namespace lull
