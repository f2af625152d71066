// Alternates between two textures, square by square or cube by cube.
#pragma once

#include "renderer/scene/textures/mapping.h"

namespace lull {

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

template <typename T>
T Evaluate(const Checkerboard<T>& board, const TextureTable& table, const TextureContext& c) {
    const bool second =
        std::visit([&](const auto& mapping) { return IsSecondColor(mapping, c); }, board.mapping);
    return table.Evaluate(second ? board.tex2 : board.tex1, c);
}

template <typename T>
SurfaceNeeds Needs(const Checkerboard<T>& board, const TextureTable& table) {
    const auto* mapping = std::get_if<Mapping2D>(&board.mapping);
    return (mapping ? Needs(*mapping) : kNeedsNothing) | table.Needs(board.tex1) |
           table.Needs(board.tex2);
}

// Constant 1 substitutes a dimension other than 2 and 3.
template <typename T>
Made<T, Checkerboard<T>> MakeCheckerboard(const TextureInput& input);

}  // namespace lull
