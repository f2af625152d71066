#include "renderer/scene/material.h"

#include <fmt/format.h>

#include "renderer/scene/materials/bump_map.h"
#include "renderer/scene/materials/disney.h"
#include "renderer/scene/materials/fourier.h"
#include "renderer/scene/materials/glass.h"
#include "renderer/scene/materials/hair.h"
#include "renderer/scene/materials/interface.h"
#include "renderer/scene/materials/matte.h"
#include "renderer/scene/materials/metal.h"
#include "renderer/scene/materials/metallic_roughness.h"
#include "renderer/scene/materials/mirror.h"
#include "renderer/scene/materials/mix.h"
#include "renderer/scene/materials/normal_map.h"
#include "renderer/scene/materials/plastic.h"
#include "renderer/scene/materials/substrate.h"
#include "renderer/scene/materials/subsurface.h"
#include "renderer/scene/materials/translucent.h"
#include "renderer/scene/materials/uber.h"

namespace lull {
namespace {

// Lists every kind; what a kind has to provide is in materials/material_inputs.h.
using MaterialKind =
    std::variant<Matte, Plastic, Metal, Glass, Mirror, Uber, Substrate, Translucent, Mix, Interface,
                 Disney, Hair, Fourier, MetallicRoughness, Subsurface, KdSubsurface>;

}  // namespace

struct Material {
    explicit Material(const MaterialKind& kind) : kind(kind) {}

    MaterialKind kind;
    std::optional<FloatTexture> bump;
    std::optional<NormalMap> normalMap;
    bool tilts = false;                      // has one of both
    SurfaceNeeds lobeNeeds = kNeedsNothing;  // of the lobes alone
    SurfaceNeeds needs = kNeedsNothing;      // with the bump map
    int maxLobes = 0;

