#include "renderer/lab/viewpoints/picture_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

#include "renderer/base/error.h"
#include "renderer/lab/comparison/compared_files.h"
#include "renderer/lab/viewpoints/recorded_viewpoint.h"
#include "stopping/base/parallel.h"
#include "stopping/lab/recordings/recording.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

int NumberAt(const std::string& text, size_t at) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    return error == std::errc() && value > 0 ? value : 0;
}

size_t BeginOfDigits(const std::string& text, size_t end) {
    while (end > 0 && std::isdigit(uint8_t(text[end - 1]))) --end;
    return end;
}

std::map<int, std::string> FindFiles(const std::string& folder) {
    std::error_code error;
    std::filesystem::directory_iterator files(folder, error);
    if (error) throw Error("--images {}: {}", folder, error.message());
    std::set<std::string> paths;  // in an order that does not depend on the file system
    for (const auto& entry : files)
        if (entry.is_regular_file() && !entry.path().filename().string().starts_with("."))
            paths.insert(entry.path().string());
    std::map<int, std::string> found;
    for (const std::string& path : paths) {
        const int spp = SppInName(std::filesystem::path(path).filename().string());
        if (spp == 0) throw Error(path + ": has no spp in its name, such as room-40spp.png");
        const auto [other, isNew] = found.emplace(spp, path);
        if (!isNew) throw Error("{} and {} are both of {} spp", other->second, path, spp);
    }
    return found;
}

std::string NameOfFolder(const std::string& folder) {
    const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

}  // namespace

std::vector<int> PictureFolder::Spp() const {
    std::vector<int> all;
    for (const auto& [spp, file] : files) all.push_back(spp);
    return all;
}

int SppInName(const std::string& name) {
    const std::string stem = std::filesystem::path(name).stem().string();
    const std::string lower = LowerCase(stem);
    if (const size_t at = lower.rfind("spp"); at != std::string::npos) {
        const auto isSeparator = [](char c) {
            return c == '-' || c == '_' || c == '.' || c == ' ';
        };
        size_t end = at;
        while (end > 0 && isSeparator(lower[end - 1])) --end;
        if (const size_t begin = BeginOfDigits(lower, end); begin < end)
            return NumberAt(lower, begin);
        size_t begin = at + 3;
        while (begin < lower.size() && isSeparator(lower[begin])) ++begin;
        if (begin < lower.size()) return NumberAt(lower, begin);
        return 0;
    }
    const size_t last = stem.find_last_of("0123456789");
    return last == std::string::npos ? 0 : NumberAt(stem, BeginOfDigits(stem, last + 1));
}

PictureFolder FindPictures(const std::string& folder, const std::string& name) {
    PictureFolder found{.name = name.empty() ? NameOfFolder(folder) : name,
                        .files = FindFiles(folder)};
    if (const std::string problem = CheckViewpointName(found.name); !problem.empty())
        throw Error("--images {}: {}", folder, problem);
    if (found.files.empty()) throw Error("--images {}: has no pictures", folder);
    const RgbImage first = ReadShownPicture(found.files.begin()->second);
    found.width = first.width;
    found.height = first.height;
    return found;
}

PictureFolder FindNamedPictures(const std::string& text) {
    const size_t colon = text.rfind(':');
    std::error_code error;
    if (colon == std::string::npos || std::filesystem::is_directory(text, error))
        return FindPictures(text);
    return FindPictures(text.substr(0, colon), text.substr(colon + 1));
}

RgbImage ReadPicture(const PictureFolder& folder, int spp) {
    const std::string& file = folder.files.at(spp);
    RgbImage image = ReadShownPicture(file);
    if (image.width != folder.width || image.height != folder.height)
        throw Error("{}: has {}x{} pixels, {} has {}x{}", file, image.width, image.height,
                    folder.files.begin()->second, folder.width, folder.height);
    return image;
}

bool IsDisplayPicture(const PictureFolder& folder, int spp) {
    return IsDisplayFile(folder.files.at(spp));
}

int PassOfPictures(const std::vector<int>& spp) {
    const int pass = spp.front(), last = spp.back();
    if (spp.size() < 2) return 0;
    for (const int n : spp)
        if (n % pass != 0) return 0;
    for (int n = pass; n <= last; n += pass)
        if (IsRecorded(n, pass, last) && !std::ranges::binary_search(spp, n)) return 0;
    return pass;
}

namespace {

SvdEntropy MeanOf(std::span<const SvdEntropy> entropies) {
    SvdEntropy mean;
    for (const SvdEntropy& e : entropies) {
        mean.h += e.h / double(entropies.size());
        mean.h1 += e.h1 / double(entropies.size());
        mean.h2 += e.h2 / double(entropies.size());
    }
    return mean;
}

}  // namespace

