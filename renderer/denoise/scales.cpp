#include "renderer/denoise/scales.h"

namespace lull {

namespace {

// Adds an image of half the size, linearly interpolated between the centres of its pixels.
void AddEnlarged(const Planes& half, Planes* image) {
    const auto neighbour = [](int i, int size) {
        return std::clamp(i / 2 + (i % 2 == 0 ? -1 : 1), 0, size - 1);
    };
    for (int c = 0; c < image->count; ++c)
        for (int y = 0; y < image->height; ++y) {
            const float* near = half.Row(c, y / 2);
            const float* far = half.Row(c, neighbour(y, half.height));
            float* to = image->Row(c, y);
            for (int x = 0; x < image->width; ++x) {
                const int u = x / 2, v = neighbour(x, half.width);
                to[x] += (9 * near[u] + 3 * (near[v] + far[u]) + far[v]) / 16;
            }
        }
}

}  // namespace

Planes Halved(const Planes& image) {
    Planes half((image.width + 1) / 2, (image.height + 1) / 2, image.count);
    for (int c = 0; c < half.count; ++c)
        for (int y = 0; y < half.height; ++y) {
            const float* first = image.Row(c, 2 * y);
            const float* second = image.Row(c, std::min(2 * y + 1, image.height - 1));
            for (int x = 0; x < half.width; ++x) {
                const int u = 2 * x, v = std::min(u + 1, image.width - 1);
                half.Row(c, y)[x] = (first[u] + first[v] + second[u] + second[v]) / 4;
            }
        }
    return half;
}

Planes Doubled(const Planes& image, int width, int height) {
    Planes doubled(width, height, image.count);
    AddEnlarged(image, &doubled);
    return doubled;
}

Planes WithCoarsePart(Planes fine, const Planes& coarse) {
    Planes change = Halved(fine);
    for (size_t i = 0; i < change.values.size(); ++i)
        change.values[i] = coarse.values[i] - change.values[i];
    AddEnlarged(change, &fine);
    return fine;
}

}  // namespace lull
