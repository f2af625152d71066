#include "renderer/lab/commands/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>

#include "stopping/base/input_file.h"

namespace lull {

namespace {

struct Row {
    std::string rule, viewpoint, setting;
    Scores scores;
};

std::vector<Row> MakeRows(const EvaluatedRule& rule, const ScoreOptions& options) {
    std::vector<Row> rows;
    for (const ViewpointOutcome& viewpoint : rule.viewpoints)
        rows.push_back({LabelOf(rule), viewpoint.name, viewpoint.setting,
                        Score(std::span(&viewpoint, 1), options)});
    rows.push_back({LabelOf(rule), "all", rule.setting, Score(rule.viewpoints, options)});
    return rows;
}

std::string PercentText(std::optional<double> share, int digits) {
    return share ? fmt::format("{:.{}f}", 100 * *share, digits) : "-";
}

std::string TextOf(const std::optional<Interval>& shares) {
    return shares ? fmt::format("{:.1f}-{:.1f}", 100 * shares->low, 100 * shares->high) : "-";
}

std::string RankText(std::optional<double> correlation) {
    return correlation ? fmt::format("{:.2f}", *correlation) : "-";
}

void PrintRows(std::FILE* out, const std::string& label, std::string Row::*first,
               const std::vector<Row>& rows, const ScoreOptions& options) {
    size_t width = label.size(), settingWidth = std::string("setting").size();
    for (const Row& row : rows) {
        width = std::max(width, (row.*first).size());
        settingWidth = std::max(settingWidth, row.setting.size());
    }
    fmt::print(out, "{:<{}}  {:<{}}  {:>5}  {:>6}  {:>4}  {:>4}", label, width, "setting",
               settingWidth, "views", "blocks", "seen", "open");
    for (const double margin : options.margins)
        fmt::print(out, "  {:>6}", fmt::format("ce{:g}", margin));
    fmt::print(out, "  {:>11}  {:>6}  {:>5}  {:>5}  {:>5}  {:>5}  {:>5}  {:>6}  {:>7}\n", "95 %",
               "error", "err%", "early", "late", "acc", "auc", "within", "between");
    for (const Row& row : rows) {
        const Scores& j = row.scores;
        fmt::print(out, "{:<{}}  {:<{}}  {:>5}  {:>6}  {:>4}  {:>4}", row.*first, width,
                   row.setting, settingWidth, j.viewpoints, j.blocks, j.seen, j.open);
        for (const double error : j.criticalErrors) fmt::print(out, "  {:>6.2f}", 100 * error);
        fmt::print(
            out, "  {:>11}  {:>6.0f}  {:>5.1f}  {:>5.1f}  {:>5.1f}  {:>5}  {:>5}  {:>6}  {:>7}\n",
            TextOf(j.criticalInterval), j.absoluteError, 100 * j.absoluteError / kMostShownSpp,
            100 * j.early, 100 * j.late, PercentText(j.accuracy, 1), PercentText(j.auc, 1),
            RankText(j.rankWithin), RankText(j.rankBetween));
    }
}

}  // namespace

void PrintEvaluation(std::FILE* out, const std::vector<EvaluatedRule>& rules,
                     const ScoreOptions& options, bool each) {
    std::vector<Row> overall;
    for (const EvaluatedRule& rule : rules) {
        const std::vector<Row> rows = MakeRows(rule, options);
        overall.push_back(rows.back());
        if (!each) continue;
        fmt::print(out, "{}\n", LabelOf(rule));
        PrintRows(out, "viewpoint", &Row::viewpoint, rows, options);
        fmt::print(out, "\n");
    }
    if (each && rules.size() == 1) return;
    PrintRows(out, "rule", &Row::rule, overall, options);
}

std::string EvaluationCsv(const std::vector<EvaluatedRule>& rules, const ScoreOptions& options) {
    std::string csv = "rule,viewpoint,setting,viewpoints,blocks,seen,open";
    const auto out = std::back_inserter(csv);
    for (const double margin : options.margins) fmt::format_to(out, ",critical_error_{:g}", margin);
    csv +=
        ",critical_error_low,critical_error_high,absolute_error_spp,early,late,accuracy,auc,"
        "rank_within,rank_between\n";
    for (const EvaluatedRule& rule : rules)
        for (const Row& row : MakeRows(rule, options)) {
            const Scores& j = row.scores;
            fmt::format_to(out, "{},{},{},{},{},{},{}", CsvField(row.rule), CsvField(row.viewpoint),
                           CsvField(row.setting), j.viewpoints, j.blocks, j.seen, j.open);
            for (const double error : j.criticalErrors) fmt::format_to(out, ",{:.6f}", error);
            const auto interval = j.criticalInterval;
            fmt::format_to(out, ",{},{},{:.2f},{:.6f},{:.6f},{},{},{},{}\n",
                           CsvField(interval ? std::optional(interval->low) : std::nullopt),
                           CsvField(interval ? std::optional(interval->high) : std::nullopt),
                           j.absoluteError, j.early, j.late, CsvField(j.accuracy), CsvField(j.auc),
                           CsvField(j.rankWithin), CsvField(j.rankBetween));
        }
    return csv;
}

std::string BlocksCsv(const std::vector<EvaluatedRule>& rules) {
    std::string csv = "rule,viewpoint,setting,block,seen,human,stop,open\n";
    for (const EvaluatedRule& rule : rules)
        for (const ViewpointOutcome& viewpoint : rule.viewpoints)
            for (const BlockOutcome& b : viewpoint.blocks)
                fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{},{}\n",
                               CsvField(LabelOf(rule)), CsvField(viewpoint.name),
                               CsvField(viewpoint.setting), b.block, int(b.seen), b.human,
                               b.outcome.stop, int(b.outcome.open));
    return csv;
}

