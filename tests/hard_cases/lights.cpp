// Light that comes from next to nothing, or is next to nothing.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tests/hard_cases/known_scene.h"
#include "tests/renderer/files/test_files.h"

namespace lull {

namespace {

constexpr int kMapWidth = 64, kMapHeight = 32;
constexpr double kAlbedo = 0.5;

// A grey map of latitudes and longitudes, the row around +z first.
using Map = std::vector<float>;

// Writes the map in PFM, which has its last row first.
void WriteMap(const Map& map, const TemporaryDirectory& directory) {
    std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", kMapWidth, kMapHeight);
    for (int y = kMapHeight - 1; y >= 0; --y)
        for (int x = 0; x < kMapWidth; ++x)
            for (int c = 0; c < 3; ++c)
                bytes.append(reinterpret_cast<const char*>(&map[size_t(y) * kMapWidth + x]), 4);
    directory.Write("map.pfm", bytes);
}

// Integrates cos / pi over the half of the bilinear map around -z, in double. What is linear in
// longitude integrates to the mean of its row.
double RadianceOfFloor(const Map& map) {
    constexpr int kSteps = 1000;  // in a row
    const auto rowMean = [&](int y) {
        double sum = 0;
        for (int x = 0; x < kMapWidth; ++x) {
            const float texel = map[size_t((y + kMapHeight) % kMapHeight) * kMapWidth + x];
            sum += std::isfinite(texel) && texel > 0 ? texel / double(kMapWidth) : 0;
        }
        return sum;
    };
    double irradiance = 0;
    for (int i = kMapHeight / 2 * kSteps; i < kMapHeight * kSteps; ++i) {
        const double y = (i + 0.5) / kSteps - 0.5,
                     theta = (y + 0.5) * std::numbers::pi / kMapHeight;
        const int y0 = int(std::floor(y));
        const double row = (y0 + 1 - y) * rowMean(y0) + (y - y0) * rowMean(y0 + 1);
        irradiance += row * -std::cos(theta) * std::sin(theta);
    }
    return kAlbedo * irradiance * 2 * std::numbers::pi / kMapHeight / kSteps;
}

HardCaseResult FloorUnder(const Map& map, int samples, const HardCaseOptions& options) {
    const TemporaryDirectory directory;
    WriteMap(map, directory);
    const auto scene = MakeScene({.world = "LightSource \"infinite\" \"string mapname\" \"map.pfm\""
                                           "\nMaterial \"matte\" \"rgb Kd\" [.5 .5 .5]\n" +
                                           FloorText(5),
                                  .fov = 20,
                                  .directory = &directory});
    return CompareRadiance(*scene, RadianceOfFloor(map), 1e-4, samples, options);
}

HardCaseResult OneTexelSun(const HardCaseOptions& options) {
    Map map(size_t(kMapWidth) * kMapHeight, 0.01f);
    map[24 * kMapWidth + 9] = 1e9f;
    return FloorUnder(map, options.isLong ? 100'000 : 4000, options);
}

HardCaseResult BrokenTexels(const HardCaseOptions& options) {
    Map map(size_t(kMapWidth) * kMapHeight, 1);
    const float broken[] = {std::nanf(""), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), -1};
    for (size_t i = 0; i < map.size(); i += 7) map[i] = broken[i / 7 % 4];
    return FloorUnder(map, options.isLong ? 100'000 : 4000, options);
}

HardCaseResult BlackSky(const HardCaseOptions& options) {
    return FloorUnder(Map(size_t(kMapWidth) * kMapHeight, 0), 100, options);
}

// A square lamp 1e-6 wide, 1 above the floor: L A / pi of the albedo.
HardCaseResult TinyLight(const HardCaseOptions& options) {
    const double half = 0.5e-6, L = 1e12;
    const auto scene = MakeScene(
        {.world = "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n" + FloorText(5) +
                  fmt::format("AreaLightSource \"diffuse\" \"rgb L\" [{0} {0} {0}] \"bool "
                              "twosided\" \"true\"\n",
                              L) +
                  FloorText(half, -1),
         .camera = "1 0 -2  0 0 0  0 1 0",
         .fov = 1e-3});
    return CompareRadiance(*scene, kAlbedo * L * 4 * half * half / std::numbers::pi, 1e-4,
                           options.isLong ? 10'000 : 100, options);
}

// 64 lamps, one of them 1e6 times as bright as the others.
HardCaseResult UnequalLights(const HardCaseOptions& options) {
    std::string lamps;
    double answer = 0;
    for (int i = 0; i < 64; ++i) {
        const double x = i % 8 - 3.5, y = i / 8 - 3.5, z = 2, intensity = i == 13 ? 1e6 : 1;
        lamps += fmt::format(
            "LightSource \"point\" \"rgb I\" [{0} {0} {0}] \"point from\" "
            "[{1} {2} {3}]\n",
            intensity, x, y, -z);
        answer += kAlbedo / std::numbers::pi * intensity * z / std::pow(x * x + y * y + z * z, 1.5);
    }
    std::vector<HardCaseResult> results;
    for (const char* strategy : {"power", "spatial"}) {
        const auto scene = MakeScene(
            {.world = lamps + "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n" + FloorText(5),
             .camera = "0 0 -1  0 0 0  0 1 0",
             .fov = 1e-3,
             .integrator = fmt::format("\"string lightsamplestrategy\" \"{}\"", strategy)});
        results.push_back(CompareRadiance(*scene, answer, 1e-4, options.isLong ? 100'000 : 1000,
                                          options, std::string("worst: ") + strategy));
    }
    return Worst(results);
}

}  // namespace

std::vector<HardCase> LightCases() {
    return {
        {"lights", "sun of 1e9 in one texel of 64 x 32",
         "found by chance once in 1,000 paths; overflow of sums", OneTexelSun},
        {"lights", "NaN, infinite and negative texels in a seventh of the sky",
         "one texel makes the whole table of probabilities NaN", BrokenTexels},
        {"lights", "sky that is black everywhere", "0/0 in the table of probabilities", BlackSky},
        {"lights", "square lamp 1e-6 wide", "its area underflows, or shadows itself", TinyLight},
        {"lights", "64 lamps, one of them 1e6 times as bright",
         "the dim ones are never chosen, or too often", UnequalLights}};
}

}  // namespace lull
