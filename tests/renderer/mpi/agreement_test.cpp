#include "renderer/mpi/job.h"

#include <gtest/gtest.h>

#include <future>

#include "tests/renderer/render/ranks/shared_render.h"

namespace lull {
namespace {

using ranks_test::Mailboxes;
using ranks_test::QueuePeers;

struct Three {
    Mailboxes mail;
    std::vector<QueuePeers> peers;

    Three() {
        mail.boxes.resize(3);
        for (int rank = 0; rank < 3; ++rank) peers.emplace_back(&mail, rank);
    }
    std::future<Agreement> Say(int rank, uint64_t value, bool failed = false, double patience = 600,
                               int round = 1) {
        return std::async(std::launch::async, [=, this] {
            return Agree(&peers[size_t(rank)], round, failed, value, patience);
        });
    }
};

void ExpectEqual(const Agreement& a, const Agreement& b) {
    EXPECT_EQ(a.failed, b.failed);
    EXPECT_EQ(a.different, b.different);
    EXPECT_EQ(a.isLate, b.isLate);
}

TEST(Agreement, TellsAllTheSame) {
    Three ranks;
    int round = 0;
    for (const auto& [values, failed, expected] :
         {std::tuple(std::array{7, 7, 7}, -1, Agreement{}),
          {std::array{7, 7, 8}, -1, Agreement{.different = 2}},
          {std::array{7, 8, 9}, -1, Agreement{.different = 1}},
          {std::array{7, 7, 7}, 2, Agreement{.failed = 2}},
          {std::array{7, 7, 7}, 0, Agreement{.failed = 0}}}) {
        ++round;
        std::vector<std::future<Agreement>> all;
        for (int rank = 0; rank < 3; ++rank)
            all.push_back(
                ranks.Say(rank, uint64_t(values[size_t(rank)]), rank == failed, 600, round));
        for (auto& one : all) ExpectEqual(one.get(), expected);
    }
}

// Such as one that is stopped while it loads the scene. What it says late is no answer to what is
// asked next.
TEST(Agreement, DoesNotWaitForOneThatSaysNothing) {
    Three ranks;
    auto first = ranks.Say(0, 7, false, 0.3), second = ranks.Say(1, 7);
    ExpectEqual(first.get(), {});
    ExpectEqual(second.get(), {});
    ExpectEqual(ranks.Say(2, 7).get(), {.isLate = true});

    auto third = ranks.Say(2, 8, false, 600, 2);
    first = ranks.Say(0, 7, false, 600, 2);
    second = ranks.Say(1, 7, false, 600, 2);
    ExpectEqual(first.get(), {.different = 2});
    ExpectEqual(second.get(), {.different = 2});
    ExpectEqual(third.get(), {.different = 2});
}

TEST(Agreement, TellsTheLateThatTheyFailOrDiffer) {
    for (const auto& [value, failed, expected] :
         {std::tuple(8, false, Agreement{.different = 1, .isLate = true}),
          {7, true, Agreement{.failed = 1, .isLate = true}}}) {
        Three ranks;
        ExpectEqual(ranks.Say(0, 7, false, 0).get(), {});
        ExpectEqual(ranks.Say(1, uint64_t(value), failed).get(), expected);
    }
}

}  // namespace
}  // namespace lull
