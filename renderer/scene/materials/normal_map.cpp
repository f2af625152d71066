#include "renderer/scene/materials/normal_map.h"

namespace lull {

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
