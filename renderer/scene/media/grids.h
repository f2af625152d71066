// Fields of density, colour and temperature in the unit cube.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Values at the centres of cells, linear between them and 0 beyond the outermost.
template <typename T>
struct Grid {
    Vec3i size = Vec3i::Ones();
    std::vector<T> values;  // x fastest, then y

    T operator()(const Vec3f& p) const;
};

// Does so for absorption and scattering by channel, the same everywhere where not given.
struct RgbDensity {
    std::optional<Grid<Rgb>> sigmaA = {}, sigmaS = {};
    float otherwise = 1;
};

// Density of pbrt-v4's clouds: noise from 0 to 1, thinner higher up, in the box from p0 on.
struct CloudDensity {
    Vec3f p0, diagonal;
    float density, wispiness, frequency;

    float operator()(const Vec3f& p) const;
};

// A grid of 8x8x8 bricks, of which those with one value throughout need no more.
struct SparseGrid {
    struct Brick {
        float value = 0;  // unless there are stored ones
        float most = 0;   // the greatest value in it and up to the first of the bricks behind
        int stored = -1;  // which of the bricks that `values` are of; -1: none
    };
    static constexpr int kSide = 8, kValues = kSide * kSide * kSide;

    Vec3i size = Vec3i::Ones();  // in bricks
    std::vector<Brick> bricks;   // x fastest, then y
    std::vector<float> values;   // z fastest, then y
    float background = 0;        // outside
    // Where the unit cube is, in units of voxels, from the first value on.
    Mat3f scale = Mat3f::Identity();
    Vec3f offset = Vec3f::Zero();

    Brick& At(const Vec3i& brick) {
        return bricks[(size_t(brick.z()) * size.y() + brick.y()) * size.x() + brick.x()];
    }
    const Brick& At(const Vec3i& brick) const { return const_cast<SparseGrid*>(this)->At(brick); }
    float Value(const Vec3i& voxel) const;
    float operator()(const Vec3f& p) const;
    // Finds Brick::most of all.
    void BoundBricks();
};

// Radiance of black bodies, whose spectra are 1 at their peaks (pbrt-v4).
struct Temperatures {
    std::variant<Grid<float>, SparseGrid> grid;
    float offset, scale;           // kelvin: (value - offset) * scale
    float step = 1;                // kelvin
    std::vector<Rgb> colors = {};  // from kColdest on; colder ones are black
    static constexpr float kColdest = 100;

    Rgb operator()(const Vec3f& p) const;
};

}  // namespace lull
