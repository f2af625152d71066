#include "stopping/lab/training/search_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/stopping/lab/training/learning_data.h"

namespace lull::search_run_test {
namespace {

void SetOptions(std::span<const OptionValue> values, TrainingPlan* plan) {
    for (const OptionValue& option : values) {
        const double value = std::stod(option.value);
        if (option.name == "k")
            plan->settings.k = int(value);
        else if (option.name == "n")
            plan->settings.n = int(value);
        else if (option.name == "rate")
            plan->training.learningRate = value;
        else
            throw std::invalid_argument("this is no option");
    }
    if (plan->settings.k < 1) throw std::invalid_argument("k must be positive");
}

void Ignore(const std::string&) {}

struct Search {
    LearningData data;
    TrainingPlan plan = data.Plan();
    std::vector<SearchAxis> axes;
    std::vector<Trial> trials;

    explicit Search(const std::string& grid) {
        std::istringstream in(grid);
        axes = ReadGrid(in, "grid");
        plan.crossValidate = true;
        plan.withLast = false;
        trials = MakeTrials(plan, "grid", axes, data.Blocks(), SetOptions, Ignore);
    }
};

// Counts steps, and cancels after some.
struct Watcher {
    int left = 1 << 30, kept = 0;
    std::vector<std::string> said = {};
    double lastShare = 0;

    SearchEvents Events() {
        return {.step =
                    [this](const SearchProgress& progress) {
                        --left;
                        lastShare = progress.Share();
                        EXPECT_GE(lastShare, 0);
                        EXPECT_LE(lastShare, 1);
                    },
                .keep = [this](const std::vector<SearchResult>&) { ++kept; },
                .warn = [this](const std::string& message) { said.push_back(message); },
                .isCancelled = [this] { return left <= 0; }};
    }
};

TEST(Search, MakesAllCombinations) {
    const Search search("k 2 3\nrate 0.01 0.001");
    ASSERT_EQ(search.trials.size(), 4u);
    EXPECT_EQ(search.trials[1].name, "k 2, rate 0.001");
    EXPECT_EQ(search.trials[2].plan.settings.k, 3);
    EXPECT_EQ(search.trials[2].plan.training.learningRate, 0.01);
    EXPECT_EQ(search.trials[3].splits.size(), 2u);
    // What the axes do not change tells searches apart.
    TrainingPlan other = search.plan;
    other.training.epochs = 4;
    EXPECT_NE(SearchDataText(other, search.trials[0]),
              SearchDataText(search.plan, search.trials[0]));
}

TEST(Search, RefusesWhatCannotBeTrained) {
    const LearningData data;
    const auto errorOf = [&](const std::string& grid) -> std::string {
        std::istringstream in(grid);
        const std::vector<SearchAxis> axes = ReadGrid(in, "grid");
        try {
            CheckGrid(data.Plan(), "grid", axes, SetOptions);
            MakeTrials(data.Plan(), "grid", axes, data.Blocks(), SetOptions, Ignore);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(errorOf("rate 1\nk 2 0"), "grid:2: k 0: k must be positive");
    EXPECT_EQ(errorOf("speed 1"), "grid:1: speed 1: this is no option");
    EXPECT_TRUE(errorOf("k 2\nn 40 30").starts_with("grid: k 2, n 30: --n and "));
    EXPECT_EQ(errorOf("k 2\nn 40"), "");
}

TEST(Search, TriesEachAndGoesOnWhereItWasCancelled) {
    const Search search("k 2 3\nrate 0.01 0.001");
    TrainingCheckpoint none("", 0, {});
    Watcher whole;
    const SearchOutcome expected = RunTrials(search.trials, {}, &none, whole.Events());
    EXPECT_FALSE(expected.cancelled);
    ASSERT_EQ(expected.results.size(), 4u);
    EXPECT_EQ(whole.kept, 4);
    EXPECT_EQ(whole.lastShare, 1);
    EXPECT_EQ(expected.results[3].values, (std::vector<std::string>{"3", "0.001"}));
    EXPECT_GT(expected.results[0].seconds, 0);

    const int steps = (1 << 30) - whole.left;
    const ScratchFile file(".checkpoint");
    const FileWriter write = [](const std::string& path, std::span<const std::byte> bytes) {
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    };
    TrainingCheckpoint checkpoint(file.path, 1e6, write);
    Watcher first{steps * 5 / 8};
    const SearchOutcome part = RunTrials(search.trials, {}, &checkpoint, first.Events());
    EXPECT_TRUE(part.cancelled);
    EXPECT_EQ(part.results.size(), 2u);
    EXPECT_EQ(first.kept, 3);  // also when it was cancelled
    TrainingCheckpoint again(file.path, 1e6, write);
    again.Read();
    Watcher second;
    const SearchOutcome rest = RunTrials(search.trials, part.results, &again, second.Events());
    EXPECT_EQ((1 << 30) - second.left, steps - steps * 5 / 8);
    ASSERT_EQ(rest.results.size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(rest.results[i].values, expected.results[i].values);
        EXPECT_EQ(rest.results[i].testAuc, expected.results[i].testAuc);
        EXPECT_EQ(rest.results[i].criticalError, expected.results[i].criticalError);
    }
    EXPECT_FALSE(std::filesystem::exists(file.path));
}

TEST(Search, GoesOnAfterATrainingThatDiverges) {
    const Search search("rate 1e38 0.001");
    TrainingCheckpoint none("", 0, {});
    Watcher watcher;
    const SearchOutcome outcome = RunTrials(search.trials, {}, &none, watcher.Events());
    ASSERT_EQ(outcome.results.size(), 2u);
    EXPECT_TRUE(std::isnan(outcome.results[0].testAuc));
    EXPECT_TRUE(std::isfinite(outcome.results[1].testAuc));
    ASSERT_EQ(watcher.said.size(), 1u);
    EXPECT_TRUE(watcher.said[0].starts_with("rate 1e38: the training has diverged"))
        << watcher.said[0];
}

}  // namespace
}  // namespace lull::search_run_test
