#include "stopping/lab/evaluation/answer_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/evaluation/simulation.h"
#include "stopping/lab/recordings/extension.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

constexpr const char* kHead = "block,spp,noise_seen";
constexpr const char* kTrackHead = "block,spp,noise_seen,observer,track";
constexpr int kMostBlocks = 1 << 16, kMostSpp = 1 << 24;

bool TakeNumber(std::string_view* text, int* number) {
    const auto [rest, error] = std::from_chars(text->data(), text->data() + text->size(), *number);
    text->remove_prefix(size_t(rest - text->data()));
    return error == std::errc();
}

bool TakeComma(std::string_view* text) {
    if (!text->starts_with(',')) return false;
    text->remove_prefix(1);
    return true;
}

// Takes the observer, who can have commas, and the track, which can be missing.
bool TakeTrack(std::string_view* text, SingleAnswer* answer) {
    const size_t end = text->rfind(',');
    if (end == std::string_view::npos) return false;
    answer->observer = text->substr(0, end);
    text->remove_prefix(end + 1);
    return text->empty() || (TakeNumber(text, &answer->track) && answer->track >= 1);
}

SingleAnswer ParseAnswer(const std::string& line, bool hasTrack) {
    SingleAnswer answer;
    std::string_view rest = line;
    int block = 0, spp = 0, seen = 0;
    const bool isWhole = TakeNumber(&rest, &block) && TakeComma(&rest) && TakeNumber(&rest, &spp) &&
                         TakeComma(&rest) && TakeNumber(&rest, &seen) &&
                         (!hasTrack || (TakeComma(&rest) && TakeTrack(&rest, &answer)));
    if (!isWhole || !rest.empty())
        throw std::invalid_argument(
            "'" + Printable(line) + "' is not an answer; " +
            (hasTrack
                 ? "three whole numbers, the observer and a track are needed, as in 5,640,1,ada,3"
                 : "three whole numbers are needed, as in 5,640,1"));
    if (block < 0 || block >= kMostBlocks)
        throw std::invalid_argument("there can be no block " + std::to_string(block) +
                                    "; blocks are counted from 0, row by row");
    if (spp < 1 || spp > kMostSpp)
        throw std::invalid_argument(std::to_string(spp) +
                                    " samples per pixel cannot be; give those of the picture");
    if (seen != 0 && seen != 1)
        throw std::invalid_argument("noise_seen is " + std::to_string(seen) +
                                    "; 1 is needed where noise was seen, else 0");
    answer.block = block;
    answer.spp = spp;
    answer.seen = seen == 1;
    return answer;
}

}  // namespace

std::vector<SingleAnswer> ReadSingleAnswers(std::istream& in, const std::string& fileName) {
    std::vector<SingleAnswer> answers;
    bool hasHead = false, hasTrack = false;
    for (TextLines lines(in, fileName); lines.Next();) {
        const std::string& line = lines.Line();
        const int number = lines.Number();
        if (line.empty()) continue;
        try {
            if (!hasHead && line != kHead && line != kTrackHead)
                throw std::invalid_argument(std::string("the first line has to be ") + kHead +
                                            ", or " + kTrackHead);
            if (!hasHead) hasTrack = line == kTrackHead;
            if (hasHead) {
                answers.push_back(ParseAnswer(line, hasTrack));
                answers.back().line = number;
            }
            hasHead = true;
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(fileName + ":" + std::to_string(number) + ": " + error.what());
        }
    }
    if (answers.empty())
        throw std::runtime_error(fileName + ": has no answers; lines of " + kHead + " are needed");
    return answers;
}

std::vector<SingleAnswer> ReadSingleAnswers(const std::string& path) {
    std::ifstream file = OpenInput(path);
    return ReadSingleAnswers(file, path);
}

void CheckBlocks(std::span<const SingleAnswer> answers, int blockCount,
                 const std::string& fileName) {
    for (const SingleAnswer& answer : answers)
        if (answer.block >= blockCount)
            throw std::runtime_error(fileName + ":" + std::to_string(answer.line) + ": block " +
                                     std::to_string(answer.block) +
                                     ", but the recorded picture has the blocks 0 to " +
                                     std::to_string(blockCount - 1));
}

namespace {

// Numbers are taken to be no closer to 0, and probabilities no closer to 0 and 1.
constexpr double kLeastNumber = 1e-4, kLeastProbability = 1e-6;

// Returns the variable in which the probit is linear.
double Abscissa(double number, bool isProbability) {
    if (!isProbability) return std::log(std::max(number, kLeastNumber));
    const double p = std::clamp(number, kLeastProbability, 1 - kLeastProbability);
    return std::log(p / (1 - p));
}

struct Curve {
    std::vector<double> logSpp = {}, values = {};