EntropiesOfPicture MeasureEntropies(const RgbImage& picture, int blockSize, int subBlocks,
                                    bool withAttributes) {
    const PixelRect region{{0, 0}, {picture.width, picture.height}};
    const std::vector<Block> blocks = MakeBlocks(region, {.blockSize = blockSize});
    const int least = std::max(int(std::lround(std::sqrt(subBlocks))), 5);
    for (const Block& block : blocks)
        if (std::min(block.pixels.Width(), block.pixels.Height()) < least)
            throw Error(
                "a block of {}x{} pixels is too small for {} sub-blocks; choose another --block or "
                "fewer --sub-blocks",
                block.pixels.Width(), block.pixels.Height(), subBlocks);
    EntropiesOfPicture result{
        .whole = {}, .mean = {}, .blocks = std::vector<BlockEntropies>(blocks.size())};
    const auto whole = [](const std::vector<double>& lightness, const PixelRect& rect) {
        return SubBlockEntropies(lightness, rect.Width(), rect.Height(), 1)[0];
    };
    result.whole = whole(LightnessOf(picture.values), region);
    ForEachIndex(int(blocks.size()), [&](int i) {
        const PixelRect& rect = blocks[size_t(i)].pixels;
        const std::vector<double> lightness =
            LightnessOf(CutPixels(picture.values, picture.width, rect));
        BlockEntropies& block = result.blocks[size_t(i)];
        block.pixels = rect;
        block.whole = whole(lightness, rect);
        block.subBlocks = SubBlockEntropies(lightness, rect.Width(), rect.Height(), subBlocks);
        block.mean = MeanOf(block.subBlocks);
        if (withAttributes)
            block.attributes = ComputeAttributes(lightness, rect.Width(), rect.Height());
    });
    std::vector<SvdEntropy> means;
    for (const BlockEntropies& block : result.blocks) means.push_back(block.mean);
    result.mean = MeanOf(means);
    return result;
}

namespace {

void Paste(const RgbImage& from, const PixelRect& rect, RgbImage* to) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y) {
        const ptrdiff_t begin = (ptrdiff_t(y) * from.width + rect.min.x()) * 3;
        std::copy_n(from.values.begin() + begin, rect.Width() * 3, to->values.begin() + begin);
    }
}

class RuleOnPictures {
  public:
    RuleOnPictures(PictureRule given, const PictureFolder& folder, ScheduleOptions schedule)
        : rule(std::move(given)) {
        if (!rule.rule.stopAt && rule.rule.need > ViewNeed::Mean)
            throw Error(
                "{}: the rule needs a half buffer, which pictures do not have; choose one that "
                "needs none, such as learned or entropy",
                rule.rule.text);
        schedule.smallestSide = rule.rule.smallestSide;
        blocks = MakeBlocks(folder.Region(), schedule);
        stops.resize(blocks.size());
        const double area = double(folder.Region().Area());
        const CriterionMaker make = CriteriaOf(rule.rule);
        for (int i = 0; const Block& block : blocks) {
            const BlockInfo info{i++, double(block.pixels.Area()) / area};
            criteria.push_back(block.votes ? make(info) : nullptr);
        }
        image.name = rule.name;
        image.rule = rule.rule.text;
        image.image = {folder.width, folder.height,
                       std::vector<float>(size_t(folder.Region().Area()) * 3)};
    }

    // Decides at `spp`; picture() returns the picture, where one is needed.
    void Observe(int spp, bool isLast, const std::function<const RgbImage&()>& picture) {
        const auto looks = [&](const auto& criterion) {
            return criterion && criterion->Need(spp) != ViewNeed::Nothing;
        };
        const RgbImage* shown = std::ranges::any_of(criteria, looks) ? &picture() : nullptr;
        std::vector<Decision> decisions(blocks.size());
        ForEachIndex(int(blocks.size()), [&](int n) {
            const size_t i = size_t(n);
            if (!criteria[i]) return;
            const PixelRect& rect = blocks[i].pixels;
            BlockView view{.width = rect.Width(), .height = rect.Height(), .spp = spp};
            std::vector<float> pixels;
            if (looks(criteria[i])) pixels = CutPixels(shown->values, shown->width, rect);
            view.mean = pixels;
            decisions[i] = criteria[i]->Observe(view);
        });
        for (size_t i = 0; i < blocks.size(); ++i) {
            hasLooked |= decisions[i].checked;
            const int leader = blocks[i].leader;
            const Decision& decision = decisions[leader >= 0 ? size_t(leader) : i];
            if (stops[i] > 0 || !(decision.stop || isLast)) continue;
            stops[i] = spp;
            criteria[i].reset();
            Paste(picture(), blocks[i].pixels, &image.image);
        }
    }

    ComparedImage End() {
        for (const int spp : stops) image.costs.push_back({.spp = spp});
        return std::move(image);
    }

    PictureRule rule;
    bool hasLooked = false;

  private:
    std::vector<Block> blocks;
    std::vector<int> stops;                            // 0: not yet
    std::vector<std::unique_ptr<Criterion>> criteria;  // null: stopped, or follows another
    ComparedImage image;
};

}  // namespace

PictureComparison ComparePictures(const PictureFolder& folder, const ScheduleOptions& schedule,
                                  std::vector<PictureRule> rules) {
    PictureComparison result{.comparison = BeginComparison(folder.Region(), schedule)};
    Comparison& comparison = result.comparison;
    const int last = folder.files.rbegin()->first;
    comparison.cap = last;
    std::vector<std::unique_ptr<RuleOnPictures>> running;
    for (PictureRule& rule : rules)
        running.push_back(std::make_unique<RuleOnPictures>(std::move(rule), folder, schedule));
    ComparedImage reference;
    reference.name = "reference";
    for (const int spp : folder.Spp()) {
        std::optional<RgbImage> read;
        const auto picture = [&]() -> const RgbImage& {
            return read ? *read : read.emplace(ReadPicture(folder, spp));
        };
        for (const auto& one : running) one->Observe(spp, spp == last, picture);
        if (spp == last) reference.image = picture();
    }
    for (const auto& one : running) {
        if (!one->hasLooked) result.blind.push_back(one->rule.rule.text);
        comparison.images.push_back(one->End());
    }
    for (size_t i = 0; i < comparison.blocks.size(); ++i) reference.costs.push_back({.spp = last});
    comparison.images.push_back(std::move(reference));
    for (ComparedImage& image : comparison.images) image.isDisplay = IsDisplayPicture(folder, last);
    return result;
}

}  // namespace lull
