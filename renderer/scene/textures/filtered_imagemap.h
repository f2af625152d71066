// Looks up image files with pbrt-v3's filtering, if asked for.
#pragma once

#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/mip_pyramid.h"

namespace lull {

// Uses the finest level wherever the footprint is not known, which is at all but the camera's hits:
// pbrt-v3's path and volpath carry no ray differentials beyond these either, not even through
// mirrors.
template <typename T>
struct FilteredImageMap {
    Mapping2D mapping;
    std::shared_ptr<const MipPyramid> pyramid;  // never null; of one channel where T is float
    bool trilinear;                             // else EWA
    float maxAnisotropy;
};

template <typename T>
T Evaluate(const FilteredImageMap<T>& map, const TextureTable&, const TextureContext& c) {
    if (c.dpdx.isZero(0) && c.dpdy.isZero(0))
        return map.pyramid->template Bilinear<T>(0, Map(map.mapping, c));
    const MappedFootprint f = MapFootprint(map.mapping, c);
    if (map.trilinear) {
        const float width = std::max(f.dx.cwiseAbs().maxCoeff(), f.dy.cwiseAbs().maxCoeff());
        return map.pyramid->template Trilinear<T>(f.st, width);
    }
    return map.pyramid->template Ewa<T>(f.st, f.dx, f.dy, map.maxAnisotropy);
}

template <typename T>
SurfaceNeeds Needs(const FilteredImageMap<T>& map, const TextureTable&) {
    return Needs(map.mapping) | kNeedsFootprint;
}

}  // namespace lull
