// Prints how rules were judged by single answers.
#pragma once

#include <cstdio>
#include <string>

#include "stopping/lab/evaluation/answer_scores.h"

namespace lull {

// Prints which answers counted, a table of the rules and, if `each`, one of the blocks before.
void PrintAnswerScores(std::FILE* out, const AnswerScores& scores, bool each);

// Returns the table of the rules as a CSV file with a head line. Undefined fields are
// empty.
std::string AnswerScoresCsv(const AnswerScores& scores);

}  // namespace lull
