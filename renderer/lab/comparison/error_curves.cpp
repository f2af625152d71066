#include "renderer/lab/comparison/error_curves.h"

#include <fmt/format.h>

#include <limits>

#include "stopping/base/parallel.h"
#include "stopping/lab/evaluation/evaluated_rules.h"

namespace lull {

namespace {

CurvePoint PointOf(const Comparison& comparison, const ComparedImage& image,
                   const ErrorFigures& figures, int threads) {
    const size_t colon = std::min(image.rule.find(':'), image.rule.size());
    const TotalCost cost = SumCosts(comparison, image);
    return {.rule = image.rule.substr(0, colon),
            .setting = image.rule.substr(std::min(colon + 1, image.rule.size())),
            .spp = double(cost.samples) / double(comparison.region.Area()),
            .seconds = (cost.seconds + cost.ruleSeconds) / threads,
            .ruleSeconds = cost.ruleSeconds,
            .figures = figures};
}

}  // namespace

std::vector<int> FixedLadder(int passLength, int cap) {
    std::vector<int> ladder;
    for (int passes = 1; passes * passLength < cap; passes += (passes + 1) / 2)
        ladder.push_back(passes * passLength);
    ladder.push_back(cap);
    return ladder;
}

std::vector<std::string> CurveRules(int passLength, int cap) {
    std::vector<std::string> rules;
    for (const int spp : FixedLadder(passLength, cap))
        rules.push_back(fmt::format("fixed:{}", spp));
    for (const RecordedRule& rule : RecordedRules())
        for (const double setting : rule.curve)
            rules.push_back(fmt::format("{}:{}", rule.name, setting));
    return rules;
}

std::vector<CurvePoint> MeasureCurves(const MonitoredRender& render,
                                      const std::vector<MonitoredRule>& rules, size_t imageCount,
                                      const Comparison& comparison) {
    std::vector<CurvePoint> points(rules.size());
    const int threads = render.result.threads;
    const ComparedImage& reference = comparison.images.back();
    for (size_t i = 0; i < imageCount; ++i)
        points[i] =
            PointOf(comparison, comparison.images[i], *comparison.images[i].figures, threads);
    ForEachIndex(int(rules.size() - imageCount), [&](int i) {
        const size_t index = imageCount + size_t(i);
        const ComparedImage image = TakeImage(render, rules, index);
        ErrorFigures figures =
            Average(CompareImages(image.image, reference.image, comparison.display));
        if (reference.isDisplay)
            figures.rmse = figures.relMse = std::numeric_limits<double>::quiet_NaN();
        points[index] = PointOf(comparison, image, figures, threads);
    });
    return points;
}

}  // namespace lull
