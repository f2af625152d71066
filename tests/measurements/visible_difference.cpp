// What visible_difference.py measures with: the metric, for pictures on stdin.
//
//   visible_difference DISPLAY WIDTH HEIGHT BLOCK   reads a reference and any number of pictures
//       (linear RGB, 32-bit floats, row by row), and prints for each the visible difference of the
//       whole and of each block, row by row, in a line
//   visible_difference without DISPLAY WIDTH HEIGHT   prints for each picture the visible
//       difference of the whole without its worst pixels
//   visible_difference sensitivity   reads lines of cycles per degree, square degrees and cd/m2,
//       and prints the sensitivities of the three channels
#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/denoise/visible_error.h"
#include "renderer/vision/visible_difference.h"

using namespace lull;

static void PrintSensitivities() {
    GaborPatch patch;
    while (std::cin >> patch.frequency >> patch.area >> patch.luminance) {
        for (const OpponentChannel channel :
             {OpponentChannel::Achromatic, OpponentChannel::RedGreen,
              OpponentChannel::YellowViolet})
            fmt::print("{:.6g} ", ContrastSensitivity(channel, patch));
        fmt::print("\n");
    }
}

static bool ReadPicture(std::vector<float>* values) {
    return std::fread(values->data(), sizeof(float), values->size(), stdin) == values->size();
}

// Calls use(picture, reference, prepared) for each picture after the reference.
template <typename Use>
static void ForEachPicture(const DisplayModel& display, int width, int height, const Use& use) {
    std::vector<float> reference(size_t(width) * size_t(height) * 3), picture(reference.size());
    if (!ReadPicture(&reference)) return;
    const VisibleReference prepared = PrepareReference(reference, width, height, display);
    while (ReadPicture(&picture)) use(picture, reference, prepared);
}

static void PrintDifferences(const DisplayModel& display, int width, int height, int block) {
    ForEachPicture(display, width, height, [&](const auto& picture, auto&, auto& prepared) {
        const VisibleDifference difference = FindVisibleDifference(picture, prepared);
        fmt::print("{:.6g}", PooledDifference(difference));
        for (int y = 0; y < height; y += block)
            for (int x = 0; x < width; x += block)
                fmt::print(
                    " {:.6g}",
                    PooledDifference(
                        difference,
                        {{x, y}, {std::min(x + block, width), std::min(y + block, height)}}));
        fmt::print("\n");
    });
}

static float PixelLightness(std::span<const float> rgb) {
    return DisplayedLightness(Luminance(Rgb(rgb[0], rgb[1], rgb[2]))).lightness;
}

static void PrintWithoutWorst(const DisplayModel& display, int width, int height) {
    std::vector<float> lightness(size_t(width) * size_t(height));
    ForEachPicture(
        display, width, height, [&](auto& picture, const auto& reference, auto& prepared) {
            for (size_t i = 0; i < lightness.size(); ++i)
                lightness[i] = PixelLightness(std::span(picture).subspan(3 * i, 3)) -
                               PixelLightness(std::span(reference).subspan(3 * i, 3));
            for (const size_t i : WorstPixels(FindVisibleDifference(picture, prepared), lightness))
                std::copy_n(&reference[3 * i], 3, &picture[3 * i]);
            fmt::print("{:.6g}\n", PooledDifference(FindVisibleDifference(picture, prepared)));
        });
}

int main(int count, char** arguments) {
    try {
        if (count == 2 && arguments[1] == std::string("sensitivity")) {
            PrintSensitivities();
            return 0;
        }
        if (count == 5 && arguments[1] == std::string("without")) {
            PrintWithoutWorst(ParseDisplay(arguments[2]), std::atoi(arguments[3]),
                              std::atoi(arguments[4]));
            return 0;
        }
        if (count != 5) throw Error("see the first lines of visible_difference.cpp");
        PrintDifferences(ParseDisplay(arguments[1]), std::atoi(arguments[2]),
                         std::atoi(arguments[3]), std::max(1, std::atoi(arguments[4])));
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}\n", e.what());
        return 1;
    }
}