std::string CurvesCsv(const std::vector<EvaluatedRule>& rules) {
    std::string csv = "rule,viewpoint,block,human,stop,spp,value,threshold,noisy\n";
    for (const EvaluatedRule& rule : rules) {
        if (rule.threshold == 0 || rule.openStops == OpenStops::Extended) continue;
        for (const ViewpointOutcome& viewpoint : rule.viewpoints)
            for (const BlockOutcome& block : viewpoint.blocks)
                for (const BlockVerdict& verdict : block.outcome.verdicts)
                    if (std::isfinite(verdict.score))
                        fmt::format_to(std::back_inserter(csv),
                                       "{},{},{},{},{},{},{:.9g},{:g},{}\n", CsvField(rule.name),
                                       CsvField(viewpoint.name), block.block, block.human,
                                       block.outcome.stop, verdict.spp, verdict.score,
                                       rule.threshold, int(verdict.noisy));
    }
    return csv;
}

namespace {

// Returns a number without a sign where it is rounded to 0.
std::string NumberText(const std::optional<double>& number, double factor, int digits) {
    if (!number) return "-";
    const double unit = std::pow(10, digits);
    return fmt::format("{:.{}f}", std::round(factor * *number * unit) / unit + 0.0, digits);
}

void PrintUsed(std::FILE* out, const std::string& viewpoint, const AnswersUsed& used) {
    fmt::print(out, "{}: {} of {} answers, to {} of {} blocks, count\n", viewpoint, used.answers,
               used.all, used.blocks, used.allBlocks);
    if (used.tracks > 0)
        fmt::print(out, "of these, the answers within each of {} adjustments count as one\n",
                   used.tracks);
    if (used.notRecorded > 0)
        fmt::print(out, "left out: {} answers to blocks that are not recorded ({})\n",
                   used.notRecorded, fmt::join(used.blocksNotRecorded, ", "));
    if (used.withoutNumber > 0)
        fmt::print(out, "left out: {} answers at spp where not every rule has a number\n",
                   used.withoutNumber);
}

void PrintBlocks(std::FILE* out, const AnswerScores& scores) {
    fmt::print(out, "\n{:>5}  {:>7}  {:>4}  {:>9}  {}\n", "block", "answers", "seen", "threshold",
               "stops");
    for (size_t i = 0; i < scores.blocks.size(); ++i) {
        const AnsweredBlock& block = scores.blocks[i];
        std::vector<int> stops;
        for (const RuleByAnswers& rule : scores.rules) stops.push_back(rule.stops[i]);
        fmt::print(out, "{:>5}  {:>7}  {:>4}  {:>9}  {}\n", block.block, block.answers, block.seen,
                   NumberText(block.threshold, 1, 0), fmt::join(stops, "  "));
    }
}

}  // namespace

