#include "renderer/scene/media/grids.h"

#include <algorithm>

#include "renderer/base/variant.h"
#include "renderer/scene/textures/noise.h"

namespace lull {
namespace {

template <typename T, typename ValueAt>
T Interpolate(const Vec3f& x, T sum, const ValueAt& valueAt) {
    Vec3i cell;
    Vec3f f;
    for (int i = 0; i < 3; ++i) {
        cell[i] = int(std::floor(x[i]));
        f[i] = x[i] - float(cell[i]);
    }
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3i step(corner & 1, corner >> 1 & 1, corner >> 2);
        float weight = 1;
        for (int i = 0; i < 3; ++i) weight *= step[i] ? f[i] : 1 - f[i];
        valueAt(cell + step, weight, &sum);
    }
    return sum;
}

}  // namespace

template <typename T>
T Grid<T>::operator()(const Vec3f& p) const {
    Vec3f x;
    for (int i = 0; i < 3; ++i) x[i] = std::clamp(p[i], -1.f, 2.f) * float(size[i]) - 0.5f;
    return Interpolate(x, T(values[0] * 0), [&](const Vec3i& c, float weight, T* sum) {
        if ((c.array() < 0).any() || (c.array() >= size.array()).any()) return;
        *sum += weight * values[(size_t(c.z()) * size.y() + c.y()) * size.x() + c.x()];
    });
}

template struct Grid<float>;
template struct Grid<Rgb>;

float CloudDensity::operator()(const Vec3f& p) const {
    const Vec3f at = p0 + p.cwiseProduct(diagonal);
    Vec3f q = frequency * at;
    if (wispiness > 0) {
        constexpr float kDelta = 0.01f;
        float amplitude = 0.05f * wispiness, lambda = 10;
        for (int i = 0; i < 2; ++i) {
            const Vec3f x = lambda * q;
            const float noise = Noise(x);
            for (int axis = 0; axis < 3; ++axis)
                q[axis] += amplitude * (Noise(x + kDelta * Vec3f::Unit(axis)) - noise) / kDelta;
            amplitude *= 0.5f;
            lambda *= 1.99f;
        }
    }
    float sum = 0, amplitude = 0.5f, lambda = 1;
    for (int i = 0; i < 5; ++i) {
        sum += amplitude * Noise(lambda * q);
        amplitude *= 0.5f;
        lambda *= 1.99f;
    }
    sum = std::clamp((1 - at.y()) * 4.5f * density * sum, 0.f, 1.f);
    return std::clamp(sum + 2 * std::max(0.f, 0.5f - at.y()), 0.f, 1.f);
}

float SparseGrid::Value(const Vec3i& voxel) const {
    if ((voxel.array() < 0).any() || (voxel.array() >= kSide * size.array()).any())
        return background;
    const Brick& brick = At({voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3});
    if (brick.stored < 0) return brick.value;
    const int in = (voxel.x() & 7) << 6 | (voxel.y() & 7) << 3 | (voxel.z() & 7);
    return values[size_t(brick.stored) * kValues + size_t(in)];
}

float SparseGrid::operator()(const Vec3f& p) const {
    Vec3f x = scale * p + offset;
    for (int i = 0; i < 3; ++i) x[i] = std::clamp(x[i], -2.f, float(kSide * size[i] + 1));
    return Interpolate(x, 0.f, [&](const Vec3i& voxel, float weight, float* sum) {
        *sum += weight * Value(voxel);
    });
}

void SparseGrid::BoundBricks() {
    for (int z = 0; z < size.z(); ++z)
        for (int y = 0; y < size.y(); ++y)
            for (int x = 0; x < size.x(); ++x) {
                Brick& brick = At({x, y, z});
                float most = brick.value;
                if (brick.stored >= 0) {
                    const auto first = values.begin() + int64_t(brick.stored) * kValues;
                    most = *std::max_element(first, first + kValues);
                }
                for (int corner = 1; corner < 8; ++corner) {
                    const Vec3i step(corner & 1, corner >> 1 & 1, corner >> 2);
                    const Vec3i next = Vec3i(x, y, z) + step;
                    if ((next.array() >= size.array()).any()) continue;
                    if (At(next).stored < 0) {
                        most = std::max(most, At(next).value);
                        continue;
                    }
                    // The side of it that is towards the brick.
                    const Vec3i count = Vec3i::Constant(kSide) - (kSide - 1) * step;
                    for (int i = 0; i < count.prod(); ++i) {
                        const Vec3i in(i % count.x(), i / count.x() % count.y(),
                                       i / count.x() / count.y());
                        most = std::max(most, Value(kSide * next + in));
                    }
                }
                brick.most = most;
            }
}

Rgb Temperatures::operator()(const Vec3f& p) const {
    const float value = Visit(grid, [&](const auto& g) { return g(p); });
    const float x = ((value - offset) * scale - kColdest) / step;
    if (!(x > 0)) return Rgb::Zero();
    const size_t last = colors.size() - 1;
    if (x >= float(last)) return colors[last];
    const float f = x - std::floor(x);
    return (1 - f) * colors[size_t(x)] + f * colors[size_t(x) + 1];
}

}  // namespace lull
