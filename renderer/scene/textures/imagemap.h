// Looks up image files.
#pragma once

#include <type_traits>

#include "renderer/base/math.h"
#include "renderer/base/variant.h"
#include "renderer/image/image.h"
#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/texture_image.h"

namespace lull {

// Interpolates images bilinearly. Texel (i, j) of a w by h image has its centre at
// ((i + 0.5) / w, (j + 0.5) / h), as in pbrt-v3.

enum class Wrap : uint8_t { Repeat, Black, Clamp, Mirror };

// The four texels around a point and their weights. The indices are always inside the
// image, whatever the point; a texel outside a black-wrapped image has weight 0.
struct Footprint {
    int x0, x1, y0, y1;
    float w00, w10, w01, w11;  // of (x0, y0), (x1, y0), (x0, y1), (x1, y1)
};

// The two texels around a coordinate, and their weights.
struct Footprint1D {
    int i0, i1;
    float w0, w1;
};

// The comparisons are arranged so that NaN and infinity fail them: such a point reads texel 0.
inline Footprint1D RepeatFootprint(float s, int n) {
    float fraction = s - std::floor(s);
    fraction = fraction < 1 ? fraction : 0;
    const float x = fraction * float(n) - 0.5f;
    const float lower = std::floor(x);
    const int i = int(lower);
    return {i < 0 ? n - 1 : i, i + 1 == n ? 0 : i + 1, 1 - (x - lower), x - lower};
}

inline Footprint1D BoundedFootprint(float s, int n, bool blackOutside) {
    const float x = std::min(std::max(-2.f, s * float(n) - 0.5f), float(n) + 1);
    const float lower = std::floor(x);
    const int i = int(lower);
    Footprint1D f{std::clamp(i, 0, n - 1), std::clamp(i + 1, 0, n - 1), 1 - (x - lower), x - lower};
    if (blackOutside) {
        if (f.i0 != i) f.w0 = 0;
        if (f.i1 != i + 1) f.w1 = 0;
    }
    return f;
}

// Reflects every other copy of the image.
inline Footprint1D MirrorFootprint(float s, int n) {
    const float pair = 0.5f * s;
    float fraction = pair - std::floor(pair);
    fraction = fraction < 1 ? 2 * fraction : 0;
    return BoundedFootprint(fraction < 1 ? fraction : 2 - fraction, n, false);
}

inline Footprint1D WrapFootprint(float s, int n, Wrap wrap) {
    if (wrap == Wrap::Repeat) return RepeatFootprint(s, n);
    if (wrap == Wrap::Mirror) return MirrorFootprint(s, n);
    return BoundedFootprint(s, n, wrap == Wrap::Black);
}

// Wraps each axis its own way.
inline Footprint BilinearFootprint(const Vec2f& st, int width, int height, Wrap wrapS, Wrap wrapT) {
    const Footprint1D x = WrapFootprint(st.x(), width, wrapS);
    const Footprint1D y = WrapFootprint(st.y(), height, wrapT);
    return {x.i0, x.i1, y.i0, y.i1, x.w0 * y.w0, x.w1 * y.w0, x.w0 * y.w1, x.w1 * y.w1};
}

// Returns the weighted mean of the texels of a footprint: a float for one channel, RGB for three.
// `stride` is the number of channels stored; `decode` maps a stored value to float.
template <int Channels, typename T, typename Decode>
auto Blend(const T* texels, int stride, int width, const Footprint& f, const Decode& decode) {
    const auto at = [&](int x, int y) {
        return texels + (size_t(y) * size_t(width) + size_t(x)) * size_t(stride);
    };
    const T *t00 = at(f.x0, f.y0), *t10 = at(f.x1, f.y0);
    const T *t01 = at(f.x0, f.y1), *t11 = at(f.x1, f.y1);
    const auto channel = [&](int c) {
        return f.w00 * decode(t00[c]) + f.w10 * decode(t10[c]) + f.w01 * decode(t01[c]) +
               f.w11 * decode(t11[c]);
    };
    if constexpr (Channels == 1)
        return channel(0);
    else
        return Rgb(channel(0), channel(1), channel(2));
}

// Returns a stored value, which counts as linear.
template <typename T>
float ToFloat(T v) {
    return std::is_same_v<T, uint8_t> ? float(v) * (1 / 255.f) : float(v);
}

// Returns the texel of an image as linear RGB, alpha ignored. `texels` are the image's.
template <typename T>
Rgb TexelRgb(const Image& image, const std::vector<T>& texels, int x, int y) {
    const T* t = &texels[(size_t(y) * size_t(image.width) + size_t(x)) * size_t(image.channels)];
    if (image.channels < 3) return Rgb::Constant(ToFloat(t[0]));
    return {ToFloat(t[0]), ToFloat(t[1]), ToFloat(t[2])};
}

// Returns the mean of the texels of an image that is not empty; linear, alpha ignored.
Rgb MeanTexel(const Image& image);

// Looks up an image whose first row is at st.y = 0, as environment maps are; texels count as
// linear, alpha is ignored. The image must not be empty.
inline Rgb BilinearRgb(const Image& image, const Vec2f& st, Wrap wrapS, Wrap wrapT) {
    const Footprint f = BilinearFootprint(st, image.width, image.height, wrapS, wrapT);
    return Visit(image.texels, [&]<typename T>(const std::vector<T>& texels) -> Rgb {
        if (image.channels < 3)
            return Rgb::Constant(
                Blend<1>(texels.data(), image.channels, image.width, f, ToFloat<T>));
        return Blend<3>(texels.data(), image.channels, image.width, f, ToFloat<T>);
    });
}

// Returns the texel at a point of the unit square, the first row at 0; linear, without alpha.
inline Rgb NearestRgb(const Image& image, const Vec2f& st) {
    const auto index = [](float s, int n) { return std::clamp(int(s * float(n)), 0, n - 1); };
    return Visit(image.texels, [&](const auto& texels) {
        return TexelRgb(image, texels, index(st.x(), image.width), index(st.y(), image.height));
    });
}

// Makes 8-bit texels, alpha apart, linear, as sRGB has them; others are linear already.
void DecodeBytes(Image* image);

template <typename T>
struct ImageMap {
    Mapping2D mapping;
    std::shared_ptr<const TextureImage> image;  // never null; grey where T is float
    float scale;
    Wrap wrap, wrapT;      // across and up the image
    bool inverts = false;  // to 1 - scale * texel, at least 0
};

inline float Inverted(float v) { return std::max(0.f, 1 - v); }
inline Rgb Inverted(const Rgb& v) { return (1 - v).max(0.f); }

template <typename T>
T Evaluate(const ImageMap<T>& map, const TextureTable&, const TextureContext& c) {
    const TextureImage& image = *map.image;
    const Vec2f st = Map(map.mapping, c);
    const Footprint f = BilinearFootprint(st, image.width, image.height, map.wrap, map.wrapT);
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
    const T value = map.scale * Visit(image.texels, blend);
    return map.inverts ? Inverted(value) : value;
}

// Reads "filename" or "embeddedimage" (into Description::images), "gamma" (the file is
// sRGB-encoded; by default as its extension suggests) or, of pbrt-v4, "encoding" ("sRGB", "linear"
// or "gamma" and an exponent, which PNG files heed), "scale" (after linearisation), "invert" (after
// that), "channel" (of a float texture: "red", "green", "blue", "alpha" or, as in pbrt-v4, "mean or
// alpha" instead of the luminance), "wrap" ("repeat", "black", "clamp", "mirrored"; "wrapt" for the
// second axis alone) and the mapping. "trilinear" and "maxanisotropy" have no effect: the finest
// level is interpolated. pbrt-v3's grey substitutes unreadable images.
template <typename T>
Made<T, ImageMap<T>> MakeImageMap(const TextureInput& input);

}  // namespace lull
