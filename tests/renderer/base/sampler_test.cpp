#include "renderer/base/sampler.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {
namespace {

constexpr SamplerKind kKinds[] = {SamplerKind::Random, SamplerKind::Sobol,
                                  SamplerKind::SobolHalves};

std::vector<double> Uniform(int cells) { return std::vector<double>(cells, 1.0 / cells); }

int CellOf(const Vec2f& p, int across, int down) {
    return int(p.y() * float(down)) * across + int(p.x() * float(across));
}

// Takes what a path takes: a mix of single and paired dimensions.
std::vector<float> NumbersOf(Sampler* sampler, const Vec2i& pixel, uint32_t index) {
    sampler->StartSample(pixel, index);
    std::vector<float> numbers;
    for (int i = 0; i < 20; ++i) {
        numbers.push_back(sampler->Get1D());
        const Vec2f p = sampler->Get2D();
        numbers.insert(numbers.end(), {p.x(), p.y()});
    }
    return numbers;
}

TEST(Sampler, RandomIsUniform) {
    Sampler sampler(SamplerKind::Random, 5);
    constexpr int kCells = 256, kSamples = 4000, kDimensions = 4;
    // Over the samples of one pixel, and over the pixels with one sample each.
    for (const bool acrossPixels : {false, true})
        for (int dimension = 0; dimension < kDimensions; ++dimension) {
            std::vector<int64_t> single(kCells), paired(kCells);
            for (int k = 0; k < kSamples; ++k) {
                if (acrossPixels)
                    sampler.StartSample({k % 64, k / 64}, 3);
                else
                    sampler.StartSample({17, 4}, k);
                for (int i = 0; i < dimension; ++i) sampler.Get1D();
                ++single[int(sampler.Get1D() * kCells)];
                ++paired[CellOf(sampler.Get2D(), 16, 16)];
            }
            const double level = test::Significance(4 * kDimensions);
            EXPECT_GT(test::ChiSquarePValue(Uniform(kCells), single, kSamples), level);
            EXPECT_GT(test::ChiSquarePValue(Uniform(kCells), paired, kSamples), level);
        }
}

TEST(Sampler, IsAddressable) {
    for (const SamplerKind kind : kKinds) {
        Sampler forward(kind, 11), backward(kind, 11);
        std::vector<std::vector<float>> first;
        for (int k = 0; k < 200; ++k) first.push_back(NumbersOf(&forward, {k % 7, k % 3}, k));
        for (int k = 199; k >= 0; --k) {
            // Leave a sample of another pixel half used in between.
            backward.StartSample({1000 - k, k}, 5);
            backward.Get2D();
            EXPECT_EQ(NumbersOf(&backward, {k % 7, k % 3}, k), first[k]);
        }
    }
}

TEST(Sampler, DiffersAmongPixelsSamplesAndSeeds) {
    for (const SamplerKind kind : kKinds) {
        std::set<std::vector<float>> seen;
        int count = 0;
        for (const uint64_t seed : {0ull, 1ull, 2ull, 0x100000000ull, ~0ull}) {
            Sampler sampler(kind, seed);
            for (int y = -1; y < 4; ++y)
                for (int x = -1; x < 4; ++x)
                    for (const uint32_t k : {0u, 1u, 2u, 255u, 65536u, 0xffffffffu}) {
                        seen.insert(NumbersOf(&sampler, {x, y}, k));
                        ++count;
                    }
        }
        EXPECT_EQ(int(seen.size()), count);
    }
}

// The first numbers of neighbours (pixels, seeds and, for random, samples) are independent.
TEST(Sampler, IsUncorrelatedAmongNeighbours) {
    constexpr int kPairs = 40000;
    for (const SamplerKind kind : kKinds) {
        Sampler sampler(kind, 0), other(kind, 1);
        for (int what = 0; what < 4; ++what) {
            if (what == 3 && kind != SamplerKind::Random) continue;
            double covariance = 0;
            std::vector<int64_t> cells(256);
            for (int i = 0; i < kPairs; ++i) {
                const Vec2i pixel = 2 * Vec2i(i % 200, i / 200);
                sampler.StartSample(pixel, 4);
                const float a = sampler.Get1D();
                if (what == 0) sampler.StartSample(pixel + Vec2i(1, 0), 4);
                if (what == 1) sampler.StartSample(pixel + Vec2i(0, 1), 4);
                if (what == 2) other.StartSample(pixel, 4);
                if (what == 3) sampler.StartSample(pixel, 5);
                const float b = (what == 2 ? other : sampler).Get1D();
                covariance += (a - 0.5) * (b - 0.5) / kPairs;
                ++cells[CellOf({a, b}, 16, 16)];
            }
            // The standard error of the covariance of uniform numbers is 1 / (12 sqrt(n)).
            EXPECT_LT(std::abs(covariance), 4.5 / (12 * std::sqrt(double(kPairs)))) << what;
            EXPECT_GT(test::ChiSquarePValue(Uniform(256), cells, kPairs), 1e-4) << what;
        }
    }
}

TEST(Sampler, DimensionsAreUncorrelated) {
    constexpr int kSamples = 4096, kDimensions = 12;
    for (const SamplerKind kind : kKinds) {
        Sampler sampler(kind, 3);
        for (int first = 0; first < kDimensions; ++first)
            for (int second = first + 1; second < kDimensions; ++second) {
                std::vector<int64_t> cells(64);
                for (int k = 0; k < kSamples; ++k) {
                    // One sample of many pixels, as Sobol's samples of one pixel are too even.
                    sampler.StartSample({k % 64, k / 64}, 9);
                    float a = 0, b = 0;
                    for (int i = 0; i <= second; ++i) {
                        b = sampler.Get1D();
                        if (i == first) a = b;
                    }
                    ++cells[CellOf({a, b}, 8, 8)];
                }
                EXPECT_GT(test::ChiSquarePValue(Uniform(64), cells, kSamples), 1e-5)
                    << first << " " << second;
            }
    }
}

// Every aligned run of 2^m samples, as later passes are, has one in every elementary interval of
// that size.
TEST(Sampler, SobolPairsAreNets) {
    Sampler sampler(SamplerKind::Sobol, 7);
    constexpr int kDimensions = 24;
    for (const auto& [pixel, start] : {std::pair(Vec2i(0, 0), 0u),
                                       {Vec2i(1, 0), 1u << 10},
                                       {Vec2i(639, 479), 1u << 20},
                                       {Vec2i(-5, 100000), 0xfffffc00u}})
        for (int m = 0; m <= 10; ++m) {
            const int n = 1 << m;
            std::vector<std::vector<Vec2f>> points(kDimensions);
            for (int k = 0; k < n; ++k) {
                sampler.StartSample(pixel, start + uint32_t(k));
                for (auto& p : points) p.push_back(sampler.Get2D());
            }
            for (const auto& p : points)
                for (int across = 0; across <= m; ++across) {
                    std::vector<int> cells(n);
                    for (const Vec2f& q : p) {
                        ASSERT_TRUE(q.minCoeff() >= 0 && q.maxCoeff() < 1);
                        ++cells[CellOf(q, 1 << across, n >> across)];
                    }
                    ASSERT_EQ(std::count(cells.begin(), cells.end(), 1), n) << m << " " << across;
                }
        }
}

TEST(Sampler, SobolHalvesAreNets) {
    Sampler sampler(SamplerKind::SobolHalves, 7);
    for (const bool half : {false, true}) {
        std::vector<int> cells(32);
        for (uint32_t k = 0; k < 64; ++k) {
            if (InHalf(k) != half) continue;
            sampler.StartSample({3, 8}, k);
            ++cells[CellOf(sampler.Get2D(), 8, 4)];
        }
        EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 32) << half;
    }
}

