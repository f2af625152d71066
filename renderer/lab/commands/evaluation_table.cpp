#include "renderer/lab/commands/evaluation_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>

#include "stopping/base/csv.h"

namespace lull {

namespace {

// The row of a table.
struct Row {
    std::string rule, viewpoint, setting;
    Scores scores;
};

// Makes the rows of a rule: one for each viewpoint, and one for all of them.
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

// Prints a table whose first column is the rule or the viewpoint.
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

}  // namespace lull
