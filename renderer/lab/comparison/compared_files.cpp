#include "renderer/lab/comparison/compared_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/files/file_io.h"
#include "renderer/image/image_io.h"
#include "renderer/results/channel_names.h"
#include "renderer/results/denoised_image.h"
#include "renderer/results/image_files.h"

namespace lull {

namespace {

bool IsTiff(const std::string& path) {
    const std::string extension = ExtensionOf(path);
    return extension == ".tif" || extension == ".tiff";
}

std::string SizeOf(const PixelRect& region) {
    return fmt::format("{}x{} pixels", region.Width(), region.Height());
}

bool HaveOneSize(const PixelRect& a, const PixelRect& b) {
    return a.Width() == b.Width() && a.Height() == b.Height();
}

ComparedFile ReadDisplayFile(const std::string& path, const std::string& name) {
    const Image picture = ReadImage(path);
    // Whether larger numbers in a TIFF are linear is not known.
    if (IsTiff(path) && !std::holds_alternative<std::vector<uint8_t>>(picture.texels))
        throw Error(path + ": of TIFF files, only those of 8 bits are compared; make it an EXR");
    ComparedFile file;
    file.region = file.shown = {{0, 0}, {picture.width, picture.height}};
    file.image.name = name;
    file.image.isDisplay = true;
    const size_t channels = size_t(picture.channels);
    const auto at = [&](size_t i) {
        return std::visit(
            [&](const auto& texels) {
                constexpr bool isBytes = std::is_same_v<decltype(texels[0]), const uint8_t&>;
                return float(texels[i]) / (isBytes ? 255.f : 1.f);
            },
            picture.texels);
    };
    RgbImage& image = file.image.image;
    image = {picture.width, picture.height, {}};
    for (size_t i = 0; i < size_t(file.region.Area()); ++i)
        for (size_t c = 0; c < 3; ++c)
            image.values.push_back(LinearFromSrgb(at(channels * i + (channels < 3 ? 0 : c))));
    return file;
}

void MoveTo(const PixelRect& window, ComparedFile* file) {
    file->image.image = {window.Width(), window.Height(),
                         MovedTo(window, file->region, 3, file->image.image.values)};
    if (!file->spp.empty()) file->spp = MovedTo(window, file->region, 1, file->spp);
    file->region = window;
}

void JoinViews(const std::string& path, ExrImage* exr) {
    const bool isLeftFirst = exr->views[0] == "left";
    const std::string other = isLeftFirst ? "right" : "left";
    const auto has = [&](const char* name) { return exr->Find(other + "." + name) != nullptr; };
    if (std::set(exr->views.begin(), exr->views.end()) != std::set<std::string>{"left", "right"} ||
        !std::ranges::all_of(std::array{"R", "G", "B"}, has))
        throw Error(
            "{}: its views are {}; those of a pair are left and right, with R, G and B of both",
            path, fmt::join(exr->views, ", "));
    std::vector<ExrChannel> joined;
    for (const char* name : {"R", "G", "B", "spp"}) {
        if (!has(name) || !exr->Find(name)) continue;
        const std::vector<float>* values[] = {&exr->Find(name)->values,
                                              &exr->Find(other + "." + name)->values};
        joined.push_back(
            {name, RowsBeside(*values[!isLeftFirst], *values[isLeftFirst], size_t(exr->width))});
    }
    exr->channels = std::move(joined);
    exr->width *= 2;
    exr->displaySize = {0, 0};
}

bool IsPlaced(const ComparedFile& file) { return !file.image.isDisplay; }

void UseOneWindow(std::vector<ComparedFile>* files) {
    const auto first = std::ranges::find_if(*files, IsPlaced);
    const auto isElsewhere = [&](const ComparedFile& file) {
        return IsPlaced(file) && !(file.region == first->region);
    };
    if (std::ranges::none_of(*files, isElsewhere)) return;
    for (ComparedFile& file : *files)
        if (IsPlaced(file)) MoveTo(file.shown, &file);
}

}  // namespace

bool IsDisplayFile(const std::string& path) {
    const std::string extension = ExtensionOf(path);
    return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || IsTiff(path);
}

bool IsImageFile(const std::string& path) {
    return ExtensionOf(path) == ".exr" || IsDisplayFile(path);
}

ComparedFile ReadComparedFile(const std::string& path, const std::string& name) {
    if (IsDisplayFile(path)) return ReadDisplayFile(path, name);
    ExrImage exr = ReadExr(path);
    UseOwnNames(path, &exr);
    ComparedFile file;
    file.isPair = exr.views.size() > 1;
    if (file.isPair) JoinViews(path, &exr);
    file.region = DataWindow(exr);
    file.shown = ShownWindow(exr, path);
    file.image.name = name;
    RgbImage& image = file.image.image;
    image = {exr.width, exr.height, std::vector<float>(size_t(file.region.Area()) * 3)};
    for (size_t c = 0; c < 3; ++c) {
        const ExrChannel* found = exr.Find(std::string(1, "RGB"[c]));
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

RgbImage ReadShownPicture(const std::string& path) {
    ComparedFile file = ReadComparedFile(path, path);
    if (file.isPair)
        throw Error(path + ": is a pair for two eyes; give images of one, as in its .left.png");
    MoveTo(file.shown, &file);
    return std::move(file.image.image);
}

PixelRect CommonRegion(const std::vector<ComparedFile>& files, const std::string& reference) {
    const auto first = std::ranges::find_if(files, IsPlaced);
    const PixelRect region = first == files.end() ? files.back().region : first->region;
    for (const ComparedFile& file : files) {
        if (!HaveOneSize(file.region, region))
            throw Error("{}: images of different sizes: {} has {}, {} has {}", reference,
                        files.front().image.name, SizeOf(files.front().region),
                        files.back().image.name, SizeOf(files.back().region));
        if (IsPlaced(file) && !(file.region == region))
            throw Error("{}: shows another part of the image than the {} one", reference,
                        files.front().image.name);
    }
    return region;
}

std::string DisplayNote(const Comparison& comparison) {
    std::string names;
    for (const ComparedImage& image : comparison.images)
        if (image.isDisplay) names += (names.empty() ? "" : ", ") + image.name;
    return names.empty() ? ""
                         : "Pictures for displays: " + names +
                               ". They hold no radiance, so that RMSE and relMSE are left out; "
                               "other figures are those of the 8-bit display image.";
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

ComparedImage ReadImageBeside(const std::string& path, const std::string& name,
                              const Comparison& comparison) {
    ComparedFile file = ReadComparedFile(path, name);
    const PixelRect& region = comparison.region;
    if (!(file.region == region) && file.shown == region) MoveTo(region, &file);
    if (!HaveOneSize(file.region, region))
        throw Error("{}: has {}, the scene's image {}", path, SizeOf(file.region), SizeOf(region));
    if (file.image.isDisplay) file.region = region;
    if (!(file.region == region))
        throw Error(path + ": shows another part of the image than the scene would");
    SetCosts(comparison.blocks, &file);
    if (!file.image.wallSeconds) file.image.wallSeconds = 0;
    return std::move(file.image);
}

Comparison ComparisonOf(std::vector<ComparedFile> files, const std::string& reference,
                        ScheduleOptions schedule) {
    UseOneWindow(&files);
    const PixelRect region = CommonRegion(files, reference);
    if (std::ranges::any_of(files, &ComparedFile::isPair)) schedule.eyeWidth = region.Width() / 2;
    Comparison comparison = BeginComparison(region, schedule);
    for (ComparedFile& file : files) {
        SetCosts(comparison.blocks, &file);
        comparison.images.push_back(std::move(file.image));
    }
    for (const BlockCost& cost : comparison.images.back().costs)
        comparison.cap = std::max(comparison.cap, cost.spp);
    return comparison;
}

}  // namespace lull
