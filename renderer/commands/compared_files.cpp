#include "renderer/commands/compared_files.h"

#include "renderer/base/error.h"
#include "renderer/output/image_io.h"

namespace lull {

ComparedFile ReadComparedFile(const std::string& path, const std::string& name) {
    const ExrImage exr = ReadExr(path);
    ComparedFile file;
    file.region = {exr.origin, exr.origin + Vec2i(exr.width, exr.height)};
    file.image.name = name;
    RgbImage& image = file.image.image;
    image = {exr.width, exr.height, std::vector<float>(size_t(file.region.Area()) * 3)};
    for (size_t c = 0; c < 3; ++c) {
        const std::string channel(1, "RGB"[c]);
        const ExrChannel* found = exr.Find(channel);
        if (!found) throw Error(path + ": has no channel " + channel);
        for (size_t i = 0; i < found->values.size(); ++i)
            image.values[3 * i + c] = found->values[i];
    }
    if (const ExrChannel* spp = exr.Find("spp")) file.spp = spp->values;
    if (const auto at = exr.attributes.find("criterion"); at != exr.attributes.end())
        if (const auto* text = std::get_if<std::string>(&at->second)) file.image.rule = *text;
    if (const auto at = exr.attributes.find("seconds"); at != exr.attributes.end())
        if (const auto* seconds = std::get_if<float>(&at->second))
            file.image.wallSeconds = double(*seconds);
    return file;
}

void SetCosts(const std::vector<PixelRect>& blocks, ComparedFile* file) {
    if (file->spp.empty()) return;
    const PixelRect& region = file->region;
    const auto sppAt = [&](int x, int y) {
        return file
            ->spp[size_t(y - region.min.y()) * size_t(region.Width()) + size_t(x - region.min.x())];
    };
    std::vector<BlockCost> costs;
    for (const PixelRect& block : blocks) {
        const float spp = sppAt(block.min.x(), block.min.y());
        for (int y = block.min.y(); y < block.max.y(); ++y)
            for (int x = block.min.x(); x < block.max.x(); ++x)
                if (sppAt(x, y) != spp) return;  // rendered in other blocks
        costs.push_back({.spp = int(spp)});
    }
    file->image.costs = std::move(costs);
}

}  // namespace lull
