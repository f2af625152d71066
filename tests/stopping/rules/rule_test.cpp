#include "stopping/rules/rule_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/base/checksum.h"
#include "stopping/network/model_file.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/scratch_file.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

template <typename Error>
std::string ErrorOf(const std::string& rule, const RuleContext& context = {}) {
    try {
        ParseRule(rule, context);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// Returns the first spp, in passes of 20, at which a block whose noise falls is stopped; 0: none.
int StopSpp(Criterion* criterion, int end = 2000) {
    for (int spp = 20; spp <= end; spp += 20) {
        const BlockImage block = NoisyBlock(40, 40, 0.2, spp, unsigned(spp));
        if (criterion->Observe(block.At(spp)).stop) return spp;
    }
    return 0;
}

TEST(Rule, MakesItsCriterion) {
    const Rule fixed = ParseRule("fixed:100");
    EXPECT_EQ(fixed.text, "fixed:100");
    EXPECT_EQ(fixed.checksum, "");
    EXPECT_EQ(fixed.smallestSide, 0);
    EXPECT_EQ(StopSpp(MakeCriterion(fixed).get()), 100);

    for (const char* rule : {"dammertz:0.05", "cycles:0.05", "luxtile:0.1", "lnoise:1"}) {
        const Rule factory = ParseRule(rule);
        EXPECT_EQ(factory.smallestSide, kSmallestVotingSide);
        EXPECT_GT(StopSpp(MakeCriterion(factory).get()), 20) << rule;
    }
    EXPECT_EQ(ParseRule("dammertz").text, "dammertz:0.02");
    EXPECT_EQ(ParseRule("lnoise").text, "lnoise:0.65");
    // With the area factor a block that is a sixteenth of the image has a quarter of the error.
    const BlockImage block = NoisyBlock(40, 40, 0.2, 20, 1);
    const auto plain = MakeCriterion(ParseRule("dammertz:0.05"), {.areaFraction = 0.0625});
    const auto byArea = MakeCriterion(ParseRule("dammertz:0.05:area"), {.areaFraction = 0.0625});
    EXPECT_NEAR(byArea->Observe(block.At(20)).value, plain->Observe(block.At(20)).value / 4, 1e-12);
}

TEST(Rule, SaysWhatIsWrongWithIt) {
    using Invalid = std::invalid_argument;
    EXPECT_EQ(ErrorOf<Invalid>("fixed:ten"),
              "stopping rule 'fixed:ten': 'ten' is not a number of samples per pixel, at least 1");
    EXPECT_EQ(ErrorOf<Invalid>("cycles:0"),
              "stopping rule 'cycles:0': '0' is not a threshold; a number > 0 is needed");
    for (const char* rule : {"",
                             ":",
                             "fixed",
                             "fixed:",
                             "fixed:0",
                             "fixed:-20",
                             "fixed:20.5",
                             "fixed:99999999999",
                             "fixed:20 ",
                             "dammertz:",
                             "dammertz:-1",
                             "dammertz:nan",
                             "dammertz:inf",
                             "dammertz:1e999",
                             "dammertz:0.1:size",
                             "cycles:0x1",
                             "luxtile:6/256",
                             "luxtile",
                             "lnoise:0",
                             "thresholds",
                             "thresholds:",
                             "Fixed:20",
                             "oracle:1"})
        EXPECT_NE(ErrorOf<Invalid>(rule).find("stopping rule '"), std::string::npos) << rule;
    EXPECT_NE(ErrorOf<Invalid>("oracle:1").find("luxtile:T"), std::string::npos);
}

TEST(Rule, TakesThresholdsFromAFile) {
    const ScratchFile file(".csv", "kitchen;105;40;\ncrown;200;300;\n");
    const Rule factory = ParseRule("thresholds:" + file.path + ":kitchen", {.blockCount = 2});
    EXPECT_EQ(factory.checksum, FileChecksum(file.path));
    EXPECT_EQ(factory.smallestSide, 0);
    EXPECT_EQ(StopSpp(MakeCriterion(factory, {.index = 0}).get()), 120);  // rounded up to a pass
    EXPECT_EQ(StopSpp(MakeCriterion(factory, {.index = 1}).get()), 40);
    EXPECT_THROW(MakeCriterion(factory, {.index = 2}), std::invalid_argument);
    EXPECT_THROW(MakeCriterion(factory, {.index = -1}), std::invalid_argument);

    const auto byScene = ParseRule("thresholds:" + file.path, {.sceneName = "crown"});
    EXPECT_EQ(StopSpp(MakeCriterion(byScene, {.index = 0}).get()), 200);

    using Failed = std::runtime_error;
    const std::string rule = "thresholds:" + file.path;
    EXPECT_NE(ErrorOf<Failed>(rule).find("name one, such as 'kitchen'"), std::string::npos);
    EXPECT_NE(ErrorOf<Failed>(rule + ":dragon").find("no row 'dragon'"), std::string::npos);
    EXPECT_NE(ErrorOf<Failed>(rule + ":crown", {.blockCount = 16}).find("2 blocks"),
              std::string::npos);
    EXPECT_NE(ErrorOf<Failed>("thresholds:/no/such/file.csv"), "");
    const ScratchFile empty(".csv", "\n");
    EXPECT_NE(ErrorOf<Failed>("thresholds:" + empty.path).find("no rows"), std::string::npos);
}

TEST(Rule, TakesTheOnlyRowAndPathsWithColons) {
    const ScratchFile file(":x.csv", "kitchen;60;\n");
    const std::string rule = "thresholds:" + file.path;
    EXPECT_EQ(StopSpp(MakeCriterion(ParseRule(rule, {.sceneName = "other"})).get()), 60);
    EXPECT_EQ(StopSpp(MakeCriterion(ParseRule(rule + ":kitchen")).get()), 60);
}

TEST(Rule, LoadsAModel) {
    const ScratchFile file(".h5");
    Network network = RandomNetwork(25, {4}, 1);
    network.dense[0].kernel.setZero();
    network.dense[0].bias[0] = -3;  // always noiseless
    WriteModel(file.path, network, {.k = 3, .n = 20, .m = 25});
    const Rule factory = ParseRule("learned:" + file.path);
    EXPECT_EQ(factory.checksum, FileChecksum(file.path));
    EXPECT_EQ(factory.smallestSide, kSmallestVotingSide);
    EXPECT_EQ(StopSpp(MakeCriterion(factory).get()), 100);
    EXPECT_EQ(StopSpp(MakeCriterion(ParseRule("learned:" + file.path)).get()), 100);
    using Failed = std::runtime_error;
    EXPECT_NE(ErrorOf<Failed>("learned:" + file.path, {.passSpp = 16}).find("16 spp"),
              std::string::npos);
    EXPECT_NE(ErrorOf<Failed>("learned:/no/such/model.h5"), "");
    EXPECT_NE(ErrorOf<Failed>("learned").find("learned:MODEL.h5"), std::string::npos);
}

TEST(Rule, FindsInstalledModelsByName) {
    const ScratchFile file(".h5");
    WriteModel(file.path, RandomNetwork(25, {4}, 1), {.k = 3, .n = 20, .m = 25});
    const std::filesystem::path path(file.path);
    const RuleContext context{.models = path.parent_path().string()};
    const Rule factory = ParseRule("learned:" + path.stem().string(), context);
    EXPECT_EQ(factory.checksum, FileChecksum(file.path));
    EXPECT_EQ(factory.text, "learned:" + path.stem().string());
    const std::string error = ErrorOf<std::runtime_error>("learned:none_such", context);
    EXPECT_NE(error.find("no model 'none_such'"), std::string::npos) << error;
    EXPECT_NE(error.find(path.stem().string()), std::string::npos) << error;
}

TEST(Rule, DividesThresholdsOfVisibleNoiseByCaution) {
    const BlockImage block(100, 100, 0.18f);
    const RuleContext careful{.caution = 2};
    for (const char* rule : {"lnoise:0.5", "entropy:0.5"}) {
        const Rule factory = ParseRule(rule, careful);
        EXPECT_EQ(factory.text, std::string(rule) + ", caution 2");
        EXPECT_EQ(MakeCriterion(factory)->Observe(block.At(20)).threshold, 0.25);
    }
    for (const char* rule : {"dammertz:0.02", "cycles:0.02", "luxtile:0.1", "fixed:20"}) {
        const std::string error = ErrorOf<std::invalid_argument>(rule, careful);
        EXPECT_NE(error.find("caution"), std::string::npos) << rule << ": " << error;
    }
    const ScratchFile entropies(".h5"), noise(".h5");
    WriteModel(entropies.path, RandomNetwork(25, {4}, 1), {.k = 3, .n = 20, .m = 25});
    EXPECT_NE(ErrorOf<std::runtime_error>("learned:" + entropies.path, careful).find("caution"),
              std::string::npos);
    WriteModel(noise.path, RandomNetwork(100, {4}, 1),
               {.k = 3, .n = 20, .features = {Feature::VisibleDrop}});
    EXPECT_EQ(ParseRule("learned:" + noise.path, careful).checksum, FileChecksum(noise.path));
}

TEST(Rule, GoesOnFromSavedState) {
    const ScratchFile thresholds(".csv", "kitchen;500;\n");
    for (const std::string& rule :
         {std::string("fixed:500"), std::string("dammertz:0.02"), std::string("cycles:0.02"),
          std::string("luxtile:0.1"), std::string("lnoise:2"), std::string("entropy:1"),
          "thresholds:" + thresholds.path}) {
        const Rule factory = ParseRule(rule);
        auto criterion = MakeCriterion(factory);
        for (int spp = 20; spp <= 400; spp += 20) {
            const BlockImage block = NoisyBlock(40, 40, 0.2, spp, unsigned(spp));
            const auto copy = MakeCriterion(factory);
            copy->Restore(criterion->Save());
            const Decision a = criterion->Observe(block.At(spp)), b = copy->Observe(block.At(spp));
            EXPECT_EQ(a.stop, b.stop) << rule;
            EXPECT_EQ(a.checked, b.checked) << rule;
            EXPECT_EQ(a.value, b.value) << rule;
            EXPECT_EQ(a.threshold, b.threshold) << rule;
            EXPECT_EQ(copy->Save(), criterion->Save()) << rule;
        }
    }
}

TEST(Rule, RefusesTheStateOfAnother) {
    const auto cycles = MakeCriterion(ParseRule("cycles:0.01"));
    const BlockImage block = NoisyBlock(40, 40, 0.2, 80, 1);
    cycles->Observe(block.At(80));
    const std::vector<std::byte> state = cycles->Save();
    EXPECT_THROW(MakeCriterion(ParseRule("fixed:20"))->Restore(state), std::runtime_error);
    EXPECT_THROW(MakeCriterion(ParseRule("cycles:0.01"))->Restore({}), std::runtime_error);
    // A state cut short has too few pixels for the block.
    const auto cut = MakeCriterion(ParseRule("cycles:0.01"));
    cut->Restore(std::span(state).first(state.size() - 1));
    EXPECT_THROW(cut->Observe(block.At(100)), std::invalid_argument);
}

}  // namespace
}  // namespace lull
