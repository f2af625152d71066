#include "renderer/bsdf/albedo.h"

#include "renderer/bsdf/lobe_albedo_internal.h"

namespace lull {

Rgb AlbedoOf(const Bsdf& bsdf, const Vec3f& woWorld) {
    const Vec3f wo = bsdf.FrameTowards(woWorld).ToLocal(woWorld);
    Rgb sum = Rgb::Zero();
    if (wo.z() == 0) return sum;
    for (int i = 0; i < bsdf.LobeCount(LobeSet::All); ++i)
        sum += VisitLobe(bsdf.At(i), [&](const auto& lobe) { return Albedo(lobe, wo, ToColor{}); });
    for (float& c : sum) c = c > 0 ? std::min(c, 1.f) : 0;
    return sum;
}

}  // namespace lull
