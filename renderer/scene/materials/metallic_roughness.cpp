#include "renderer/scene/materials/metallic_roughness.h"

#include "renderer/base/math.h"
#include "renderer/bsdf/layered_lobes.h"
#include "renderer/scene/materials/basic.h"

namespace lull {
namespace {

// Below this a microfacet distribution is as narrow as float resolves: a mirror does better. Point
// lights would make fireflies of it, as very few paths find where it shows them.
constexpr float kSmoothAlpha = 1e-3f;

float Factor(const MaterialReader& in, const std::string& name, float otherwise) {
    return std::max(0.f, in.entity.parameters.GetFloat(name + "factor", otherwise));
}

bool UsesSecondUv(const MaterialReader& in, const std::string& name) {
    return in.entity.parameters.GetInt(name + "uv", 0) == 1;
}

UvSlot<FloatTexture> FloatSlot(const MaterialReader& in, const std::string& name,
                               float otherwise = 0) {
    return {in.Float(name, 1), UsesSecondUv(in, name), Factor(in, name, otherwise)};
}

UvSlot<SpectrumTexture, Rgb> ColorSlot(const MaterialReader& in, const std::string& name,
                                       float otherwise = 1) {
    const Rgb factor =
        in.entity.parameters.GetSpectrum(name + "factor", Rgb::Constant(otherwise)).max(0.f);
    return {in.Spectrum(name, 1), UsesSecondUv(in, name), factor};
}

template <typename Texture, typename Factor>
auto Look(const UvSlot<Texture, Factor>& slot, const MaterialInputs& in) {
    if (!slot.secondUv || slot.texture.IsConstant())
        return in.textures.Evaluate(slot.texture, in.context);
    TextureContext context = in.context;
    context.uv = in.hit->uv1;
    return in.textures.Evaluate(slot.texture, context);
}

float Weight(const UvSlot<FloatTexture>& slot, const MaterialInputs& in) {
    return slot.factor == 0 ? 0 : std::clamp(slot.factor * Look(slot, in), 0.f, 1.f);
}

// Of the frame in which light to the view is scattered.
float CosineTowards(const MaterialInputs& in, const Bsdf& bsdf) {
    return std::min(1.f, std::abs(bsdf.FrameTowards(in.hit->wo).n.dot(in.hit->wo)));
}

float AlphaOf(float roughness) { return Sqr(std::clamp(roughness, 0.f, 1.f)); }

}  // namespace

MetallicRoughness::MetallicRoughness(const MaterialReader& in)
    : baseColor(ColorSlot(in, "basecolor")),
      specularColor(ColorSlot(in, "specularcolor")),
      sheenColor(ColorSlot(in, "sheencolor", 0)),
      diffuseTransmissionColor(ColorSlot(in, "diffusetransmissioncolor")),
      metallicRoughness{in.Spectrum("metallicroughness", 1), UsesSecondUv(in, "metallicroughness"),
                        1},
      anisotropy{in.Spectrum("anisotropy", 1), UsesSecondUv(in, "anisotropy"),
                 std::min(Factor(in, "anisotropy", 0), 1.f)},
      specular(FloatSlot(in, "specular", 1)),
      transmission(FloatSlot(in, "transmission")),
      clearcoat(FloatSlot(in, "clearcoat")),
      clearcoatRoughness(FloatSlot(in, "clearcoatroughness")),
      sheenRoughness(FloatSlot(in, "sheenroughness")),
      diffuseTransmission(FloatSlot(in, "diffusetransmission")),
      metallicFactor(Factor(in, "metallic", 1)),
      roughnessFactor(Factor(in, "roughness", 1)),
      ior(in.entity.parameters.GetFloat("ior", 1.5f)),
      anisotropyRotation(in.entity.parameters.GetFloat("anisotropyrotation", 0)),
      solid(in.entity.parameters.GetBool("solid", false)),
      vertexColors(in.entity.parameters.GetBool("vertexcolors", false)),
      addedInterface(in.entity.parameters.GetBool("addedinterface", false)),
      evenInterface(in.entity.parameters.GetBool("eveninterface", false)),
      keepsRadiance(in.entity.parameters.GetBool("keepsradiance", false)) {
    diffuseTransmission.factor = std::min(diffuseTransmission.factor, 1.f);
    // An index of 0 stands for an interface that reflects all (KHR_materials_ior).
    if (ior == 0) return;
    const auto index = InRange(double(ior), 1, 100);
    if (!index || IsAbove(1, double(ior)))
        throw Error(in.entity.loc, "\"ior\" has to be 0 or from 1 to 100");
    ior = float(*index);
}

MaterialTraits MetallicRoughness::Traits(const MaterialReader& in) const {
    const bool isAnisotropic = anisotropy.factor > 0, hasSheen = !IsBlack(sheenColor.factor);
    MaterialTraits traits = in.TraitsOf(4 + (addedInterface || evenInterface) + isAnisotropic +
                                        hasSheen + (diffuseTransmission.factor > 0));
    VisitSlots([&](const auto& slot) {
        if (slot.texture.IsConstant()) return;
        traits.Need(in.textures.Needs(slot.texture));
        if (slot.secondUv) traits.Need(kNeedsSecondUv);
    });
    if (vertexColors) traits.Need(kNeedsColor);
    if (isAnisotropic) traits.Need(kNeedsTangents);  // the frame turns
    // What sheen, the interface, or a coat on one side leaves to the rest depends on the view.
    if (hasSheen || diffuseTransmission.factor > 0 || IsCoatedSolid()) traits.isConstant = false;
    if (keepsRadiance && solid) traits.isConstant = false;  // by the side of the view
    if (CanLetThrough()) traits.needs = traits.needs | kLetsThrough;
    return traits;
}

bool MetallicRoughness::CanLetThrough() const {
    if (solid || transmission.factor == 0) return false;
    const SpectrumTexture& packed = metallicRoughness.texture;
    if (anisotropy.factor > 0 && anisotropy.texture.IsConstant()) return false;
    if (!packed.IsConstant()) return true;
    return metallicFactor * packed.constant.z() < 1 &&
           AlphaOf(roughnessFactor * packed.constant.y()) < kSmoothAlpha;
}

SurfaceTilt MetallicRoughness::Tilt(const MaterialReader& in) const {
    SurfaceTilt tilt = in.BumpMap();
    const SpectrumTexture texture = in.Spectrum("normalmap", -1);
    if (texture.IsConstant() && texture.constant.x() < 0) return tilt;
    const Parameters& parameters = in.entity.parameters;
    tilt.normalMap = NormalMap{texture, parameters.GetFloat("normalscale", 1),
                               parameters.GetInt("normaluv", 0) == 1};
    return tilt;
}

Vec2f MetallicRoughness::Alphas(const MaterialInputs& in, float alpha, Bsdf* bsdf) const {
    if (anisotropy.factor == 0) return {alpha, alpha};
    float strength = anisotropy.factor;
    Vec2f direction(1, 0);
    if (!anisotropy.texture.IsConstant()) {
        const Rgb texel = Look(anisotropy, in);
        direction = Vec2f(2 * texel.x() - 1, 2 * texel.y() - 1);
        const float length = direction.norm();
        direction = length > 1e-3f ? Vec2f(direction / length) : Vec2f(1, 0);
        strength = std::clamp(strength * texel.z(), 0.f, 1.f);
    }
    // The second tangent may point either way.
    const float side = bsdf->Shading().t.dot(in.hit->dpdv) < 0 ? -1 : 1;
    const float c = std::cos(anisotropyRotation), s = std::sin(anisotropyRotation);
    bsdf->Turn(c * direction.x() - s * direction.y(),
               side * (s * direction.x() + c * direction.y()));
    return {Lerp(Sqr(strength), alpha, 1), alpha};
}

// By the specification the layers below get the fraction that sheen, taken as a whole, does not
// reflect: here by the view alone, of which exactly as much is left as the sheen adds.
void MetallicRoughness::AddSheen(const MaterialInputs& in, const CoatAbove& coat,
                                 Bsdf* bsdf) const {
    const Rgb color = (Look(sheenColor, in) * sheenColor.factor).max(0.f).min(1.f);
    if (IsBlack(color)) return;
    const float roughness =
        sheenRoughness.factor > 0 ? sheenRoughness.factor * Look(sheenRoughness, in) : 0;
    const float alpha = std::max(AlphaOf(roughness), CharlieSheen::kLeastAlpha);
    const float cosine = CosineTowards(in, *bsdf);
    const float albedo = SheenAlbedo(cosine, alpha);
    const float kept = std::min(1.f, 1 / std::max(albedo, 1e-6f));  // it reflects all at the most
    bsdf->Scale(0, bsdf->LobeCount(LobeSet::All),
                Rgb::Constant(1 - color.maxCoeff() * std::min(albedo, 1.f)));
    bsdf->Add(CharlieSheen{Rgb(color * (kept * coat.Through(cosine))), alpha});
}

// The interface above takes what it reflects to the view.
void MetallicRoughness::AddDiffuseTransmission(const MaterialInputs& in, float share,
                                               const InterfaceAbove& above, float alpha,
                                               const CoatAbove& coat, Bsdf* bsdf) const {
    const Rgb color = Look(diffuseTransmissionColor, in) * diffuseTransmissionColor.factor;
    const float cosine = CosineTowards(in, *bsdf);
    const float reflected = DirectionalAlbedo(cosine, alpha)(above.f0, above.f90);
    const float left = coat.Through(cosine) * std::max(0.f, 1 - reflected);
    if (!IsBlack(color))
        bsdf->Add(LambertianTransmission{Rgb(share * left * color.max(0.f).min(1.f))});
}

void MetallicRoughness::AddClearcoat(float coat, float alpha, Bsdf* bsdf) const {
    // A mirror shows no lamp that has no size. Surfaces not meant as mirrors, such as Blender's
    // usual coat of roughness 0.03, keep such highlights.
    if (!(alpha > 0))
        bsdf->Add(ThinSpecular{Rgb(Rgb::Constant(0.04f * coat)), coat, Rgb(Rgb::Zero()),
                               InterfaceAbove{}, 0});
    else  // the distribution has its own least alpha
        bsdf->Add(MicrofacetReflection<SchlickInterface>{
            Rgb(Rgb::Constant(coat)), TrowbridgeReitz(alpha, alpha), SchlickInterface{0.04f}});
}

void MetallicRoughness::AddOwnInterface(const Rgb& f0, float f90, float eta, bool isSmooth,
                                        const Vec2f& alphas, Bsdf* bsdf) const {
    const TrowbridgeReitz distribution(alphas.x(), alphas.y());
    const StretchedInterface interface { f0, f90, evenInterface ? 1 : eta };
    if (isSmooth)
        bsdf->Add(SpecularReflection<StretchedInterface>{Rgb(Rgb::Ones()), interface});
    else if (addedInterface)
        bsdf->Add(MicrofacetReflection<StretchedInterface, SeparableMasking>{
            Rgb(Rgb::Ones()), distribution, interface});
    else
        bsdf->Add(MicrofacetReflection<CoatedInterface>{
            f0, distribution, CoatedInterface{Rgb(Rgb::Ones()), 1, CoatAbove(0, 0)}});
}

void MetallicRoughness::AddSolid(const MaterialInputs& in, const Rgb& reflected, Rgb through,
                                 bool isSmooth, const Vec2f& alphas, Bsdf* bsdf) const {
    const float index = ior == 0 ? 100 : ior;
    if (keepsRadiance)
        through *= bsdf->Shading().n.dot(in.hit->wo) > 0 ? Sqr(index) : 1 / Sqr(index);
    else
        bsdf->SetEta(index);
    AddDielectricLobes(reflected, through, index, isSmooth, {alphas.x(), alphas.y()}, bsdf);
}

void MetallicRoughness::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    Rgb color = (Look(baseColor, in) * baseColor.factor).max(0.f).min(1.f);
    if (vertexColors) color = (color * in.hit->color).max(0.f).min(1.f);
    const Rgb packed = Look(metallicRoughness, in);
    const float metallic = std::clamp(metallicFactor * packed.z(), 0.f, 1.f);
    const float roughness = roughnessFactor * packed.y();
    const Vec2f alphas = Alphas(in, AlphaOf(roughness), bsdf);
    const bool isAnisotropic = alphas.x() != alphas.y();
    // Where one number has to do, it is that of as large a highlight.
    const float alpha = isAnisotropic ? std::sqrt(alphas.x() * alphas.y()) : alphas.x();

