// Prints how rules were judged.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "renderer/lab/pages/comparison_page.h"
#include "stopping/lab/evaluation/answer_scores.h"
#include "stopping/lab/evaluation/evaluation.h"

namespace lull {

// Prints a table of the rules over all viewpoints and, if `each`, one of each rule before.
void PrintEvaluation(std::FILE* out, const std::vector<EvaluatedRule>& rules,
                     const ScoreOptions& options, bool each);

// Returns all rows as a CSV file with a head line: one for each rule and viewpoint, and for each
// rule one with the viewpoint "all". Undefined fields are empty.
std::string EvaluationCsv(const std::vector<EvaluatedRule>& rules, const ScoreOptions& options);

// Returns a CSV file with a head line and one for each rule and block: where people saw no more
// noise and where the rule stopped, in spp, and whether its recording had ended before.
std::string BlocksCsv(const std::vector<EvaluatedRule>& rules);

// Returns a CSV file of all verdicts, with a line of names: rule,viewpoint,block,human,stop,spp,
// value,threshold,noisy. Rules without a number, and spp at which there is none, are left out.
std::string CurvesCsv(const std::vector<EvaluatedRule>& rules);

// Prints how rules were judged by single answers.

// Prints which answers counted, a table of the rules and, if `each`, one of the blocks before.
void PrintAnswerScores(std::FILE* out, const AnswerScores& scores, bool each);

// Returns the table of the rules as CSV with a head line. Undefined fields are empty.
std::string AnswerScoresCsv(const AnswerScores& scores);

// Prints a comparison for people.

// Returns the figures of the images, a line an image, and below them the savings.
std::string ComparisonTable(const ComparisonReport&);

}  // namespace lull
