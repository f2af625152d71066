#include "renderer/scene/materials/material_inputs.h"

namespace lull {

std::optional<SpectrumTexture> SpectrumOrNone(const MaterialReader& in, const char* name) {
    const Parameters& params = in.entity.parameters;
    if (!params.GetTexture(name) && params.GetFloats(ParameterType::Spectrum, name).empty())
        return {};
    return in.Spectrum(name, 0);
}

void ApplyBumpMap(const FloatTexture& displacement, const TextureTable& textures,
                  SurfaceInteraction* hit) {
    // Step half a sample's distance where it is known.
    constexpr float kSmallStep = 0.0005f;
    const Vec2f half = 0.5f * (hit->duvdx.cwiseAbs() + hit->duvdy.cwiseAbs());
    const float du = half.x() > 0 ? half.x() : kSmallStep;
    const float dv = half.y() > 0 ? half.y() : kSmallStep;
    const auto height = [&](const Vec3f& p, const Vec2f& uv) {
        const TextureContext at{p, uv, hit->dpdx, hit->dpdy};
        return textures.Evaluate(displacement, at);
    };
    const float h = height(hit->p, hit->uv);
    const float hu = height(hit->p + du * hit->dpdu, hit->uv + Vec2f(du, 0));
    const float hv = height(hit->p + dv * hit->dpdv, hit->uv + Vec2f(0, dv));
    const Vec3f dpdu = hit->dpdu + (hu - h) / du * hit->ns + h * hit->dndu;
    const Vec3f dpdv = hit->dpdv + (hv - h) / dv * hit->ns + h * hit->dndv;
    const Vec3f n = dpdu.cross(dpdv);
    const float length = n.norm();
    if (!(length > 0 && length < kInfinity)) return;
    hit->ns = FaceForward(n / length, hit->n);
    hit->dpdu = dpdu;
    hit->dpdv = dpdv;
}

void ApplyNormalMap(const NormalMap& map, const TextureTable& textures, SurfaceInteraction* hit) {
    const Vec2f& uv = map.secondUv ? hit->uv1 : hit->uv;
    const Rgb stored = textures.Evaluate(map.texture, TextureContext{hit->p, uv});
    const Rgb m = (2 * stored - 1) * Rgb(map.scale, map.scale, 1);

    const Vec3f across = hit->dpdu - hit->ns * hit->ns.dot(hit->dpdu);
    const float length = across.norm();
    if (!(length > 1e-6f * hit->dpdu.norm() && length < kInfinity)) return;
    const Vec3f s = across / length;
    const Vec3f t = FaceForward(hit->ns.cross(s), hit->dpdv);
    const Vec3f n = m.x() * s + m.y() * t + m.z() * hit->ns;
    const float size = n.norm();
    if (!(size > 0 && size < kInfinity) || !(n.dot(hit->n) > 0)) return;
    hit->ns = n / size;
    hit->dpdu = s;
    hit->dpdv = t;
}

}  // namespace lull