    // Returns the value at `spp`: linear between two, and that of the last one `slack` spp beyond.
    std::optional<double> At(double spp, double slack) const {
        const double x = std::log(spp);
        const size_t next = size_t(std::ranges::lower_bound(logSpp, x) - logSpp.begin());
        if (next < logSpp.size() && logSpp[next] == x) return values[next];
        if (next == 0) return {};
        if (next == logSpp.size()) {
            if (spp > std::exp(logSpp.back()) + slack) return {};
            return values.back();
        }
        const double share = (x - logSpp[next - 1]) / (logSpp[next] - logSpp[next - 1]);
        return std::lerp(values[next - 1], values[next], share);
    }
};

Curve CurveOf(const RuleOutcome& outcome, int end, bool isProbability) {
    Curve curve;
    for (const BlockVerdict& verdict : outcome.verdicts) {
        if (verdict.spp > end || std::isinf(verdict.score)) continue;
        curve.logSpp.push_back(std::log(verdict.spp));
        curve.values.push_back(Abscissa(verdict.score, isProbability));
    }
    return curve;
}

struct RuleRun {
    std::string rule;
    bool isKnown = false;  // whether its stops need no recording
    std::vector<RuleOutcome> outcomes;
    std::vector<Curve> curves;
};

RuleRun RunRule(const std::string& rule, const RuleContext& context,
                std::span<const LabelledBlock> recorded, std::span<const LabelledBlock> extended) {
    const Simulator simulator = MakeSimulator(rule, context);
    const RecordedRule* recordedRule = FindRecordedRule(rule);
    const RuleEntry* entry = FindRule(rule);
    RuleRun run{.rule = rule,
                .isKnown = recordedRule && recordedRule->replay == Replay::Counts,
                .outcomes = {},
                .curves = {}};
    for (size_t i = 0; i < recorded.size(); ++i) {
        run.outcomes.push_back(simulator(extended[i]));
        run.curves.push_back(CurveOf(run.outcomes.back(), recorded[i].recording->spp.back(),
                                     entry && entry->compares == RuleTrend::Probability));
    }
    return run;
}

std::vector<LabelledBlock> BlocksOf(const ViewpointRecording& viewpoint,
                                    const std::set<int>& answered) {
    std::vector<LabelledBlock> blocks;
    for (const auto& [number, recording] : viewpoint.blocks)
        if (answered.contains(number))
            blocks.push_back({.viewpoint = viewpoint.name,
                              .block = number,
                              .passSpp = viewpoint.passSpp,
                              .recording = &recording});
    return blocks;
}

// An answer that counts, with the place of its block, and each rule's number there.
struct Asked {
    SingleAnswer answer;
    size_t place;
    std::vector<double> values;
    double weight = 1;
};

int WeighTracks(std::vector<Asked>* asked) {
    std::map<int, int> counts;
    for (const Asked& one : *asked)
        if (one.answer.track > 0) ++counts[one.answer.track];
    for (Asked& one : *asked)
        if (one.answer.track > 0) one.weight = 1.0 / counts[one.answer.track];
    return int(counts.size());
}

std::vector<Asked> AskRules(std::span<const SingleAnswer> answers,
                            std::span<const LabelledBlock> blocks, std::span<const RuleRun> runs,
                            AnswersUsed* used) {
    std::vector<Asked> asked;
    std::set<int> without;
    // Pictures at any spp are their own last word.
    const double slack = blocks.empty() ? 0 : 2 * blocks.front().passSpp;
    for (const SingleAnswer& answer : answers) {
        const auto block = std::ranges::find(blocks, answer.block, &LabelledBlock::block);
        if (block == blocks.end()) {
            ++used->notRecorded;
            without.insert(answer.block);
            continue;
        }
        Asked one{.answer = answer, .place = size_t(block - blocks.begin()), .values = {}};
        for (const RuleRun& run : runs)
            if (const auto value = run.curves[one.place].At(answer.spp, slack))
                one.values.push_back(*value);
        if (one.values.size() == runs.size())
            asked.push_back(std::move(one));
        else
            ++used->withoutNumber;
    }
    used->blocksNotRecorded = {without.begin(), without.end()};
    return asked;
}

// Fits the answers to a constant for each of `places` places, and a slope in `abscissa`, which is
// the last coefficient, of the numbers less their mean, over their deviation.
struct ScaledFit {
    ProbitFit fit;
    double mean = 0, deviation = 1;

    double Slope() const { return fit.coefficients[fit.coefficients.size() - 1] / deviation; }
};

ScaledFit FitAnswers(std::span<const Asked> asked, size_t places, const auto& placeOf,
                     const auto& abscissaOf) {
    const auto count = Eigen::Index(asked.size());
    Eigen::VectorXd x(count), answers(count), weights(count);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, Eigen::Index(places) + 1);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Asked& one = asked[size_t(i)];
        x[i] = abscissaOf(one);
        answers[i] = one.answer.seen;
        weights[i] = one.weight;
        rows(i, Eigen::Index(placeOf(one))) = 1;
    }
    ScaledFit scaled{.fit = {}, .mean = x.mean()};
    const double deviation = std::sqrt((x.array() - scaled.mean).square().mean());
    if (deviation > 1e-12) scaled.deviation = deviation;
    rows.col(Eigen::Index(places)) = (x.array() - scaled.mean) / scaled.deviation;
    scaled.fit = FitProbit(rows, answers, weights);
    return scaled;
}

