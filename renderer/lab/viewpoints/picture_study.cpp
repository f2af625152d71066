// Makes a study of the pictures of another renderer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/lab/viewpoints/study.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

// Returns those of `available` that are nearest to the levels of a ladder.
std::vector<int> ChooseLevels(const std::vector<int>& available, int count, double ratio) {
    const int low = available.front(), cap = available.back();
    std::vector<double> wanted;
    const double span = std::log(double(cap) / low);
    const int steps = count > 0 ? count - 1 : std::max(1, int(std::round(span / std::log(ratio))));
    for (int i = 0; i <= steps; ++i) wanted.push_back(std::log(low) + span * i / steps);
    std::vector<int> levels;
    for (const double w : wanted) {
        const int nearest = *std::ranges::min_element(
            available, {}, [&](int spp) { return std::abs(std::log(double(spp)) - w); });
        if (levels.empty() || levels.back() < nearest) levels.push_back(nearest);
    }
    return levels;
}

}  // namespace

Study MakeStudy(const PictureFolder& folder, int blockSize, int count, double ratio) {
    if (folder.files.size() < 2)
        throw Error(folder.files.begin()->second +
                    ": is the only picture of its folder; a study needs two at least");
    Study study{.viewpoint = folder.name, .width = folder.width, .height = folder.height};
    study.levels = ChooseLevels(folder.Spp(), count, ratio);
    study.provenance["renderer"] = "another";
    for (const Block& block : MakeBlocks(folder.Region(), {.blockSize = blockSize}))
        study.blocks.push_back({block.pixels, {}});
    for (const int spp : study.levels) {
        const RgbImage picture = ReadPicture(folder, spp);
        DisplayPixels shown(picture.values.size());
        EncodeSrgb8(picture.values, shown);
        for (StudyBlock& block : study.blocks)
            block.pictures.push_back(CutPixels(shown, folder.width, block.pixels));
    }
    return study;
}

}  // namespace lull
