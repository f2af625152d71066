#include "renderer/scene/materials/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "renderer/base/math.h"
#include "renderer/base/variant.h"
#include "renderer/input/spectrum.h"
#include "renderer/scene/kinds.h"
#include "renderer/scene/materials/basic.h"
#include "renderer/scene/materials/material_inputs.h"
#include "renderer/scene/materials/metallic_roughness.h"
#include "renderer/scene/materials/subsurface.h"
#include "stopping/base/hash.h"
#include "stopping/base/input_file.h"

namespace lull {

struct Mix {
    SpectrumTexture amount;             // of the first; the second gets 1 - amount
    std::optional<FloatTexture> share;  // the amount where it is a number, as in pbrt-v4
    std::array<int, 2> operands;        // into the table, before this one

    explicit Mix(const MaterialReader& in)
        : amount(in.ShareOfColors("amount", 0.5f)),
          share(in.FloatOrNone("share")),
          operands(in.entity.operands) {}

    // A material can only be named after it was made, so there are no cycles.
    std::string Problem(const MaterialReader& in) const;

    MaterialTraits Traits(const MaterialReader& in) const;
    // pbrt-v3 shades a mix in the frame of the first material, so its tilt counts. pbrt-v4 shades
    // one of both by chance; here that is done only where their frames may differ.
    bool IsChosen(const MaterialReader& in) const;
    SurfaceTilt Tilt(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// The functions of a kind are listed in materials/material_inputs.h.
using MaterialKind =
    std::variant<Matte, Plastic, Metal, Glass, Mirror, Uber, Substrate, Translucent, Mix, Interface,
                 Disney, Hair, Fourier, MetallicRoughness, Subsurface, KdSubsurface, CoatedDiffuse,
                 CoatedConductor, ThinDielectric>;

struct Material {
    MaterialKind kind;
    MaterialTraits traits;  // of the lobes
    SurfaceTilt tilt;
    bool isTilted = false;               // by a map
    bool turnsNormal = false;            // of the Bsdf
    bool isChosen = false;               // a mix of which each hit shows one material
    SurfaceNeeds needs = kNeedsNothing;  // of the lobes and of bump maps

    // The lobes where they are constant, so that a hit costs no more than their copy.
    std::vector<Lobe> constantLobes{};
    float constantEta = 1;
};

namespace {

// Adapts constructors to the table of kinds.
template <typename K>
MaterialKind Make(const MaterialReader& in) {
    return K(in);
}

constexpr Kind<MaterialKind(const MaterialReader&)> kMaterials[] = {
    {"matte", Make<Matte>},
    {"plastic", Make<Plastic>},
    {"metal", Make<Metal>},
    {"glass", Make<Glass>},
    {"mirror", Make<Mirror>},
    {"uber", Make<Uber>},
    {"substrate", Make<Substrate>},
    {"translucent", Make<Translucent>},
    {"mix", Make<Mix>},
    {"none", Make<Interface>},
    {"", Make<Interface>},
    {"disney", Make<Disney>},
    {"hair", Make<Hair>},
    {"fourier", Make<Fourier>},
    {"metallicroughness", Make<MetallicRoughness>},
    {"subsurface", Make<Subsurface>},
    {"kdsubsurface", Make<KdSubsurface>},
    {"coateddiffuse", Make<CoatedDiffuse>},
    {"coatedconductor", Make<CoatedConductor>},
    {"thindielectric", Make<ThinDielectric>},
};

void AddLobes(const Material& material, const MaterialInputs& in, Bsdf* bsdf) {
    if (material.traits.isConstant) {
        for (const Lobe& lobe : material.constantLobes) bsdf->Add(lobe);
        bsdf->SetEta(material.constantEta);
    } else {
        Visit(material.kind, [&](const auto& kind) { kind.AddLobes(in, bsdf); });
    }
}

MaterialTraits TraitsOf(const MaterialKind& kind, const MaterialReader& in) {
    return Visit(kind, [&](const auto& k) { return k.Traits(in); });
}

SurfaceTilt TiltOf(const MaterialKind& kind, const MaterialReader& in) {
    return Visit(kind, [&](const auto& k) {
        if constexpr (requires { k.Tilt(in); })
            return k.Tilt(in);
        else
            return in.BumpMap();
    });
}

SurfaceNeeds NeedsOf(const SurfaceTilt& tilt, const TextureTable& textures) {
    SurfaceNeeds needs = kNeedsNothing;
    if (tilt.bump)
        needs =
            kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint | textures.Needs(*tilt.bump);
    if (tilt.normalMap) {
        needs = needs | kNeedsTangents | textures.Needs(tilt.normalMap->texture);
        if (tilt.normalMap->secondUv) needs = needs | kNeedsSecondUv;
    }
    return needs;
}

std::string ProblemOf(const MaterialKind& kind, const MaterialReader& in) {
    const std::string problem = Visit(kind, [&](const auto& k) {
        if constexpr (requires { k.Problem(in); })
            return k.Problem(in);
        else
            return std::string();
    });
    if (problem.empty() && TraitsOf(kind, in).mostLobes > Bsdf::kMaxLobes)
        return fmt::format("material \"{}\" can have more than {} lobes", in.entity.name,
                           Bsdf::kMaxLobes);
    return problem;
}

void FoldConstants(const MaterialReader& in, Material* m) {
    if (!m->traits.isConstant) return;
    Bsdf bsdf({Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()}, Vec3f::UnitZ());
    const MaterialInputs at{in.textures, TextureContext{Vec3f::Zero(), Vec2f::Zero()}, in.made};
    Visit(m->kind, [&](const auto& kind) { kind.AddLobes(at, &bsdf); });
    m->traits.mostLobes = bsdf.LobeCount(LobeSet::All);
    for (int i = 0; i < m->traits.mostLobes; ++i) m->constantLobes.push_back(bsdf.At(i));
    m->constantEta = bsdf.Eta();
}

Material Complete(const MaterialKind& kind, const MaterialReader& in) {
    Material m{.kind = kind, .traits = TraitsOf(kind, in), .tilt = TiltOf(kind, in)};
    m.isTilted = m.tilt.bump || m.tilt.normalMap;
    // Interpolated normals of pbrt-v3's materials are as they are there.
    m.turnsNormal = m.isTilted || std::holds_alternative<MetallicRoughness>(kind);
    m.needs = m.traits.needs | NeedsOf(m.tilt, in.textures);
    if (const Mix* mix = std::get_if<Mix>(&kind); mix && mix->IsChosen(in)) {
        m.isChosen = true;
        for (const int operand : mix->operands) m.needs = m.needs | in.made[operand].needs;
    }
    FoldConstants(in, &m);
    return m;
}

Material MakeMaterial(const MaterialReader& in) {
    const MaterialEntity& entity = in.entity;
    entity.parameters.GetString("type", "");  // MakeNamedMaterial's; already in entity.name
    std::string problem = "material \"" + Printable(entity.name) + "\" is not supported";
    if (const auto* named = FindKind(kMaterials, entity.name)) {
        const MaterialKind kind = named->make(in);
        problem = ProblemOf(kind, in);
        if (problem.empty()) {
            const Material m = Complete(kind, in);
            entity.parameters.ReportUnused("material \"" + entity.name + "\"", in.warnings);
            return m;
        }
    }
    in.warnings.Substitute(entity.loc, problem, "a matte material stands in");
    return Complete(Matte(in), in);
}

// Returns the frame with s along dpdu, which anisotropy refers to; any where dpdu is none.
Frame TangentFrame(const SurfaceInteraction& hit) {
    const Vec3f s = hit.dpdu - hit.ns * hit.ns.dot(hit.dpdu);
    const float length = s.norm();
    Frame frame{s / length, {}, hit.ns};
    // Less is left over from rounding.
    if (length > 1e-4f * hit.dpdu.norm() && length < kInfinity)
        frame.t = hit.ns.cross(frame.s);
    else
        CoordinateSystem(hit.ns, &frame.s, &frame.t);
    return frame;
}

// Returns a number of [0, 1) that a place and a material determine.
float NumberAt(const Vec3f& p, int material) {
    uint64_t state = uint64_t(material);
    for (const float x : p) state = HashWith(state, std::bit_cast<uint32_t>(x));
    return UnitFloat(state);
}

void WarnUnlessShare(const MaterialReader& in, const std::string& name, float least, float most) {
    if (!IsAbove(double(most), 1) && least >= 0) return;
    in.warnings.Add(in.entity.loc,
                    "number outside of 0 to 1: the surface can return more light than it "
                    "receives, as in pbrt-v3",
                    fmt::format("\"{}\" of material \"{}\"", name, Printable(in.entity.name)));
}

}  // namespace

SpectrumTexture MaterialReader::ShareOfColors(const std::string& name, float otherwise) const {
    const SpectrumTexture texture = Spectrum(name, otherwise);
    // Saturated colours have negative components, which count as 0.
    if (texture.IsConstant()) WarnUnlessShare(*this, name, 0, texture.constant.maxCoeff());
    return texture;
}

FloatTexture MaterialReader::Share(const std::string& name, float otherwise) const {
    const FloatTexture texture = Float(name, otherwise);
    if (texture.IsConstant())
        WarnUnlessShare(*this, name, RaisedToZero(texture.constant), texture.constant);
    return texture;
}

SurfaceTilt MaterialReader::BumpMap() const {
    SurfaceTilt tilt;
    tilt.bump = FloatOrNone("bumpmap");
    if (tilt.bump && tilt.bump->IsConstant() && tilt.bump->constant == 0) tilt.bump.reset();
    if (entity.parameters.GetTexture("normals")) tilt.normalMap = NormalMap{Spectrum("normals", 1)};
    return tilt;
}

std::string ProblemOfIndex(const MaterialReader& in, const FloatTexture& index) {
    if (!index.IsConstant() || IsIndexOfRefraction(index.constant)) return "";
    return fmt::format("\"eta\" of material \"{}\" has to lie between 0.01 and 100; it is {}",
                       in.entity.name, index.constant);
}

MaterialTable::MaterialTable(const Description& description, const TextureTable& textures,
                             Warnings& warnings) {
    MaterialEntity plain;
    plain.name = "matte";
    materials.reserve(description.materials.size());
    for (const MaterialEntity& entity : description.materials) {
        const MaterialReader in{entity, textures, materials, description, warnings};
        if (warnings.Try([&] { materials.push_back(MakeMaterial(in)); })) continue;
        const MaterialReader other{plain, textures, materials, description, warnings};
        materials.push_back(Complete(Matte(other), other));
    }
}

MaterialTable::MaterialTable() = default;
MaterialTable::~MaterialTable() = default;
MaterialTable::MaterialTable(MaterialTable&&) noexcept = default;
MaterialTable& MaterialTable::operator=(MaterialTable&&) noexcept = default;

SurfaceNeeds MaterialTable::Needs(int material) const { return materials[material].needs; }

Bsdf MaterialTable::MakeBsdf(const TextureTable& textures, SurfaceInteraction* hit) const {
    const TextureContext context{hit->p, hit->uv, hit->dpdx, hit->dpdy, &hit->n};
    int shown = hit->material;
    while (materials[shown].isChosen) {
        const Mix& mix = std::get<Mix>(materials[shown].kind);
        const bool isFirst = NumberAt(hit->p, shown) < textures.Evaluate(*mix.share, context);
        shown = mix.operands[isFirst ? 0 : 1];
    }
    const Material& material = materials[shown];
    if (material.isTilted) {
        if (material.tilt.bump) ApplyBumpMap(*material.tilt.bump, textures, hit);
        if (material.tilt.normalMap) ApplyNormalMap(*material.tilt.normalMap, textures, hit);
    }
    Frame frame;
    if (material.traits.needs & kNeedsTangents) {
        frame = TangentFrame(*hit);
    } else {
        frame.n = hit->ns;
        CoordinateSystem(frame.n, &frame.s, &frame.t);
    }
    Bsdf bsdf(frame, hit->n, 1, material.turnsNormal);
    AddLobes(material, MaterialInputs{textures, context, materials, hit}, &bsdf);
    return bsdf;
}

std::optional<SubsurfaceProfile> MaterialTable::Profile(const TextureTable& textures,
                                                        const SurfaceInteraction& hit) const {
    const MaterialInputs in{textures, {hit.p, hit.uv, hit.dpdx, hit.dpdy}, materials, &hit};
    return Visit(materials[hit.material].kind,
                 [&](const auto& kind) -> std::optional<SubsurfaceProfile> {
                     if constexpr (requires { kind.Profile(in); })
                         return kind.Profile(in);
                     else
                         return {};
                 });
}

std::string Mix::Problem(const MaterialReader& in) const {
    for (int i = 0; i < 2; ++i) {
        const std::string parameter = "namedmaterial" + std::to_string(i + 1);
        const std::string name = in.entity.parameters.GetString(parameter, "");
        if (operands[i] < 0 || operands[i] >= int(in.made.size()))
            return "\"" + parameter + "\" of a mix: there is no material \"" + Printable(name) +
                   "\"";
    }
    const SurfaceNeeds needs = Traits(in).needs;
    if (needs & kIsInterface) return "a mix of a material and \"none\" is not supported";
    if (needs & kScattersBelow)
        return "a mix with a material that scatters below its surface is not supported; light that "
               "goes in does not come out in pbrt-v3 either";
    return "";
}

MaterialTraits Mix::Traits(const MaterialReader& in) const {
    MaterialTraits traits = in.TraitsOf(0, amount, share);
    for (const int operand : operands) {
        const MaterialTraits& other = in.made[operand].traits;
        traits.needs = traits.needs | other.needs;
        traits.mostLobes += other.mostLobes;
        traits.isConstant &= other.isConstant;
    }
    return traits;
}

bool Mix::IsChosen(const MaterialReader& in) const {
    return share && std::ranges::any_of(operands, [&](int operand) {
               return in.made[operand].isTilted || in.made[operand].isChosen;
           });
}

SurfaceTilt Mix::Tilt(const MaterialReader& in) const { return in.made[operands[0]].tilt; }

void Mix::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb first =
        share ? Rgb::Constant(std::clamp(in(*share), 0.f, 1.f)).eval() : in.Color(amount);
    const Rgb second = (1 - first).max(0.f);
    // As in pbrt-v3 a lobe scaled to black stays among those to choose from.
    const int begin = bsdf->LobeCount(LobeSet::All);
    lull::AddLobes(in.materials[operands[0]], in, bsdf);
    const int middle = bsdf->LobeCount(LobeSet::All);
    const float eta = bsdf->Eta();
    lull::AddLobes(in.materials[operands[1]], in, bsdf);
    bsdf->Scale(begin, middle, first);
    bsdf->Scale(middle, bsdf->LobeCount(LobeSet::All), second);
    bsdf->SetEta(eta);  // pbrt-v3 takes the first material's
}

}  // namespace lull
