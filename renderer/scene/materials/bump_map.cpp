#include "renderer/scene/materials/bump_map.h"

namespace lull {

void ApplyBumpMap(const FloatTexture& displacement, const TextureTable& textures,
                  SurfaceInteraction* hit) {
    // Step half a sample's distance where it is known.
    constexpr float kSmallStep = 0.0005f;
    const Vec2f half = 0.5f * (hit->duvdx.cwiseAbs() + hit->duvdy.cwiseAbs());
    const float du = half.x() > 0 ? half.x() : kSmallStep;
    const float dv = half.y() > 0 ? half.y() : kSmallStep;
    const auto height = [&](const Vec3f& p, const Vec2f& uv) {
        const TextureContext at{p, uv, hit->dpdx, hit->dpdy, hit->duvdx, hit->duvdy};
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

}  // namespace lull
