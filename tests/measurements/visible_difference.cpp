// What visible_difference.py measures with: the metric, for pictures on stdin.
//
//   visible_difference DISPLAY WIDTH HEIGHT BLOCK   reads a reference and any number of pictures
//       (linear RGB, 32-bit floats, row by row), and prints for each the visible difference of the
//       whole and of each block, row by row, in a line
//   visible_difference sensitivity   reads lines of cycles per degree, square degrees and cd/m2,
//       and prints the sensitivities of the three channels
#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "renderer/base/error.h"
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

static void PrintDifferences(const DisplayModel& display, int width, int height, int block) {
    std::vector<float> reference(size_t(width) * size_t(height) * 3), picture(reference.size());
    const auto read = [](std::vector<float>* values) {
        return std::fread(values->data(), sizeof(float), values->size(), stdin) == values->size();
    };
    if (!read(&reference)) return;
    while (read(&picture)) {
        const VisibleDifference difference =
            FindVisibleDifference(picture, reference, width, height, display);
        fmt::print("{:.6g}", PooledDifference(difference));
        for (int y = 0; y < height; y += block)
            for (int x = 0; x < width; x += block)
                fmt::print(
                    " {:.6g}",
                    PooledDifference(
                        difference,
                        {{x, y}, {std::min(x + block, width), std::min(y + block, height)}}));
        fmt::print("\n");
    }
}

int main(int count, char** arguments) {
    try {
        if (count == 2 && arguments[1] == std::string("sensitivity")) {
            PrintSensitivities();
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
