// Textures that are constants, mixtures of others, and patterns of these.
#pragma once

#include <fmt/core.h>

#include "renderer/base/variant.h"
#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/noise.h"
#include "renderer/scene/textures/texture_image.h"
#include "stopping/base/input_file.h"

namespace lull {

// Makes "constant" textures, which leave nothing to evaluate.
template <typename T>
TextureHandle<T> MakeConstant(const TextureInput& input) {
    return {GetValue<T>(input, "value", 1)};
}

template <typename T>
struct Scale {
    TextureHandle<T> tex1, tex2;
};

template <typename T>
T Evaluate(const Scale<T>& scale, const TextureTable& table, const TextureContext& c) {
    return table.Evaluate(scale.tex1, c) * table.Evaluate(scale.tex2, c);
}

template <typename T>
Made<T, Scale<T>> MakeScale(const TextureInput& input) {
    const auto tex1 = GetTexture<T>(input, "tex1", 1);
    const auto tex2 = GetTexture<T>(input, "tex2", 1);
    if (tex1.IsConstant() && tex2.IsConstant())
        return TextureHandle<T>{tex1.constant * tex2.constant};
    if (IsConstant(tex1, 1) || IsConstant(tex2, 0)) return tex2;
    if (IsConstant(tex2, 1) || IsConstant(tex1, 0)) return tex1;
    return Scale<T>{tex1, tex2};
}

template <typename T>
struct MixTexture {
    TextureHandle<T> tex1, tex2;
    FloatTexture amount;  // 0: tex1; 1: tex2; not clamped
};

template <typename T>
T Evaluate(const MixTexture<T>& mix, const TextureTable& table, const TextureContext& c) {
    const float amount = table.Evaluate(mix.amount, c);
    return (1 - amount) * table.Evaluate(mix.tex1, c) + amount * table.Evaluate(mix.tex2, c);
}

template <typename T>
Made<T, MixTexture<T>> MakeMix(const TextureInput& input) {
    const MixTexture<T> mix{GetTexture<T>(input, "tex1", 0), GetTexture<T>(input, "tex2", 1),
                            GetTexture<float>(input, "amount", 0.5f)};
    if (IsConstant(mix.amount, 0)) return mix.tex1;
    if (IsConstant(mix.amount, 1)) return mix.tex2;
    if (mix.tex1.IsConstant() && mix.tex2.IsConstant()) {
        const T &a = mix.tex1.constant, &b = mix.tex2.constant;
        if (AllEqual(a, b)) return mix.tex1;
        if (mix.amount.IsConstant())
            return TextureHandle<T>{T((1 - mix.amount.constant) * a + mix.amount.constant * b)};
    }
    return mix;
}

// Interpolates by the angle between the surface's normal and a direction, as pbrt-v4.
template <typename T>
struct DirectionMix {
    TextureHandle<T> tex1, tex2;
    Vec3f direction;  // unit, world
};

template <typename T>
T Evaluate(const DirectionMix<T>& mix, const TextureTable& table, const TextureContext& c) {
    const float amount = c.n ? std::min(std::abs(c.n->dot(mix.direction)), 1.f) : 1;
    return amount * table.Evaluate(mix.tex1, c) + (1 - amount) * table.Evaluate(mix.tex2, c);
}

template <typename T>
Made<T, DirectionMix<T>> MakeDirectionMix(const TextureInput& input) {
    const Vec3f given = input.entity.parameters.GetVector3("dir", Vec3f::UnitY());
    const Vec3f direction = TransformVector(input.entity.worldFromTexture, given);
    if (!(direction.norm() > 0))
        throw Error(input.entity.loc, "\"dir\" of a directionmix has no length");
    return DirectionMix<T>{GetTexture<T>(input, "tex1", 0), GetTexture<T>(input, "tex2", 1),
                           direction.normalized()};
}

// Interpolates between four values, one at each corner of the unit square of a mapping.
template <typename T>
struct Bilerp {
    Mapping2D mapping;
    T v00, v01, v10, v11;  // at (s, t) = (0, 0), (0, 1), (1, 0), (1, 1); extrapolated outside
};

template <typename T>
T Evaluate(const Bilerp<T>& bilerp, const TextureTable&, const TextureContext& c) {
    const Vec2f st = Map(bilerp.mapping, c);
    const float s = st.x(), t = st.y();
    return (1 - s) * (1 - t) * bilerp.v00 + (1 - s) * t * bilerp.v01 + s * (1 - t) * bilerp.v10 +
           s * t * bilerp.v11;
}

// Reads the corners, which are constants in pbrt-v3: textures are not looked up there.
template <typename T>
Made<T, Bilerp<T>> MakeBilerp(const TextureInput& input) {
    return Bilerp<T>{MakeMapping2D(input), GetValue<T>(input, "v00", 0),
                     GetValue<T>(input, "v01", 1), GetValue<T>(input, "v10", 0),
                     GetValue<T>(input, "v11", 1)};
}

// Shows texture coordinates as red and green: for debugging parametrisations.
struct UvColors {
    Mapping2D mapping;
};

inline Rgb Evaluate(const UvColors& uv, const TextureTable&, const TextureContext& c) {
    const Vec2f st = Map(uv.mapping, c);
    return {st.x() - std::floor(st.x()), st.y() - std::floor(st.y()), 0};
}

inline Made<Rgb, UvColors> MakeUvColors(const TextureInput& input) {
    return UvColors{MakeMapping2D(input)};
}

// Alternates between two textures, square by square or cube by cube.
//
// Without differentials pbrt-v3's "closedform" antialiasing also takes one point, so that one kind
// serves both values of "aamode".
template <typename T>
struct Checkerboard {
    std::variant<Mapping2D, Mapping3D> mapping;  // as "dimension" says
    TextureHandle<T> tex1, tex2;
};

// Returns whether floor(x) is odd; in float, since x may exceed every integer type.
inline bool IsOdd(float x) {
    const float lower = std::floor(x);
    return lower - 2 * std::floor(lower * 0.5f) != 0;
}

inline bool IsSecondColor(const Mapping2D& mapping, const TextureContext& c) {
    const Vec2f st = Map(mapping, c);
    return IsOdd(st.x()) != IsOdd(st.y());
}

inline bool IsSecondColor(const Mapping3D& mapping, const TextureContext& c) {
    const Vec3f p = Map(mapping, c);
    return (IsOdd(p.x()) != IsOdd(p.y())) != IsOdd(p.z());
}

inline SurfaceNeeds Needs(const std::variant<Mapping2D, Mapping3D>& mapping) {
    const auto* plane = std::get_if<Mapping2D>(&mapping);
    return plane ? Needs(*plane) : kNeedsNothing;
}

template <typename T>
T Evaluate(const Checkerboard<T>& board, const TextureTable& table, const TextureContext& c) {
    const bool second =
        Visit(board.mapping, [&](const auto& mapping) { return IsSecondColor(mapping, c); });
    return table.Evaluate(second ? board.tex2 : board.tex1, c);
}

// Constant 1 substitutes a dimension other than 2 and 3.
template <typename T>
Made<T, Checkerboard<T>> MakeCheckerboard(const TextureInput& input) {
    const TextureEntity& entity = input.entity;
    const int dimension = entity.parameters.GetInt("dimension", 2);
    Checkerboard<T> board{Mapping3D{}, GetTexture<T>(input, "tex1", 1),
                          GetTexture<T>(input, "tex2", 0)};
    if (dimension != 2 && dimension != 3) {
        input.warnings.Substitute(
            entity.loc, fmt::format("{}-dimensional checkerboard is not supported", dimension),
            "1 stands in");
        return TextureHandle<T>{Filled<T>(1)};
    }

    if (dimension == 2) {
        board.mapping = MakeMapping2D(input);
        const std::string mode = entity.parameters.GetString("aamode", "closedform");
        if (mode != "none" && mode != "closedform")
            input.warnings.Add(entity.loc, "unknown aamode of checkerboard ignored",
                               Printable(mode));
    } else {
        board.mapping = MakeMapping3D(input);
    }
    if (board.tex1.IsConstant() && board.tex2.IsConstant() &&
        AllEqual(board.tex1.constant, board.tex2.constant))
        return board.tex1;
    return board;
}

// Scatters discs over the unit squares of a mapping, at most one per square.
template <typename T>
struct Dots {
    Mapping2D mapping;
    TextureHandle<T> tex1, tex2;  // in the dots, around them
};

// Returns whether the point lies in a disc of radius 0.35, placed by noise within its square.
inline bool IsInDot(const Vec2f& st) {
    constexpr float kRadius = 0.35f, kMaxShift = 0.5f - kRadius;
    const float s = std::floor(st.x() + 0.5f), t = std::floor(st.y() + 0.5f);
    const auto noise = [](float x, float y) { return Noise(Vec3f(x, y, 0.5f)); };
    if (!(noise(s + 0.5f, t + 0.5f) > 0)) return false;
    const Vec2f center(s + kMaxShift * noise(s + 1.5f, t + 2.8f),
                       t + kMaxShift * noise(s + 4.5f, t + 9.8f));
    return (st - center).squaredNorm() < Sqr(kRadius);
}

template <typename T>
T Evaluate(const Dots<T>& dots, const TextureTable& table, const TextureContext& c) {
    return table.Evaluate(IsInDot(Map(dots.mapping, c)) ? dots.tex1 : dots.tex2, c);
}

// pbrt-v3 passes "inside" and "outside" in the wrong order, so that the dots show "outside". Scenes
// made for pbrt-v3 rely on it, so it is kept.
template <typename T>
Made<T, Dots<T>> MakeDots(const TextureInput& input) {
    const TextureHandle<T> inside = GetTexture<T>(input, "inside", 1);
    const TextureHandle<T> outside = GetTexture<T>(input, "outside", 0);
    return Dots<T>{MakeMapping2D(input), outside, inside};
}

}  // namespace lull
