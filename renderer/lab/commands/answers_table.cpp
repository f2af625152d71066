#include "renderer/lab/commands/answers_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "stopping/base/csv.h"

namespace lull {

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

}  // namespace lull
