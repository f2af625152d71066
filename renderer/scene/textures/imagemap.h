// Looks up image files.
#pragma once

#include "renderer/scene/textures/image_lookup.h"
#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/texture_image.h"

namespace lull {

template <typename T>
struct ImageMap {
    Mapping2D mapping;
    std::shared_ptr<const TextureImage> image;  // never null; grey where T is float
    float scale;
    Wrap wrap, wrapT;  // across and up the image
};

template <typename T>
T Evaluate(const ImageMap<T>& map, const TextureTable&, const TextureContext& c) {
    const TextureImage& image = *map.image;
    const Vec2f st = Map(map.mapping, c);
    const Footprint f = map.wrap == map.wrapT
                            ? BilinearFootprint(st, image.width, image.height, map.wrap)
                            : BilinearFootprint(st, image.width, image.height, map.wrap, map.wrapT);
    const auto blend = [&](const auto& texels) -> T {
        using Stored = typename std::decay_t<decltype(texels.values)>::value_type;
        constexpr int channels = std::decay_t<decltype(texels)>::kChannels;
        const auto decode = [&](Stored v) {
            if constexpr (std::is_same_v<Stored, uint8_t>)
                return image.decode[v];
            else
                return float(v);
        };
        if constexpr (channels == 1 && std::is_same_v<T, Rgb>)
            return Rgb::Constant(Blend<1>(texels.values.data(), 1, image.width, f, decode));
        else if constexpr (channels == 1 || std::is_same_v<T, Rgb>)
            return Blend<channels>(texels.values.data(), channels, image.width, f, decode);
        else
            return T();  // never: float textures have grey images
    };
    return map.scale * Visit(image.texels, blend);
}

template <typename T>
SurfaceNeeds Needs(const ImageMap<T>& map, const TextureTable&) {
    return Needs(map.mapping);
}

// Reads "filename" or "embeddedimage" (into Description::images), "gamma" (the file is
// sRGB-encoded; by default as its extension suggests), "scale" (after linearisation), "channel" (of
// a float texture: "red", "green", "blue" or "alpha" instead of the luminance), "wrap" ("repeat",
// "black", "clamp", "mirrored"; "wrapt" for the second axis alone) and the mapping. "trilinear" and
// "maxanisotropy" have no effect: the finest level is interpolated. pbrt-v3's grey substitutes an
// image that cannot be read.
template <typename T>
Made<T, ImageMap<T>> MakeImageMap(const TextureInput& input);

}  // namespace lull
