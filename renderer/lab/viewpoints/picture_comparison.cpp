#include "renderer/lab/viewpoints/picture_comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

void Paste(const RgbImage& from, const PixelRect& rect, RgbImage* to) {
    for (int y = rect.min.y(); y < rect.max.y(); ++y) {
        const ptrdiff_t begin = (ptrdiff_t(y) * from.width + rect.min.x()) * 3;
        std::copy_n(from.values.begin() + begin, rect.Width() * 3, to->values.begin() + begin);
    }
}

// A rule at work on all blocks of the pictures.
class RuleOnPictures {
  public:
    RuleOnPictures(PictureRule given, const PictureFolder& folder, ScheduleOptions schedule)
        : rule(std::move(given)) {
        if (!rule.rule.stopAt && rule.rule.need > ViewNeed::Mean)
            throw Error(
                fmt::format("{}: the rule needs a half buffer, which pictures do not have; "
                            "choose one that needs none, such as learned or entropy",
                            rule.rule.text));
        schedule.smallestSide = rule.rule.smallestSide;
        blocks = MakeBlocks(folder.Region(), schedule);
        stops.resize(blocks.size());
        const double area = double(folder.Region().Area());
        for (size_t i = 0; i < blocks.size(); ++i) {
            const BlockInfo info{.index = int(i),
                                 .areaFraction = double(blocks[i].pixels.Area()) / area};
            const bool counts = bool(rule.rule.stopAt);
            targets.push_back(counts ? rule.rule.stopAt(info) : 0);
            criteria.push_back(counts || !blocks[i].votes ? nullptr
                                                          : MakeCriterion(rule.rule, info));
        }
        image.name = rule.name;
        image.rule = rule.rule.text;
        image.image = {folder.width, folder.height,
                       std::vector<float>(size_t(folder.Region().Area()) * 3)};
    }

    // Returns whether a picture has to be looked at, or is the one that a block stops at.
    bool Needs(int spp, bool isLast) const {
        for (size_t i = 0; i < blocks.size(); ++i) {
            if (stops[i] > 0) continue;
            if (isLast || criteria[i] || (targets[i] > 0 && targets[i] <= spp)) return true;
        }
        return false;
    }

    void Observe(const RgbImage& picture, int spp, bool isLast) {
        std::vector<Decision> decisions(blocks.size());
        ForEachIndex(int(blocks.size()), [&](int n) {
            const size_t i = size_t(n);
            if (stops[i] > 0) return;
            if (!criteria[i]) {
                decisions[i].stop = targets[i] > 0 && targets[i] <= spp;
                return;
            }
            BlockView view{
                .width = blocks[i].pixels.Width(), .height = blocks[i].pixels.Height(), .spp = spp};
            std::vector<float> pixels;
            if (criteria[i]->Need(spp) != ViewNeed::Nothing) {
                pixels = CutPixels(picture.values, picture.width, blocks[i].pixels);
                view.mean = pixels;
            }
            decisions[i] = criteria[i]->Observe(view);
        });
        for (size_t i = 0; i < blocks.size(); ++i) {
            hasLooked |= decisions[i].checked || (!criteria[i] && targets[i] > 0);
            const int leader = blocks[i].leader;
            const bool follows = !blocks[i].votes && leader >= 0;
            const Decision& decision = decisions[follows ? size_t(leader) : i];
            if (stops[i] > 0 || !(decision.stop || isLast)) continue;
            stops[i] = spp;
            Paste(picture, blocks[i].pixels, &image.image);
        }
    }

    // Returns the image, whose blocks have all stopped.
    ComparedImage End() {
        for (const int spp : stops) image.costs.push_back({.spp = spp});
        return std::move(image);
    }

    PictureRule rule;
    bool hasLooked = false;

  private:
    std::vector<Block> blocks;
    std::vector<int> targets;  // spp that a rule says at once; 0: it looks
    std::vector<int> stops;    // 0: not yet
    std::vector<std::unique_ptr<Criterion>> criteria;
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
        const bool isLast = spp == last;
        const auto needs = [&](const auto& one) { return one->Needs(spp, isLast); };
        if (!isLast && std::ranges::none_of(running, needs)) continue;
        RgbImage picture = ReadPicture(folder, spp);
        for (const auto& one : running) one->Observe(picture, spp, isLast);
        if (isLast) reference.image = std::move(picture);
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
