// Interrupts rules, and lets others continue from their saved states.
#pragma once

#include <initializer_list>

#include "stopping/rules/rule.h"
#include "tests/stopping/cut_states.h"

namespace lull {

// Checks that criteria that go on after any of `splits` spp decide as one that goes on to `end`.
// run(criterion, begin, end) returns its decisions after `begin` spp, a multiple of 20, up to
// `end`.
template <typename Run>
void ExpectGoesOn(const Rule& rule, std::initializer_list<int> splits, int end, const Run& run) {
    const std::vector<Decision> expected = run(MakeCriterion(rule).get(), 0, end);
    for (const int split : splits) {
        SCOPED_TRACE(split);
        const auto before = MakeCriterion(rule), after = MakeCriterion(rule);
        std::vector<Decision> decisions = run(before.get(), 0, split);
        after->Restore(before->Save());
        EXPECT_EQ(after->Save(), before->Save());
        for (const Decision& decision : run(after.get(), split, end)) decisions.push_back(decision);
        ASSERT_EQ(decisions.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(decisions[i].checked, expected[i].checked) << i;
            EXPECT_EQ(decisions[i].value, expected[i].value) << i;
            EXPECT_EQ(decisions[i].votes, expected[i].votes) << i;
            EXPECT_EQ(decisions[i].stop, expected[i].stop) << i;
        }
    }
}

// Checks that a state is not taken with a part missing, or with more.
inline void ExpectRefusesOtherLengths(const Rule& rule, std::vector<std::byte> state, size_t step) {
    const auto restore = [&](std::span<const std::byte> s) { MakeCriterion(rule)->Restore(s); };
    ExpectRefusesCut(state, step, restore);
    state.push_back({});
    EXPECT_THROW(restore(state), std::runtime_error);
}

}  // namespace lull
