#include "renderer/scene/textures/texture.h"

#include <fmt/core.h>

#include "renderer/base/variant.h"
#include "renderer/scene/kinds.h"
#include "renderer/scene/textures/imagemap.h"
#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/noise.h"
#include "renderer/scene/textures/patterns.h"
#include "stopping/base/input_file.h"

namespace lull {

template <typename T, typename... More>
using AllTextureKinds =
    std::variant<Scale<T>, MixTexture<T>, ImageMap<T>, Checkerboard<T>, Fbm<T>, Bilerp<T>, Dots<T>,
                 Windy<T>, Wrinkled<T>, DirectionMix<T>, More...>;

struct FloatTextureNode {
    AllTextureKinds<float> kind;
};

struct SpectrumTextureNode {
    AllTextureKinds<Rgb, Marble, UvColors> kind;
};

namespace {

template <typename Node>
using TypeOf = std::conditional_t<std::is_same_v<Node, FloatTextureNode>, float, Rgb>;

template <typename Node>
using Nodes = std::vector<Node>;

template <typename Node>
using TextureKind = Kind<TextureHandle<TypeOf<Node>>(const TextureInput&, Nodes<Node>*)>;

// Adapts a maker to the table of kinds: puts a new texture into the nodes.
template <auto Make, typename Node>
TextureHandle<TypeOf<Node>> AddNode(const TextureInput& input, Nodes<Node>* nodes) {
    using Handle = TextureHandle<TypeOf<Node>>;
    auto made = Make(input);
    if constexpr (std::is_same_v<decltype(made), Handle>) {
        return made;
    } else {
        return Visit(made, [&]<typename T>(T& texture) -> Handle {
            if constexpr (std::is_same_v<T, Handle>) {
                return texture;
            } else {
                nodes->push_back({std::move(texture)});
                return {Filled<TypeOf<Node>>(0), int(nodes->size()) - 1};
            }
        });
    }
}

template <typename Node, typename T = TypeOf<Node>>
constexpr TextureKind<Node> kKinds[] = {
    {"constant", AddNode<MakeConstant<T>>},
    {"scale", AddNode<MakeScale<T>>},
    {"mix", AddNode<MakeMix<T>>},
    {"imagemap", AddNode<MakeImageMap<T>>},
    {"fbm", AddNode<MakeOctaves<T, FractionalBrownianMotion>>},
    {"checkerboard", AddNode<MakeCheckerboard<T>>},
    {"bilerp", AddNode<MakeBilerp<T>>},
    {"directionmix", AddNode<MakeDirectionMix<T>>},
    {"dots", AddNode<MakeDots<T>>},
    {"windy", AddNode<MakeWindy<T>>},
    {"wrinkled", AddNode<MakeOctaves<T, Turbulence>>},
};

constexpr TextureKind<SpectrumTextureNode> kColorKinds[] = {
    {"marble", AddNode<MakeMarble>},
    {"uv", AddNode<MakeUvColors>},
};

template <typename Node>
TextureHandle<TypeOf<Node>> MakeTexture(const TextureInput& input, Nodes<Node>* nodes) {
    const TextureEntity& entity = input.entity;
    const TextureKind<Node>* kind = FindKind(kKinds<Node>, entity.name);
    if constexpr (std::is_same_v<Node, SpectrumTextureNode>)
        if (!kind) kind = FindKind(kColorKinds, entity.name);
    if (kind) {
        const auto handle = kind->make(input, nodes);
        entity.parameters.ReportUnused(fmt::format("texture \"{}\"", Printable(entity.textureName)),
                                       input.warnings);
        return handle;
    }
    const std::string what = fmt::format("{} texture \"{}\": kind \"{}\" is not supported",
                                         entity.isSpectrum ? "spectrum" : "float",
                                         Printable(entity.textureName), Printable(entity.name));
    input.warnings.Substitute(entity.loc, what, "1 stands in");
    return {Filled<TypeOf<Node>>(1)};
}

template <typename T>
TextureHandle<T> Resolve(const std::vector<TextureHandle<T>>& made, const Parameter& parameter,
                         const TextureRef& ref) {
    const bool wantsFloat = std::is_same_v<T, float>;
    const int index = wantsFloat ? ref.floatIndex : ref.spectrumIndex;
    if (index >= 0 && size_t(index) < made.size()) return made[size_t(index)];
    const bool isOther = (wantsFloat ? ref.spectrumIndex : ref.floatIndex) >= 0;
    throw Error(
        parameter.loc, "parameter \"{}\": there is no {} texture \"{}\"{}",
        Printable(parameter.name), wantsFloat ? "float" : "spectrum", Printable(ref.name),
        isOther ? ", only one of the other type" : "; with --substitute the parameter is left out");
}

template <typename T>
std::optional<TextureHandle<T>> Find(const std::vector<TextureHandle<T>>& made,
                                     const Entity& entity, const std::string& name) {
    const Parameters& parameters = entity.parameters;
    if (const TextureRef* ref = parameters.GetTexture(name))
        return Resolve(made, *parameters.Find(ParameterType::Texture, name), *ref);
    // Excess values are ignored, as in pbrt-v3.
    if constexpr (std::is_same_v<T, float>) {
        const auto values = parameters.GetFloats(ParameterType::Float, name);
        if (!values.empty()) return FloatTexture{values[0]};
    } else {
        const auto values = parameters.GetFloats(ParameterType::Spectrum, name);
        if (values.size() >= 3) return SpectrumTexture{Rgb(values[0], values[1], values[2])};
    }
    return std::nullopt;
}

template <typename Node>
SurfaceNeeds NodeNeeds(const Node& node, const TextureTable& table) {
    return Visit(node.kind, [&](const auto& kind) {
        SurfaceNeeds needs = kNeedsNothing;
        if constexpr (requires { kind.mapping; }) needs = Needs(kind.mapping);
        if constexpr (requires { kind.tex1; })
            needs = needs | table.Needs(kind.tex1) | table.Needs(kind.tex2);
        if constexpr (requires { kind.amount; }) needs = needs | table.Needs(kind.amount);
        return needs;
    });
}

}  // namespace

TextureTable::TextureTable() = default;
TextureTable::~TextureTable() = default;
TextureTable::TextureTable(TextureTable&&) noexcept = default;
TextureTable& TextureTable::operator=(TextureTable&&) noexcept = default;

TextureTable::TextureTable(const Description& description, Warnings& warnings) {
    TextureImages images;
    for (const TextureEntity& entity : description.textures) {
        const TextureInput input{entity, description, *this, images, warnings};
        // Each texture takes a place in both lists, so that its index is its place in the
        // description; the one of the other type is never referred to.
        FloatTexture asFloat{0};
        SpectrumTexture asSpectrum{Rgb::Zero()};
        warnings.Try([&] {
            if (entity.isSpectrum)
                asSpectrum = MakeTexture(input, &spectra);
            else
                asFloat = MakeTexture(input, &floats);
        });
        madeFloats.push_back(asFloat);
        madeSpectra.push_back(asSpectrum);
    }
    imageBytes = images.Bytes();
}

FloatTexture TextureTable::GetFloat(const Entity& entity, const std::string& name,
                                    float otherwise) const {
    return Find(madeFloats, entity, name).value_or(FloatTexture{otherwise});
}

SpectrumTexture TextureTable::GetSpectrum(const Entity& entity, const std::string& name,
                                          const Rgb& otherwise) const {
    return Find(madeSpectra, entity, name).value_or(SpectrumTexture{otherwise});
}

std::optional<FloatTexture> TextureTable::GetFloatOrNone(const Entity& entity,
                                                         const std::string& name) const {
    return Find(madeFloats, entity, name);
}

SurfaceNeeds TextureTable::Needs(const FloatTexture& t) const {
    return t.IsConstant() ? kNeedsNothing : NodeNeeds(floats[size_t(t.index)], *this);
}

SurfaceNeeds TextureTable::Needs(const SpectrumTexture& t) const {
    return t.IsConstant() ? kNeedsNothing : NodeNeeds(spectra[size_t(t.index)], *this);
}

float TextureTable::EvaluateFloat(int index, const TextureContext& c) const {
    return Visit(floats[size_t(index)].kind,
                 [&](const auto& kind) { return lull::Evaluate(kind, *this, c); });
}

Rgb TextureTable::EvaluateSpectrum(int index, const TextureContext& c) const {
    return Visit(spectra[size_t(index)].kind,
                 [&](const auto& kind) -> Rgb { return lull::Evaluate(kind, *this, c); });
}

namespace {

constexpr float kInv2Pi = kInvPi / 2;

Vec2f MapPosition(const UvMapping&, const Vec3f&) { return Vec2f::Zero(); }
Vec2f MapPosition(const AffineUvMapping&, const Vec3f&) { return Vec2f::Zero(); }

Vec2f MapPosition(const SphericalMapping& m, const Vec3f& p) {
    const Vec3f d = TransformPoint(m.textureFromWorld, p).normalized();
    const float theta = std::acos(std::clamp(d.z(), -1.f, 1.f));
    const float phi = std::atan2(d.y(), d.x());
    return {theta * kInvPi, (phi < 0 ? phi + 2 * kPi : phi) * kInv2Pi};
}

Vec2f MapPosition(const CylindricalMapping& m, const Vec3f& p) {
    const Vec3f d = TransformPoint(m.textureFromWorld, p).normalized();
    return {(kPi + std::atan2(d.y(), d.x())) * kInv2Pi, d.z()};
}

Vec2f MapPosition(const PlanarMapping& m, const Vec3f& p) {
    return m.offset + Vec2f(p.dot(m.vs), p.dot(m.vt));
}

}  // namespace

Vec2f MapByPosition(const Mapping2D& mapping, const Vec3f& p) {
    return Visit(mapping, [&](const auto& m) { return MapPosition(m, p); });
}

Mapping2D MakeMapping2D(const TextureInput& input) {
    const Parameters& parameters = input.entity.parameters;
    const std::string name = parameters.GetString("mapping", "uv");
    const auto textureFromWorld = [&]() -> Eigen::Matrix4f {
        return input.entity.worldFromTexture.inverse().cast<float>();
    };
    const auto offset = [&] {
        return Vec2f(parameters.GetFloat("udelta", 0), parameters.GetFloat("vdelta", 0));
    };
    if (name == "uv")
        return UvMapping{{parameters.GetFloat("uscale", 1), parameters.GetFloat("vscale", 1)},
                         offset()};
    if (name == "uvaffine") {
        const auto m = parameters.GetFloats(ParameterType::Float, "uvtransform");
        if (m.size() != 6) throw Error(input.entity.loc, "\"uvtransform\" needs six numbers");
        return AffineUvMapping{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}};
    }
    if (name == "spherical") return SphericalMapping{textureFromWorld()};
    if (name == "cylindrical") return CylindricalMapping{textureFromWorld()};
    if (name == "planar")
        return PlanarMapping{parameters.GetVector3("v1", Vec3f::UnitX()),
                             parameters.GetVector3("v2", Vec3f::UnitY()), offset()};
    input.warnings.Substitute(input.entity.loc,
                              fmt::format("texture mapping \"{}\" is not known", Printable(name)),
                              "\"uv\" stands in");
    return UvMapping{};
}

}  // namespace lull
