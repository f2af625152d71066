#include "renderer/scene/textures/mapping.h"

#include <fmt/core.h>

#include "renderer/base/variant.h"
#include "stopping/base/input_file.h"

namespace lull {

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
