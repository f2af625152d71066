#include "renderer/commands/denoising.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/progress/progress.h"
#include "renderer/render/block_monitor.h"
#include "renderer/render/film_picture.h"

namespace lull {

void KeepDecisions(const RenderResult& result, DenoisedImage* denoised) {
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        const BlockResult& block = result.blocks[i];
        std::optional<VisibleError>& error = denoised->blocks[i];
        if (!error || !block.block.stoppedByVote || block.decisions.empty()) continue;
        error->estimate = block.decisions.back().decision.value;
        error->upper = std::max(error->upper, error->estimate);
    }
}

int RemoveUnknownErrors(const RenderResult& result, const PixelRect& region,
                        DenoisedImage* denoised) {
    int count = 0;
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        if (result.blocks[i].block.spp >= int(kLeastDenoisedSpp)) continue;
        ++count;
        if (i < denoised->blocks.size()) denoised->blocks[i].reset();
        const PixelRect& pixels = result.blocks[i].block.pixels;
        for (int y = pixels.min.y(); y < pixels.max.y(); ++y)
            std::fill_n(denoised->error.begin() + (y - region.min.y()) * region.Width() +
                            (pixels.min.x() - region.min.x()),
                        pixels.Width(), kUnknownError);
    }
    return count;
}

void PrintDenoised(const DenoisedImage& image, double seconds, bool quiet, const Messages& messages,
                   double accepted) {
    if (quiet) return;
    const std::string text =
        fmt::format("denoised in {}; {}", FormatDuration(seconds), TextOf(image.blocks, accepted));
    if (messages.isJson)
        messages.Note(text);
    else
        PrintToStderr("{}\n", text);
}

std::vector<Grading> GradingsOf(const std::vector<Grade>& grades) {
    std::vector<Grading> gradings;
    for (const Grade& grade : grades)
        gradings.push_back(grade.IsPlain() ? Grading() : [grade](std::span<float> rgb) {
            ApplyGrade(grade, rgb);
        });
    return gradings;
}

std::string NamesOf(const std::vector<Grade>& grades) {
    std::string text;
    for (const Grade& grade : grades) {
        const std::string own = TextOf(grade);
        text += (text.empty() ? "" : "; ") + (own.empty() ? "sRGB" : own);
    }
    return text;
}

CriterionMaker MakeGradedCriteria(const Rule& rule, const std::vector<Grade>& grades) {
    CriterionMaker criteriaOf = CriteriaOf(rule);
    if (grades.empty() || rule.stopAt || rule.need == ViewNeed::Measured) return criteriaOf;
    return [criteriaOf, grades](const BlockInfo& info) {
        std::vector<GradedJudge> judges;
        for (const Grade& grade : grades) judges.push_back({grade, criteriaOf(info)});
        return std::make_unique<GradedCriterion>(std::move(judges));
    };
}

}  // namespace lull
