// Makes a pair of images for which other programs have computed the figures that tests expect.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lull {

inline constexpr int kExampleWidth = 64, kExampleHeight = 48;

struct ExampleImages {
    std::vector<uint8_t> reference, image;  // 8-bit sRGB

    // Makes ramps with a checkerboard, and the same with noise of up to 20 from a linear
    // congruential generator.
    ExampleImages() {
        uint32_t state = 1;
        for (int y = 0; y < kExampleHeight; ++y)
            for (int x = 0; x < kExampleWidth; ++x)
                for (int c = 0; c < 3; ++c) {
                    const int v =
                        (x * (c + 2) + y * (3 - c)) % 200 + ((x / 8 + y / 8) % 2 ? 40 : 0);
                    state = state * 1664525u + 1013904223u;
                    const int noise = int((state >> 24) % 41) - 20;
                    reference.push_back(uint8_t(v));
                    image.push_back(uint8_t(std::clamp(v + noise, 0, 255)));
                }
    }
};

}  // namespace lull
