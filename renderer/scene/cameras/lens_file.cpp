#include "renderer/scene/cameras/lens_file.h"

#include <fmt/format.h>

#include "renderer/files/file_contents.h"
#include "renderer/input/number_file.h"

namespace lull {

std::vector<LensInterface> LoadLens(const std::string& path, const FileLoc& loc) {
    const std::vector<float> numbers = ReadNumberFile(path, "lens", loc);
    const auto fail = [&](const std::string& what) {
        throw Error(loc, fmt::format("the lens file '{}' {}", Printable(path, 4096), what));
    };
    constexpr size_t kMost = 1000;
    if (numbers.empty() || numbers.size() % 4 != 0 || numbers.size() > 4 * kMost)
        fail(fmt::format("has {} numbers; four are needed for each of 1 to {} interfaces",
                         numbers.size(), kMost));
    std::vector<LensInterface> interfaces;
    for (size_t i = 0; i < numbers.size(); i += 4) {
        const double radius = double(numbers[i]), thickness = double(numbers[i + 1]);
        const double eta = double(numbers[i + 2]), diameter = double(numbers[i + 3]);
        constexpr double kMetres = 1e-3, kMostLength = 1e9;
        if (!(std::abs(radius) <= kMostLength) || !(std::abs(thickness) <= kMostLength))
            fail(fmt::format("has a radius or thickness beyond {:g} mm in row {}", kMostLength,
                             i / 4 + 1));
        if (!(diameter > 0 && diameter <= kMostLength))
            fail(fmt::format("has a diameter of {:g} mm in row {}; it has to be positive", diameter,
                             i / 4 + 1));
        if (!(eta == 0 || (eta >= 0.1 && eta <= 10)))
            fail(fmt::format("has an index of refraction of {:g} in row {}", eta, i / 4 + 1));
        // An index of 0 stands for air.
        interfaces.push_back(
            {radius * kMetres, thickness * kMetres, eta == 0 ? 1 : eta, 0.5 * diameter * kMetres});
    }
    return interfaces;
}

}  // namespace lull
