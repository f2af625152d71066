#include "renderer/lab/pages/curves_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stopping/base/csv.h"
#include "stopping/network/human_range.h"

namespace lull {

namespace {

// In units of the SVG.
constexpr int kColumns = 4, kPanelWidth = 210, kPanelHeight = 120, kGapX = 40, kGapY = 46;
constexpr int kLeft = 40, kTop = 60;
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"};

const char* ColourOf(size_t rule) { return kColours[rule % std::size(kColours)]; }

std::string EscapedForXml(const std::string& text) {
    std::string escaped;
    for (const char c : text)
        if (c == '<')
            escaped += "&lt;";
        else if (c == '&')
            escaped += "&amp;";
        else
            escaped += c;
    return escaped;
}

bool IsDrawn(const BlockVerdict& verdict, const CurvesOfRule& rule) {
    return rule.threshold > 0 && std::isfinite(verdict.score);
}

// The spp that all panels show.
struct SppAxis {
    double least = 20, most = kMostShownSpp;

    double At(double spp) const {
        const double share = std::log(spp / least) / std::log(most / least);
        return kPanelWidth * std::clamp(share, 0.0, 1.0);
    }
};

SppAxis AxisOf(const std::vector<CurvesOfRule>& rules) {
    double least = kMostShownSpp / 2.0, most = 2;
    for (const CurvesOfRule& rule : rules)
        for (const BlockOutcome& block : rule.outcome->blocks) {
            most = std::max({most, double(block.human), double(block.outcome.stop)});
            for (const BlockVerdict& verdict : block.outcome.verdicts) {
                least = std::min(least, double(verdict.spp));
                most = std::max(most, double(verdict.spp));
            }
        }
    return {.least = std::min(least, most / 2), .most = most};
}

// Returns the powers of ten that an axis shows, and two and five times them where it is short.
std::vector<int> TicksOf(const SppAxis& axis) {
    const bool isShort = axis.most < 100 * axis.least;
    std::vector<int> ticks;
    for (int power = 1; power <= 1000000; power *= 10)
        for (const int factor : {1, 2, 5})
            if ((factor == 1 || isShort) && factor * power >= axis.least &&
                factor * power <= axis.most)
                ticks.push_back(factor * power);
    return ticks;
}

// Returns the height in a panel of a number over twice its threshold.
double HeightOf(double number, double threshold) {
    return kPanelHeight * (1 - std::clamp(number / (2 * threshold), 0.0, 1.0));
}

std::string FrameOf(int block, const SppAxis& axis) {
    std::string svg = fmt::format(
        "<rect width='{}' height='{}' fill='none' stroke='#999'/>"
        "<path d='M0 {}h{}' stroke='#bbb' stroke-dasharray='1 3'/>"
        "<text x='{}' y='-5' text-anchor='middle'>block {}</text>",
        kPanelWidth, kPanelHeight, kPanelHeight / 2, kPanelWidth, kPanelWidth / 2, block);
    for (const int tick : TicksOf(axis))
        svg += fmt::format(
            "<path d='M{:.1f} {}v4' stroke='#999'/>"
            "<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>",
            axis.At(tick), kPanelHeight, axis.At(tick), kPanelHeight + 16, tick);
    for (const double y : {0.0, 0.5, 1.0})
        svg += fmt::format("<text x='-5' y='{:.1f}' text-anchor='end'>{}</text>",
                           kPanelHeight * (1 - y) + 4, y);
    return svg;
}

std::string CurveOf(const CurvesOfRule& rule, const BlockOutcome& block, const char* colour,
                    const SppAxis& axis) {
    std::string points;
    double stopHeight = kPanelHeight / 2.0;
    for (const BlockVerdict& verdict : block.outcome.verdicts) {
        if (!IsDrawn(verdict, rule)) continue;
        const double y = HeightOf(verdict.score, rule.threshold);
        points +=
            fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", axis.At(verdict.spp), y);
        if (verdict.spp <= block.outcome.stop) stopHeight = y;
    }
    std::string svg;
    if (!points.empty())
        svg += fmt::format("<polyline points='{}' fill='none' stroke='{}'/>", points, colour);
    return svg + fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}' stroke='{}'/>",
                             axis.At(block.outcome.stop), stopHeight,
                             block.outcome.open ? "none" : colour, colour);
}

std::string LegendOf(const std::string& viewpoint, const std::vector<CurvesOfRule>& rules) {
    std::string svg = fmt::format("<text x='{}' y='18' font-weight='bold'>{}</text>", kLeft,
                                  EscapedForXml(viewpoint));
    svg += fmt::format("<text x='{}' y='36'>", kLeft);
    for (size_t i = 0; i < rules.size(); ++i)
        svg +=
            fmt::format("<tspan fill='{}'>{}</tspan>; ", ColourOf(i), EscapedForXml(rules[i].name));
    return svg +
           "probability of noise, or number over twice its threshold, against samples per pixel; "
           "dot: "
           "stop; dashed: people</text>";
}

}  // namespace

std::string CurvesSvg(const std::string& viewpoint, const std::vector<CurvesOfRule>& rules) {
    const std::vector<BlockOutcome>& blocks = rules.front().outcome->blocks;
    const SppAxis axis = AxisOf(rules);
    const int rows = (int(blocks.size()) + kColumns - 1) / kColumns;
    const int width = kLeft + kColumns * (kPanelWidth + kGapX),
              height = kTop + rows * (kPanelHeight + kGapY);
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
        "font-family='sans-serif' font-size='11'>\n<rect width='{0}' height='{1}' fill='white'/>\n"
        "{2}\n",
        width, height, LegendOf(viewpoint, rules));
    for (size_t i = 0; i < blocks.size(); ++i) {
        svg += fmt::format(
            "<g transform='translate({} {})'>{}", kLeft + int(i) % kColumns * (kPanelWidth + kGapX),
            kTop + int(i) / kColumns * (kPanelHeight + kGapY) + 10, FrameOf(blocks[i].block, axis));
        svg += fmt::format("<path d='M{:.1f} 0v{}' stroke='black' stroke-dasharray='5 3'/>",
                           axis.At(blocks[i].human), kPanelHeight);
        for (size_t r = 0; r < rules.size(); ++r)
            svg += CurveOf(rules[r], rules[r].outcome->blocks[i], ColourOf(r), axis);
        svg += "</g>\n";
    }
    return svg + "</svg>\n";
}

std::string CurvesCsv(const std::vector<CurvesOfRule>& rules) {
    std::string csv = "rule,viewpoint,block,human,stop,spp,value,threshold,noisy\n";
    for (const CurvesOfRule& rule : rules)
        for (const BlockOutcome& block : rule.outcome->blocks)
            for (const BlockVerdict& verdict : block.outcome.verdicts)
                if (IsDrawn(verdict, rule))
                    csv += fmt::format("{},{},{},{},{},{},{:.9g},{:g},{}\n", CsvField(rule.name),
                                       CsvField(rule.outcome->name), block.block, block.human,
                                       block.outcome.stop, verdict.spp, verdict.score,
                                       rule.threshold, int(verdict.noisy));
    return csv;
}

}  // namespace lull