double LogSpp(const Asked& one) { return std::log(one.answer.spp); }

std::vector<AnsweredBlock> ThresholdsOfBlocks(std::span<const Asked> asked,
                                              std::span<const LabelledBlock> blocks,
                                              const ScaledFit& best) {
    std::vector<AnsweredBlock> answered;
    for (const LabelledBlock& block : blocks) answered.push_back({.block = block.block});
    for (const Asked& one : asked) {
        ++answered[one.place].answers;
        answered[one.place].seen += one.answer.seen;
    }
    for (size_t i = 0; i < answered.size(); ++i)
        // Noise has to be seen less with more samples for there to be a threshold.
        if (answered[i].seen > 0 && answered[i].seen < answered[i].answers && best.Slope() < 0)
            answered[i].threshold =
                std::exp(best.mean - best.fit.coefficients[Eigen::Index(i)] / best.Slope());
    return answered;
}

RuleByAnswers ScoreRule(const RuleRun& run, size_t index, std::span<const Asked> asked,
                        std::span<const LabelledBlock> blocks, const AnswerScores& scores) {
    const auto valueOf = [&](const Asked& one) { return one.values[index]; };
    const ScaledFit own = FitAnswers(
        asked, 1, [](const Asked&) { return size_t(0); }, valueOf);
    RuleByAnswers result{
        .rule = run.rule, .logLikelihood = own.fit.logLikelihood, .slope = own.Slope()};
    if (const double span = scores.best - scores.worst; span > 1e-6)
        result.explained = (result.logLikelihood - scores.worst) / span;
    std::vector<float> values;
    std::vector<char> labels;
    for (const Asked& one : asked) {
        values.push_back(float(valueOf(one)));
        labels.push_back(one.answer.seen);
    }
    result.auc = AreaUnderRoc(values, labels);

    double early = 0, late = 0, logs = 0, count = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
        const int stop = run.outcomes[i].stop, end = blocks[i].recording->spp.back();
        result.stops.push_back(stop);
        result.open += !run.isKnown && end < kMostShownSpp && stop > end;
        if (!scores.blocks[i].threshold) continue;
        const double ratio = std::max(1, stop) / *scores.blocks[i].threshold;
        early += ratio < 0.8;
        late += ratio > 1.25;
        logs += std::log(ratio);
        ++count;
    }
    if (count > 0) {
        result.early = early / count;
        result.late = late / count;
        result.level = std::exp(logs / count);
    }
    return result;
}

}  // namespace

AnswerScores EvaluateByAnswers(const ViewpointRecording& viewpoint,
                               std::span<const SingleAnswer> answers,
                               std::span<const std::string> rules, const RuleContext& context) {
    std::set<int> answered;
    for (const SingleAnswer& answer : answers) answered.insert(answer.block);
    const std::vector<LabelledBlock> recorded = BlocksOf(viewpoint, answered);
    const ExtendedBlocks extended = ExtendBlocks(recorded);
    RuleContext ofRecording = context;
    ofRecording.passSpp = viewpoint.passSpp;
    std::vector<RuleRun> runs;
    for (const std::string& rule : rules)
        runs.push_back(RunRule(rule, ofRecording, recorded, extended.blocks));

    AnswerScores scores{.viewpoint = viewpoint.name};
    AnswersUsed& used = scores.used;
    used.all = int(answers.size());
    used.allBlocks = int(answered.size());
    std::vector<Asked> asked = AskRules(answers, recorded, runs, &used);
    used.tracks = WeighTracks(&asked);
    if (asked.empty())
        throw std::runtime_error(fmt::format(
            "no answer is to a recorded block of '{}' at an spp where all rules have a number; "
            "record blocks that were answered",
            viewpoint.name));
    const auto all = [](const Asked&) { return size_t(0); };
    const ScaledFit best = FitAnswers(
        asked, recorded.size(), [](const Asked& one) { return one.place; }, LogSpp);
    scores.best = best.fit.logLikelihood;
    scores.worst = FitAnswers(asked, 1, all, LogSpp).fit.logLikelihood;
    scores.blocks = ThresholdsOfBlocks(asked, recorded, best);
    used.answers = int(asked.size());
    used.blocks = int(std::ranges::count_if(scores.blocks, &AnsweredBlock::answers));
    for (size_t i = 0; i < runs.size(); ++i)
        scores.rules.push_back(ScoreRule(runs[i], i, asked, recorded, scores));
    return scores;
}

}  // namespace lull
