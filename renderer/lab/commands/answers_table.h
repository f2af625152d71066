// Prints how rules were judged by single answers.
#pragma once

#include <cstdio>
#include <string>

#include "stopping/lab/evaluation/answer_judgement.h"

namespace lull {

// Prints which answers counted, a table of the rules and, if `each`, one of the blocks before.
void PrintAnswerJudgement(std::FILE* out, const AnswerJudgement& judgement, bool each);

// Returns the table of the rules as a CSV file with a head line. Fields of what is not defined are
// empty.
std::string AnswerJudgementCsv(const AnswerJudgement& judgement);

}  // namespace lull