// The halves of one sequence err in opposite directions.
TEST(Sampler, SobolHalvesAreIndependent) {
    constexpr int kPixels = 10000, kSamples = 16;
    const auto correlation = [](SamplerKind kind) {
        Sampler sampler(kind, 5);
        double products = 0, squares = 0;
        for (int pixel = 0; pixel < kPixels; ++pixel) {
            double error[2] = {};
            for (uint32_t k = 0; k < kSamples; ++k) {
                sampler.StartSample({pixel % 100, pixel / 100}, k);
                error[InHalf(k)] += double(sampler.Get2D().prod()) - 0.25;
            }
            products += error[0] * error[1];
            squares += (error[0] * error[0] + error[1] * error[1]) / 2;
        }
        return products / squares;
    };
    EXPECT_NEAR(correlation(SamplerKind::SobolHalves), 0, 4.5 / std::sqrt(double(kPixels)));
    EXPECT_LT(correlation(SamplerKind::Sobol), -0.3);
}

// Defines the points step by step, as the papers have them; the sampler takes short cuts.
namespace slow {

uint64_t Mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

uint32_t ReverseBits(uint32_t x) {
    uint32_t result = 0;
    for (int bit = 0; bit < 32; ++bit) result |= ((x >> bit) & 1) << (31 - bit);
    return result;
}

// Laine and Karras 2011, with the constants of Vegdahl 2021.
uint32_t OwenScramble(uint32_t x, uint32_t seed) {
    x = ReverseBits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return ReverseBits(x);
}

// Multiplies by the generator matrix column by column: each follows from the one before.
uint32_t SobolSecond(uint32_t index) {
    uint32_t result = 0;
    for (uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
        if (index & 1) result ^= v;
    return result;
}

Vec2f Point(uint64_t seed, const Vec2i& pixel, uint32_t index, uint32_t dimension) {
    const uint64_t place = (uint64_t(uint32_t(pixel.y())) << 32) | uint32_t(pixel.x());
    const uint64_t state = Mix(Mix(seed + 0x9e3779b97f4a7c15ull) ^ place);
    const uint64_t h = Mix(state + 0x9e3779b97f4a7c15ull * (dimension + 1));
    const uint64_t g = Mix(h);
    const uint32_t shuffled = OwenScramble(index, uint32_t(h));
    const uint32_t x = OwenScramble(ReverseBits(shuffled), uint32_t(g));
    const uint32_t y = OwenScramble(SobolSecond(shuffled), uint32_t(g >> 32));
    return {float(x >> 8) * 0x1p-24f, float(y >> 8) * 0x1p-24f};
}

}  // namespace slow

TEST(Sampler, SobolIsItsDefinition) {
    const auto expectPoints = [](uint64_t seed, const Vec2i& pixel, uint32_t index) {
        Sampler pairs(SamplerKind::Sobol, seed), singles(SamplerKind::Sobol, seed);
        pairs.StartSample(pixel, index);
        singles.StartSample(pixel, index);
        for (uint32_t dimension = 0; dimension < 6; ++dimension) {
            const Vec2f expected = slow::Point(seed, pixel, index, dimension);
            ASSERT_EQ(pairs.Get2D(), expected) << seed << " " << index << " " << dimension;
            ASSERT_EQ(singles.Get1D(), expected.x()) << seed << " " << index << " " << dimension;
        }
    };
    for (const uint64_t seed : {0ull, 7ull, 0x123456789abcdef0ull, ~0ull})
        for (const Vec2i& pixel : {Vec2i(0, 0), Vec2i(-3, 99), Vec2i(1919, 1079)}) {
            for (uint32_t index = 0; index < 1024; ++index) expectPoints(seed, pixel, index);
            for (int bit = 10; bit < 32; ++bit)
                for (const uint32_t index : {1u << bit, (1u << bit) - 1, ~(1u << bit)})
                    expectPoints(seed, pixel, index);
        }
    // Indices without a pattern.
    for (uint32_t i = 0; i < 4096; ++i) expectPoints(i, Vec2i(int(i), 5), uint32_t(slow::Mix(i)));
}

TEST(Sampler, SobolScramblesDimensionsDifferently) {
    Sampler sampler(SamplerKind::Sobol, 7);
    constexpr int kDimensions = 64;
    std::vector<std::vector<float>> columns(2 * kDimensions);
    for (int k = 0; k < 16; ++k) {
        sampler.StartSample({0, 0}, k);
        for (int d = 0; d < kDimensions; ++d) {
            const Vec2f p = sampler.Get2D();
            columns[2 * d].push_back(p.x());
            columns[2 * d + 1].push_back(p.y());
        }
    }
    EXPECT_EQ(std::set(columns.begin(), columns.end()).size(), columns.size());
}

}  // namespace
}  // namespace lull
