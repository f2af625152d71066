#include "renderer/commands/grading.h"

#include "renderer/render/graded_criterion.h"

namespace lull {

std::vector<Grading> GradingsOf(const std::vector<Grade>& grades) {
    std::vector<Grading> gradings;
    for (const Grade& grade : grades)
        gradings.push_back(grade.IsPlain() ? Grading() : [grade](std::span<float> rgb) {
            ApplyGrade(grade, rgb);
        });
    return gradings;
}

std::string NamesOf(const std::vector<Grade>& grades) {
    std::string text;
    for (const Grade& grade : grades) {
        const std::string own = TextOf(grade);
        text += (text.empty() ? "" : "; ") + (own.empty() ? "sRGB" : own);
    }
    return text;
}

CriterionMaker MakeGradedCriteria(const Rule& rule, const std::vector<Grade>& grades) {
    CriterionMaker criteriaOf = CriteriaOf(rule);
    if (grades.empty() || rule.stopAt || rule.need == ViewNeed::Measured) return criteriaOf;
    return [criteriaOf, grades](const BlockInfo& info) {
        std::vector<GradedJudge> judges;
        for (const Grade& grade : grades) judges.push_back({grade, criteriaOf(info)});
        return std::make_unique<GradedCriterion>(std::move(judges));
    };
}

}  // namespace lull
