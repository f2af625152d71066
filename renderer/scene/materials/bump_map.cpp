#include "renderer/scene/materials/bump_map.h"

namespace lull {

void ApplyBumpMap(const FloatTexture& displacement, const TextureTable& textures,
                  SurfaceInteraction* hit) {
    constexpr float kStep = 0.0005f;
    const auto height = [&](const Vec3f& p, const Vec2f& uv) {
        return textures.Evaluate(displacement, TextureContext{p, uv});
    };
    const float h = height(hit->p, hit->uv);
    const float hu = height(hit->p + kStep * hit->dpdu, hit->uv + Vec2f(kStep, 0));
    const float hv = height(hit->p + kStep * hit->dpdv, hit->uv + Vec2f(0, kStep));
    const Vec3f dpdu = hit->dpdu + (hu - h) / kStep * hit->ns + h * hit->dndu;
    const Vec3f dpdv = hit->dpdv + (hv - h) / kStep * hit->ns + h * hit->dndv;
    const Vec3f n = dpdu.cross(dpdv);
    const float length = n.norm();
    if (!(length > 0 && length < kInfinity)) return;
    hit->ns = FaceForward(n / length, hit->n);
    hit->dpdu = dpdu;
    hit->dpdv = dpdv;
}

}  // namespace lull
