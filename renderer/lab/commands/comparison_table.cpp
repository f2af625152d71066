#include "renderer/lab/commands/comparison_table.h"

#include <fmt/format.h>

namespace lull {

namespace {

std::string Figure(const char* format, double value) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string ImageLine(const Comparison& comparison, const ComparedImage& image) {
    std::string line = fmt::format("{:<12}", image.name);
    if (image.figures) {
        const ErrorFigures& f = *image.figures;
        line += fmt::format(" {:>9} {:>9} {:>7.3f} {:>7} {:>8} {:>7.4f} {:>7}",
                            Figure("{:.4g}", f.rmse), Figure("{:.3g}", f.relMse), f.rmseLightness,
                            Figure("{:.2f}", f.psnr), Figure("{:.5f}", f.ssim), f.flip,
                            Figure("{:.3g}", f.visibleDifference));
    } else {
        line += fmt::format(" {:>9} {:>9} {:>7} {:>7} {:>8} {:>7} {:>7}", "-", "-", "-", "-", "-",
                            "-", "-");
    }
    line += fmt::format(" {:>6}", image.seams ? Figure("{:.2f}", image.seams->Ratio()) : "-");
    if (image.costs.empty()) return line;
    const TotalCost cost = SumCosts(comparison, image);
    line += fmt::format(
        " {:>9}", fmt::format("{:.1f}", double(cost.samples) / double(comparison.region.Area())));
    if (cost.seconds > 0)
        line += fmt::format(
            " {:>9} {:>6}", fmt::format("{}{:.1f}", cost.isEstimated ? "~" : "", cost.seconds),
            fmt::format("{:.2f}%", 100 * cost.ruleSeconds / (cost.seconds + cost.ruleSeconds)));
    return line;
}

std::string VisibleBlocksLine(const Comparison& comparison, const ComparedImage& image) {
    const int visible = CountVisibleBlocks(image);
    return fmt::format("{}: {} of {} blocks differ{} visibly at {} pixels a degree", image.name,
                       visible, comparison.blocks.size(), visible == 1 ? "s" : "",
                       comparison.display.pixelsPerDegree);
}

std::string Percent(const Json& share) {
    return share.is_number() ? fmt::format("{:.1f} %", 100 * share.get<double>()) : "unknown";
}

}  // namespace

std::string ComparisonTable(const ComparisonReport& report) {
    const Comparison& comparison = report.comparison;
    std::string text =
        fmt::format("{:<12} {:>9} {:>9} {:>7} {:>7} {:>8} {:>7} {:>7} {:>6} {:>9} {:>9} {:>6}\n",
                    "image", "RMSE", "relMSE", "RMSE L", "PSNR", "SSIM", "FLIP", "visible", "seams",
                    "mean spp", "seconds", "rule");
    for (const ComparedImage& image : comparison.images)
        text += ImageLine(comparison, image) + "\n";

    for (const ComparedImage& image : comparison.images)
        if (image.figures) text += VisibleBlocksLine(comparison, image) + "\n";
    const Json json = ComparisonJson(report);
    for (const Json& image : json["images"])
        if (image.contains("saved") && image["name"] != json["reference"])
            text += fmt::format(
                "{} saves, against {} spp everywhere, {} of the samples{}\n",
                image["name"].get<std::string>(), comparison.cap,
                Percent(image["saved"]["samples"]),
                image["saved"]["seconds"].is_null()
                    ? ""
                    : fmt::format(" and {} of the CPU time{}", Percent(image["saved"]["seconds"]),
                                  image["saved"]["estimated"].get<bool>() ? " (estimated)" : ""));
    if (const Json& human = json["againstHuman"]; human.is_object())
        text += fmt::format(
            "automatic against human: {} blocks earlier, {} later, {:.0f} spp apart on average; "
            "{} {} samples\n",
            human["earlier"].get<int>(), human["later"].get<int>(),
            human["meanDistance"].get<double>(),
            Percent(std::abs(human["savedSamples"].get<double>())),
            human["savedSamples"].get<double>() < 0 ? "more" : "fewer");
    if (report.estimates && report.estimates->blocks > 0)
        text += fmt::format(
            "seconds to the cap, estimated where {} blocks stopped: {:+.1f} % off the measured in "
            "all, {:+.1f} % at the worst\n",
            report.estimates->blocks, 100 * report.estimates->total, 100 * report.estimates->worst);
    for (const Json& v : json["verifications"])
        text += fmt::format(
            "automatic by itself on {} threads: {:.1f} s, {} saved; the rule took {:.2f} %; {} of "
            "the saving in samples kept; {}\n",
            v["threads"].get<int>(), v["wallSeconds"].get<double>(), Percent(v["savedWall"]),
            100 * v["ruleShare"].get<double>(), Percent(v["kept"]),
            v["samePixels"].get<bool>() ? "the same bits" : "OTHER PIXELS");
    return text;
}

}  // namespace lull