void PrintAnswerScores(std::FILE* out, const AnswerScores& scores, bool each) {
    PrintUsed(out, scores.viewpoint, scores.used);
    if (each) PrintBlocks(out, scores);
    size_t width = std::string("one threshold for all").size();
    for (const RuleByAnswers& rule : scores.rules) width = std::max(width, rule.rule.size());
    fmt::print(out, "\n{:<{}}  {:>8}  {:>6}  {:>6}  {:>5}  {:>5}  {:>5}  {:>5}  {:>4}\n", "rule",
               width, "loglik", "share", "slope", "auc", "early", "late", "level", "open");
    const auto bound = [&](const char* name, double logLikelihood, int share) {
        fmt::print(out, "{:<{}}  {:>8}  {:>6}\n", name, width, NumberText(logLikelihood, 1, 2),
                   share);
    };
    bound("one threshold a block", scores.best, 100);
    for (const RuleByAnswers& rule : scores.rules)
        fmt::print(out, "{:<{}}  {:>8}  {:>6}  {:>6.2f}  {:>5.1f}  {:>5}  {:>5}  {:>5}  {:>4}\n",
                   rule.rule, width, NumberText(rule.logLikelihood, 1, 2),
                   NumberText(rule.explained, 100, 1), rule.slope, 100 * rule.auc,
                   NumberText(rule.early, 100, 1), NumberText(rule.late, 100, 1),
                   NumberText(rule.level, 1, 2), rule.open);
    bound("one threshold for all", scores.worst, 0);
}

std::string AnswerScoresCsv(const AnswerScores& scores) {
    std::string csv =
        "rule,viewpoint,answers,blocks,log_likelihood,best,worst,explained,slope,auc,early,late,"
        "level,open\n";
    for (const RuleByAnswers& rule : scores.rules)
        csv += fmt::format("{},{},{},{},{:.4f},{:.4f},{:.4f},{},{:.6f},{:.6f},{},{},{},{}\n",
                           CsvField(rule.rule), CsvField(scores.viewpoint), scores.used.answers,
                           scores.used.blocks, rule.logLikelihood, scores.best, scores.worst,
                           CsvField(rule.explained), rule.slope, rule.auc, CsvField(rule.early),
                           CsvField(rule.late), CsvField(rule.level), rule.open);
    return csv;
}

namespace {

std::string Figure(const char* format, double value) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string FiguresLine(const std::string& name, const ErrorFigures& f) {
    return fmt::format("{:<12} {:>9} {:>9} {:>7.3f} {:>7} {:>8} {:>7.4f} {:>7}", name,
                       Figure("{:.4g}", f.rmse), Figure("{:.3g}", f.relMse), f.rmseLightness,
                       Figure("{:.2f}", f.psnr), Figure("{:.5f}", f.ssim), f.flip,
                       Figure("{:.3g}", f.visibleDifference));
}

std::string ImageLine(const Comparison& comparison, const ComparedImage& image) {
    std::string line = fmt::format("{:<12}", image.name);
    if (image.figures) {
        line = FiguresLine(image.name, *image.figures);
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
    for (const ComparedImage& image : comparison.images) {
        text += ImageLine(comparison, image) + "\n";
        for (size_t i = 0; i < image.eyes.size(); ++i)
            text += FiguresLine(i == 0 ? "  left eye" : "  right eye", image.eyes[i]) + "\n";
    }

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
