#include "renderer/lab/comparison/bench.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/files/file_contents.h"
#include "stopping/base/parallel.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

std::string Trim(const std::string& text) {
    const size_t begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// Parses all of the text as seconds >= 0.
bool ParseSeconds(const std::string& text, double* seconds) {
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, *seconds);
    return error == std::errc() && rest == end && *seconds >= 0 && std::isfinite(*seconds);
}

}  // namespace

std::vector<int> FixedLadder(int passLength, int cap) {
    std::vector<int> ladder;
    for (int passes = 1; passes * passLength < cap; passes += (passes + 1) / 2)
        ladder.push_back(passes * passLength);
    ladder.push_back(cap);
    return ladder;
}

std::vector<std::string> BenchRules(int passLength, int cap) {
    std::vector<std::string> rules;
    for (const int spp : FixedLadder(passLength, cap))
        rules.push_back(fmt::format("fixed:{}", spp));
    for (const RuleEntry& rule : RuleTable())
        for (const double setting : rule.sweep.bench)
            rules.push_back(fmt::format("{}:{}", rule.name, setting));
    return rules;
}

std::vector<BenchPoint> MeasurePoints(const MonitoredRender& render,
                                      const std::vector<MonitoredRule>& rules,
                                      const RgbImage& reference, const DisplayModel& display,
                                      int threads, const std::function<void()>& onPoint) {
    std::vector<BenchPoint> points(rules.size());
    std::mutex mutex;  // guards onPoint
    const double pixels = double(render.context.film->Region().Area());
    const auto measure = [&](int index) {
        const MonitoredRule& rule = rules[size_t(index)];
        const ComparedImage image = TakeImage(render, rules, size_t(index));
        BenchPoint& point = points[size_t(index)];
        const size_t colon = std::min(rule.text.find(':'), rule.text.size());
        point.rule = rule.text.substr(0, colon);
        point.setting = rule.text.substr(std::min(colon + 1, rule.text.size()));
        double samples = 0;
        for (size_t b = 0; b < image.costs.size(); ++b) {
            const BlockCost& cost = image.costs[b];
            samples += double(cost.spp) * double(render.result.blocks[b].block.pixels.Area());
            point.ruleSeconds += cost.ruleSeconds;
            point.threadSeconds += cost.seconds + cost.ruleSeconds;
        }
        point.spp = samples / pixels;
        point.seconds = point.threadSeconds / threads;
        point.figures = Average(CompareImages(image.image, reference, display));
        const std::lock_guard lock(mutex);
        if (onPoint) onPoint();
    };
    // One after the other, as denoising is timed.
    for (int i = 0; i < int(rules.size()); ++i)
        if (rules[size_t(i)].isDenoised) measure(i);
    ForEachIndex(int(rules.size()), [&](int i) {
        if (!rules[size_t(i)].isDenoised) measure(i);
    });
    return points;
}

namespace {

// Returns a figure as a table has it: nothing if it is infinite or not known.
std::string Figure(double value, int digits = 6) {
    return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "";
}

}  // namespace

std::string BenchCsv(const std::vector<BenchPoint>& points) {
    std::string text =
        "rule,setting,sampler,spp,seconds,thread_seconds,rule_seconds,shares_reference,"
        "rmse_lightness,relmse,ssim,flip,rmse,psnr,visible_difference\n";
    for (const BenchPoint& p : points) {
        const ErrorFigures& f = p.figures;
        text +=
            fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},{},{},{},{},{}\n", p.rule,
                        p.setting, p.sampler, p.spp, p.seconds, p.threadSeconds, p.ruleSeconds,
                        p.sharesReference ? "yes" : "no", Figure(f.rmseLightness), Figure(f.relMse),
                        Figure(f.ssim, 8), Figure(f.flip), Figure(f.rmse), Figure(f.psnr),
                        Figure(f.visibleDifference));
    }
    return text;
}

std::vector<ExternalImage> ReadExternalImages(const std::string& csv) {
    std::istringstream in{std::string(ReadFile(csv).View())};
    std::vector<ExternalImage> images;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (Trim(line).empty()) continue;
        const size_t first = line.find(','), second = line.find(',', first + 1);
        ExternalImage image;
        const bool hasFields = first != std::string::npos && second != std::string::npos;
        if (hasFields) {
            image.name = Trim(line.substr(0, first));
            image.file = Trim(line.substr(second + 1));
        }
        const std::string seconds =
            hasFields ? Trim(line.substr(first + 1, second - first - 1)) : "";
        if (number == 1 && seconds == "seconds") continue;
        if (image.name.empty() || image.file.empty() || !ParseSeconds(seconds, &image.seconds))
            throw Error(fmt::format("{}:{}: 'name,seconds,file.exr' is needed", csv, number));
        image.file = (std::filesystem::path(csv).parent_path() / image.file).string();
        images.push_back(std::move(image));
    }
    return images;
}

BenchPoint MeasureExternal(const ExternalImage& external, const RgbImage& image,
                           const RgbImage& reference, const DisplayModel& display) {
    BenchPoint point;
    point.rule = external.name;
    point.seconds = external.seconds;
    point.figures = Average(CompareImages(image, reference, display));
    return point;
}

}  // namespace lull