    // The dielectric's interface (KHR_materials_specular), and how the material is divided into
    // metal, dielectric over a diffuse base and dielectric that transmits.
    const float strength = Weight(specular, in);
    const Rgb tint = Look(specularColor, in) * specularColor.factor;
    const Rgb f0 = strength * (Sqr((ior - 1) / (ior + 1)) * tint).max(0.f).min(1.f);
    const InterfaceAbove above{f0.maxCoeff(), strength};
    const bool isOwn = addedInterface || evenInterface;
    const InterfaceAbove aboveBase = isOwn ? InterfaceAbove{} : above;
    const float dielectric = 1 - metallic;
    const float transmitting = dielectric * Weight(transmission, in);
    // A coat lies on the outside of a solid, and on both sides of all else.
    const bool isInside = IsCoatedSolid() && in.hit->wo.dot(in.hit->n) < 0;
    const float coatWeight = isInside ? 0 : Weight(clearcoat, in);
    const float coatAlpha = AlphaOf(clearcoatRoughness.factor > 0
                                        ? clearcoatRoughness.factor * Look(clearcoatRoughness, in)
                                        : 0);
    const CoatAbove coat(addedInterface ? 0 : coatWeight, coatAlpha);
    const bool isSmooth = alpha < kSmoothAlpha && !isAnisotropic;
    const float toOtherSide = Weight(diffuseTransmission, in);
    const Rgb diffuse = (dielectric - transmitting) * (1 - toOtherSide) * color;
    const Rgb base = isOwn ? Rgb(Rgb::Zero()) : diffuse;  // below the interface

