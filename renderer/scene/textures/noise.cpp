#include "renderer/scene/textures/noise.h"

namespace lull {

namespace {

// Perlin's permutation of 0 to 255.
constexpr uint8_t kPermutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180,
};

// Gradients by the low bits of the hash: bit 0 is the sign of the first component that is not
// zero, bit 1 that of the second.
constexpr float kGradients[16][3] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0},  //
    {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},  //
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1},  //
    {1, 1, 0}, {-1, 1, 0}, {0, 1, -1}, {0, -1, -1},
};

uint8_t Permute(int i) { return kPermutation[i & 255]; }

struct Cell {
    int i;
    float d;

    explicit Cell(float x) {
        if (!(std::abs(x) < 0x1p30f)) x = 0;
        const float lower = std::floor(x);
        i = int(lower) & 255;
        d = x - lower;
    }
};

// Returns the ramp of lattice point (x, y, z), from which the place of interest is (dx, dy, dz).
float Ramp(int x, int y, int z, float dx, float dy, float dz) {
    const float* g = kGradients[Permute(Permute(Permute(x) + y) + z) & 15];
    return g[0] * dx + g[1] * dy + g[2] * dz;
}

// Eases t so that first and second derivatives vanish at lattice points (Perlin 2002, eq. 1b).
float Ease(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float ResolvedOctaves(float spacing2, int octaves) {
    return spacing2 > 0 ? std::clamp(-1 - 0.5f * std::log2(spacing2), 0.f, float(octaves))
                        : float(octaves);
}

// Rises from 0 to 1 as the fraction of an octave that is resolved goes from 0.3 to 0.7.
float Fade(float fraction) {
    const float t = std::clamp((fraction - 0.3f) / 0.4f, 0.f, 1.f);
    return t * t * (3 - 2 * t);
}

// Of pbrt-v3's nine control colours only the first five are ever used (see Evaluate).
constexpr float kColors[5][3] = {
    {0.58f, 0.58f, 0.60f}, {0.58f, 0.58f, 0.60f}, {0.58f, 0.58f, 0.60f},
    {0.50f, 0.50f, 0.50f}, {0.60f, 0.59f, 0.58f},
};
constexpr int kSegments = 6;

}  // namespace

float Noise(const Vec3f& p) {
    const Cell x(p.x()), y(p.y()), z(p.z());
    const float wx = Ease(x.d), wy = Ease(y.d), wz = Ease(z.d);
    float planes[2];
    for (int k = 0; k < 2; ++k) {
        float lines[2];
        for (int j = 0; j < 2; ++j) {
            const float dy = y.d - float(j), dz = z.d - float(k);
            lines[j] = Lerp(wx, Ramp(x.i, y.i + j, z.i + k, x.d, dy, dz),
                            Ramp(x.i + 1, y.i + j, z.i + k, x.d - 1, dy, dz));
        }
        planes[k] = Lerp(wy, lines[0], lines[1]);
    }
    return Lerp(wz, planes[0], planes[1]);
}

float FractionalBrownianMotion(const Vec3f& p, float spacing2, float roughness, int octaves) {
    const float resolved = ResolvedOctaves(spacing2, octaves);
    const int whole = int(resolved);
    float sum = 0, frequency = 1, amplitude = 1;
    for (int i = 0; i < whole; ++i) {
        sum += amplitude * Noise(frequency * p);
        frequency *= 1.99f;
        amplitude *= roughness;
    }
    const float fade = Fade(resolved - whole);
    if (fade > 0) sum += amplitude * fade * Noise(frequency * p);
    return sum;
}

float Turbulence(const Vec3f& p, float spacing2, float roughness, int octaves) {
    const float resolved = ResolvedOctaves(spacing2, octaves);
    const int whole = int(resolved);
    float sum = 0, frequency = 1, amplitude = 1;
    for (int i = 0; i < whole; ++i) {
        sum += amplitude * std::abs(Noise(frequency * p));
        frequency *= 1.99f;
        amplitude *= roughness;
    }
    // As in pbrt-v3 the octave that fades comes on top of the means, even where all are resolved.
    constexpr float kMean = 0.2f;
    sum += amplitude * Lerp(Fade(resolved - whole), kMean, std::abs(Noise(frequency * p)));
    for (int i = whole; i < octaves; ++i) {
        sum += amplitude * kMean;
        amplitude *= roughness;
    }
    return sum;
}

Rgb Evaluate(const Marble& marble, const TextureTable&, const TextureContext& c) {
    const Vec3f p = Map(marble.mapping, c) * marble.scale;
    const float angle =
        p.y() + marble.variation *
                    FractionalBrownianMotion(p, Sqr(marble.scale) * Spacing2(marble.mapping, c),
                                             marble.roughness, marble.octaves);
    float t = (0.5f + 0.5f * std::sin(angle)) * kSegments;
    if (!(t >= 0)) t = 0;  // NaN of an infinite coordinate

    // pbrt-v3 limits the segment to the first two instead of to the last, so that t runs up to 5 on
    // the second and the cubic is extrapolated: to 40 and more. Materials made for pbrt-v3 show it.
    const int first = std::min(1, int(t));
    t -= float(first);

    // Evaluates the Bezier segment by its Bernstein form.
    const float s = 1 - t;
    const float weights[4] = {s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
    Rgb color = Rgb::Zero();
    for (int i = 0; i < 4; ++i) color += weights[i] * Rgb::Map(kColors[first + i]);
    return 1.5f * color;
}

}  // namespace lull