    // Holds the lobes where no texture varies, so that a hit costs no more than their copy.
    bool isConstant = false;
    std::vector<Lobe> constantLobes;
    float constantEta = 1;
};

namespace {

void AddLobes(const Material& material, const MaterialInputs& in, Bsdf* bsdf) {
    if (material.isConstant) {
        for (const Lobe& lobe : material.constantLobes) bsdf->Add(lobe);
        bsdf->SetEta(material.constantEta);
    } else {
        std::visit([&](const auto& kind) { kind.AddLobes(in, bsdf); }, material.kind);
    }
}

// Makes the kind called `name`; nothing where there is none.
template <size_t I = 0>
std::optional<MaterialKind> MakeKind(const std::string& name, const MaterialReader& in) {
    if constexpr (I == std::variant_size_v<MaterialKind>) {
        return {};
    } else {
        using Kind = std::variant_alternative_t<I, MaterialKind>;
        if (name == Kind::kName) return Kind(in);
        return MakeKind<I + 1>(name, in);
    }
}

// Works out what a material needs and whether it is constant, from its textures and operands.
void Analyse(const TextureTable& textures, std::span<const Material> made, Material* m) {
    m->isConstant = true;
    std::visit(
        [&]<typename Kind>(const Kind& kind) {
            kind.VisitTextures([&](const auto& texture) {
                if (texture.IsConstant()) return;
                m->isConstant = false;
                m->lobeNeeds = m->lobeNeeds | textures.Needs(texture);
            });
            if constexpr (requires { kind.roughness; })
                if (!kind.roughness.IsIsotropic()) m->lobeNeeds = m->lobeNeeds | kNeedsTangents;
            if constexpr (requires { kind.NeedsTangents(); })
                if (kind.NeedsTangents()) m->lobeNeeds = m->lobeNeeds | kNeedsTangents;
            if constexpr (requires { kind.VariesWithHit(); })
                if (kind.VariesWithHit()) m->isConstant = false;
            if constexpr (requires { kind.NeedsUv(); }) {
                m->lobeNeeds = m->lobeNeeds | kNeedsUv;
                m->isConstant = false;
            }
            if constexpr (requires { kind.ExtraNeeds(); }) {
                const SurfaceNeeds extra = kind.ExtraNeeds();
                m->lobeNeeds = m->lobeNeeds | extra;
                if (extra != kNeedsNothing) m->isConstant = false;
            }
            if constexpr (std::is_same_v<Kind, Mix>) {
                for (int operand : kind.operands) {
                    const Material& o = made[operand];
                    m->isConstant &= o.isConstant;
                    m->lobeNeeds = m->lobeNeeds | o.lobeNeeds;
                    m->maxLobes += o.maxLobes;
                }
                // pbrt-v3 shades a mix in the frame of the first material, so its bump map counts.
                m->bump = made[kind.operands[0]].bump;
                m->normalMap = made[kind.operands[0]].normalMap;
            } else {
                m->maxLobes = kind.MaxLobes();
            }
            if constexpr (std::is_same_v<Kind, Interface>) {
                m->lobeNeeds = kIsInterface;
                m->bump.reset();
            }
        },
        m->kind);
    m->needs = m->lobeNeeds;
    if (m->bump) {
        m->needs = m->needs | kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint |
                   textures.Needs(*m->bump);
    }
    if (m->normalMap) {
        m->needs = m->needs | kNeedsTangents | textures.Needs(m->normalMap->texture);
        if (m->normalMap->secondUv) m->needs = m->needs | kNeedsSecondUv;
    }
    m->tilts = m->bump || m->normalMap;
}

// Reads "normalmap" with "normalscale" and "normaluv" (1: the second texture coordinates), which
// only glTF's materials have.
std::optional<NormalMap> ReadNormalMap(const MaterialReader& in) {
    const SpectrumTexture texture = in.Spectrum("normalmap", -1);
    if (texture.IsConstant() && texture.constant.x() < 0) return {};
    const Parameters& parameters = in.entity.parameters;
    return NormalMap{texture, parameters.GetFloat("normalscale", 1),
                     parameters.GetInt("normaluv", 0) == 1};
}

}  // namespace

std::string ProblemOfIndex(const MaterialReader& in, const FloatTexture& index) {
    if (!index.IsConstant() || IsIndexOfRefraction(index.constant)) return "";
    return fmt::format("\"eta\" of material \"{}\" has to lie between 0.01 and 100; it is {}",
                       in.entity.name, index.constant);
}

namespace {

// Throws what is wrong, or warns of it where a matte material may stand in.
void Refuse(const MaterialEntity& entity, const std::string& problem, bool substitute,
            Warnings& warnings) {
    if (!substitute) throw Error(entity.loc, problem);
    warnings.Add(entity.loc, problem + "; a matte material stands in");
}

Material MakeMaterial(const Description& description, const MaterialEntity& entity,
                      const TextureTable& textures, std::span<const Material> made, bool substitute,
                      Warnings& warnings) {
    const MaterialReader in{entity, textures, made, description};
    entity.parameters.GetString("type", "");  // MakeNamedMaterial's; already in entity.name
    const auto finish = [&](const MaterialKind& kind) {
        Material m(kind);
        if (!std::holds_alternative<Mix>(kind)) m.bump = in.FloatOrNone("bumpmap");
        if (m.bump && m.bump->IsConstant() && m.bump->constant == 0) m.bump.reset();
        if (std::holds_alternative<MetallicRoughness>(kind)) m.normalMap = ReadNormalMap(in);
        Analyse(textures, made, &m);
        return m;
    };

    const std::optional<MaterialKind> kind =
        MakeKind(entity.name.empty() ? Interface::kName : entity.name, in);
    if (!kind) {
        Refuse(entity, "material \"" + entity.name + "\" is not modelled", substitute, warnings);
        return finish(Matte(in));
    }
    const std::string problem = std::visit(
        [&](const auto& k) {
            if constexpr (requires { k.Problem(in); })
                return k.Problem(in);
            else
                return std::string();
        },
        *kind);
    if (!problem.empty()) {
        Refuse(entity, problem, substitute, warnings);
        return finish(Matte(in));
    }
    Material m = finish(*kind);
    if (std::holds_alternative<Mix>(*kind) && (m.needs & kIsInterface)) {
        Refuse(entity, "a mix of a material and \"none\" is not modelled", substitute, warnings);
        return finish(Matte(in));
    }
    if (std::holds_alternative<Mix>(*kind) && (m.needs & kScattersBelow)) {
        Refuse(entity,
               "a mix with a material that scatters below its surface is not modelled; light that "
               "goes in does not come out in pbrt-v3 either",
               substitute, warnings);
        return finish(Matte(in));
    }
    if (m.maxLobes > Bsdf::kMaxLobes) {
        Refuse(entity,
               "material \"" + entity.name + "\" can have more than " +
                   std::to_string(Bsdf::kMaxLobes) + " lobes",
               substitute, warnings);
        return finish(Matte(in));
    }
    entity.parameters.ReportUnused("material \"" + entity.name + "\"", warnings);
    return m;
}

// Makes the lobes of a constant material once and for all.
void FoldConstants(const TextureTable& textures, std::span<const Material> made, Material* m) {
    if (!m->isConstant) return;
    Bsdf bsdf({Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()}, Vec3f::UnitZ());
    const MaterialInputs in{textures, TextureContext{Vec3f::Zero(), Vec2f::Zero()}, made};
    std::visit([&](const auto& kind) { kind.AddLobes(in, &bsdf); }, m->kind);
    m->maxLobes = bsdf.LobeCount(LobeSet::All);
    for (int i = 0; i < m->maxLobes; ++i) m->constantLobes.push_back(bsdf.At(i));
    m->constantEta = bsdf.Eta();
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

}  // namespace

void AddOperandLobes(int operand, const MaterialInputs& in, Bsdf* bsdf) {
    AddLobes(in.materials[operand], in, bsdf);
}

MaterialTable::MaterialTable(const Description& description, const TextureTable& textures,
                             bool substitute, Warnings& warnings) {
    materials.reserve(description.materials.size());
    for (const MaterialEntity& entity : description.materials) {
        Material m = MakeMaterial(description, entity, textures, materials, substitute, warnings);
        FoldConstants(textures, materials, &m);
        materials.push_back(std::move(m));
    }
}

MaterialTable::MaterialTable() = default;
MaterialTable::~MaterialTable() = default;
MaterialTable::MaterialTable(MaterialTable&&) noexcept = default;
MaterialTable& MaterialTable::operator=(MaterialTable&&) noexcept = default;

SurfaceNeeds MaterialTable::Needs(int material) const { return materials[material].needs; }

Bsdf MaterialTable::MakeBsdf(const TextureTable& textures, SurfaceInteraction* hit) const {
    const Material& material = materials[hit->material];
    if (material.tilts) {
        if (material.bump) ApplyBumpMap(*material.bump, textures, hit);
        if (material.normalMap) ApplyNormalMap(*material.normalMap, textures, hit);
    }
    Frame frame;
    if (material.lobeNeeds & kNeedsTangents) {
        frame = TangentFrame(*hit);
    } else {
        frame.n = hit->ns;
        CoordinateSystem(frame.n, &frame.s, &frame.t);
    }
    Bsdf bsdf(frame, hit->n);
    AddLobes(material,
             MaterialInputs{textures,
                            {hit->p, hit->uv, hit->dpdx, hit->dpdy, hit->duvdx, hit->duvdy},
                            materials,
                            hit},
             &bsdf);
    return bsdf;
}

std::optional<SubsurfaceProfile> MaterialTable::Profile(const TextureTable& textures,
                                                        const SurfaceInteraction& hit) const {
    const MaterialInputs in{
        textures, {hit.p, hit.uv, hit.dpdx, hit.dpdy, hit.duvdx, hit.duvdy}, materials, &hit};
    return std::visit(
        [&](const auto& kind) -> std::optional<SubsurfaceProfile> {
            if constexpr (requires { kind.Profile(in); })
                return kind.Profile(in);
            else
                return {};
        },
        materials[hit.material].kind);
}

}  // namespace lull