    // A thin rough sheet and a base below reflect by the same interface, in one lobe.
    const bool together = !solid && !isSmooth;
    const float reflecting = together ? dielectric : dielectric - transmitting;
    const Rgb r0 = reflecting * f0 + metallic * color;
    const float r90 = reflecting * strength + metallic;
    if (isOwn && r90 > 0) {
        const float root = std::sqrt(std::min(above.f0 / std::max(strength, 1e-6f), 0.98f));
        AddOwnInterface(r0, r90, (1 + root) / (1 - root), isSmooth, alphas, bsdf);
    } else if (isSmooth && r90 > 0) {
        bsdf->Add(ThinSpecular{r0, r90, Rgb(Rgb::Zero()), above, coat});
    } else if (isAnisotropic && r90 > 0) {
        bsdf->Add(MicrofacetReflection<CoatedInterface>{
            Rgb(Rgb::Ones()), TrowbridgeReitz(alphas.x(), alphas.y()), {r0, r90, coat}});
    }
    const bool isApart = isOwn || isSmooth || isAnisotropic;
    const Rgb glossy = isApart ? Rgb(Rgb::Zero()) : r0;
    const float glossy90 = isApart ? 0 : r90;
    if (glossy90 > 0 || ((r90 > 0 || coatWeight > 0) && !IsBlack(base)))
        bsdf->Add(LayeredReflection(base, glossy, glossy90, alpha, aboveBase, coat));
    else if (!IsBlack(base))
        bsdf->Add(LambertianReflection{base});
    if (evenInterface && !IsBlack(diffuse))
        bsdf->Add(LambertianReflection{diffuse});
    else if (addedInterface && !IsBlack(diffuse))
        bsdf->Add(
            DisneyDiffuse{diffuse, std::clamp(roughness, 0.f, 1.f), DisneyDiffuse::Part::Whole});

    const Rgb through = transmitting * color;
    if (transmitting > 0 && solid) {
        const float left = IsCoatedSolid() ? coat.Through(CosineTowards(in, *bsdf)) : 1;
        AddSolid(in, left * (transmitting * strength * tint).max(0.f).min(1.f), left * through,
                 isSmooth, alphas, bsdf);
    } else if (transmitting > 0 && isSmooth) {
        bsdf->Add(
            ThinSpecular{Rgb(transmitting * f0), transmitting * strength, through, above, coat});
    } else if (!IsBlack(through)) {
        bsdf->Add(ThinTransmission{through, alpha, above, coat});
    }

    if (const float share = (dielectric - transmitting) * toOtherSide; share > 0)
        AddDiffuseTransmission(in, share, aboveBase, isSmooth ? 0 : alpha, coat, bsdf);
    AddSheen(in, coat, bsdf);
    if (coatWeight > 0) AddClearcoat(coatWeight, coatAlpha, bsdf);
}

}  // namespace lull
