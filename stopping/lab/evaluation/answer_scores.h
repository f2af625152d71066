// Judges rules by single answers of people to one viewpoint.
//
// The probability that noise is seen is a probit in the logarithm of the rule's number (of its odds
// if the number is a probability), with a location and a slope for the viewpoint. Between how well
// one threshold for all blocks explains the answers, and how well one for each block does, both
// probits in the logarithm of the spp with one scatter, a rule explains some share. The answers of
// an adjustment (SingleAnswer::track), one observer's way to one threshold, do not depend on chance
// each by itself: they count as one answer together.
#pragma once

#include <istream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/recording.h"
#include "stopping/rules/rule.h"

namespace lull {

// Reads single answers of people: whether they saw noise in a block at some spp.

struct SingleAnswer {
    int block = 0;  // row-major number
    int spp = 0;    // > 0, of the picture that was shown
    bool seen = false;
    int line = 0;               // of the file that it was read from
    std::string observer = {};  // who gave it; may be empty
    // The number of the adjustment that it is a step of; 0: it was asked by itself.
    int track = 0;
};

// Reads a CSV of one viewpoint with the line of names "block,spp,noise_seen", after which there can
// be ",observer,track", and an answer, 0 or 1, in each other line; empty lines are skipped. Throws
// std::runtime_error, beginning with "file:line: " where a line is at fault, also for no answer.
std::vector<SingleAnswer> ReadSingleAnswers(const std::string& path);
std::vector<SingleAnswer> ReadSingleAnswers(std::istream& in, const std::string& fileName);

// Throws std::runtime_error, "file:line: ...", for an answer to no block of `blockCount`.
void CheckBlocks(std::span<const SingleAnswer> answers, int blockCount,
                 const std::string& fileName);

struct AnswersUsed {
    int answers = 0, blocks = 0;              // that count
    int tracks = 0;                           // adjustments, the answers in which count as one
    int all = 0, allBlocks = 0;               // of the file
    int notRecorded = 0;                      // answers to blocks without a recording
    int withoutNumber = 0;                    // where a rule has no number (yet, or any more)
    std::vector<int> blocksNotRecorded = {};  // that were answered
};

// The answers to a block, and where noise is seen in it with a probability of 1/2.
struct AnsweredBlock {
    int block = 0, answers = 0, seen = 0;
    std::optional<double> threshold = {};  // spp; nothing where all answers are the same
};

struct RuleByAnswers {
    std::string rule;
    double logLikelihood = 0, slope = 0;   // slope: above 0 where larger numbers are seen
    std::optional<double> explained = {};  // (own - worst) / (best - worst); can be below 0
    double auc = 0.5;                      // of the number
    // Over the blocks with thresholds: shares of stops below 80 % and above 125 % of them, and the
    // geometric mean of stop / threshold. Nothing without such blocks.
    std::optional<double> early = {}, late = {}, level = {};
    std::vector<int> stops = {};  // spp in each of the blocks
    int open = 0;                 // stops beyond recordings, which were extended (extension.h)
};

struct AnswerScores {
    std::string viewpoint;
    AnswersUsed used = {};
    double best = 0, worst = 0;  // log likelihoods
    std::vector<AnsweredBlock> blocks = {};
    std::vector<RuleByAnswers> rules = {};
};

// Judges rules, as MakeSimulator() reads them, all by the same answers: to recorded blocks, where
// every rule has a number. That is read off between recorded passes. Throws as MakeSimulator() and
// its simulators do, and std::runtime_error if no answer is left.
AnswerScores EvaluateByAnswers(const ViewpointRecording& viewpoint,
                               std::span<const SingleAnswer> answers,
                               std::span<const std::string> rules, const RuleContext& context);

}  // namespace lull
