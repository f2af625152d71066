#include "stopping/rules/rule_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/base/input_file.h"
#include "stopping/network/model_file.h"
#include "tests/stopping/cut_states.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/scratch_file.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

const RuleContext kInstalled = {
    .models = LULL_SOURCE_DIR "/stopping/models",
    .measures = {{"denoised", [](const BlockView&, const BlockInfo&) { return Signals{}; }}}};

template <typename Error>
std::string ErrorOf(const std::string& rule, const RuleContext& context = {}) {
    return WhatOf<Error>([&] { ParseRule(rule, context); });
}

TEST(RuleTable, IsWhatRulesDo) {
    for (const RuleEntry& rule : RuleTable()) {
        if (rule.name == "thresholds") continue;  // reads a file
        const bool isComplete = rule.standard || rule.argument.starts_with('[');
        const std::string text = std::string(rule.name) + (isComplete ? "" : ":1");
        const Rule read = ParseRule(text, kInstalled);
        EXPECT_EQ(read.trend.kind, rule.compares) << text;
        EXPECT_EQ(read.trend.votes, std::max(1, read.votes)) << text;
        RuleContext careful = kInstalled;
        careful.caution = 2;
        EXPECT_EQ(ErrorOf<std::invalid_argument>(text, careful).empty(), rule.takesCaution) << text;
        EXPECT_EQ(read.votes == 3, rule.stops.find("three consecutive checks") != rule.stops.npos);
    }
}

TEST(RuleTable, ReadsTextsOfRules) {
    EXPECT_EQ(FindRule("lnoise")->name, "lnoise");
    EXPECT_EQ(FindRule("thresholds:a:b")->name, "thresholds");
    EXPECT_EQ(FindRule("oracle:1"), nullptr);
    EXPECT_EQ(FindRule(""), nullptr);
    EXPECT_EQ(ArgumentOf("lnoise"), "0.65");
    EXPECT_EQ(ArgumentOf("lnoise:2"), "2");
    EXPECT_EQ(ArgumentOf("lnoise:"), "");
    EXPECT_EQ(ArgumentOf("thresholds:a:b"), "a:b");
    EXPECT_EQ(ArgumentOf("luxtile"), "");
    EXPECT_EQ(WhenItStops(*FindRule("dammertz")),
              "when its mean error in square-root brightness is below T (0.02)");
    EXPECT_EQ(RuleNames([](const RuleEntry& rule) { return rule.compares == RuleTrend::Samples; }),
              "thresholds and fixed");
}

TEST(RuleTable, HelpFitsItsWidth) {
    for (const size_t width : {80u, 100u}) {
        const std::string help = RuleHelp(width);
        for (const RuleEntry& rule : RuleTable())
            EXPECT_HAS(("\n" + help),
                       "\n  " + std::string(rule.name) + std::string(rule.argument) + "  ")
                << help;
        for (size_t begin = 0; begin < help.size(); begin = help.find('\n', begin) + 1)
            EXPECT_LE(help.find('\n', begin) - begin, width) << help;
    }
}

// Returns the lines of the documents that begin as the table of rules does for this one.
std::vector<std::string> DocumentedLines(const RuleEntry& rule) {
    std::vector<std::filesystem::path> documents = {LULL_SOURCE_DIR "/README.md"};
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(LULL_SOURCE_DIR "/stopping"))
        if (entry.path().extension() == ".md") documents.push_back(entry.path());
    // Not all of its argument: a line between two forms would end a cell.
    const std::string begin = "| `" + std::string(rule.name) + rule.argument.front();
    std::vector<std::string> lines;
    for (const auto& path : documents) {
        std::ifstream file(path);
        for (std::string line; std::getline(file, line);)
            if (line.starts_with(begin)) lines.push_back(line);
    }
    return lines;
}

TEST(RuleTable, IsThatOfTheDocuments) {
    for (const RuleEntry& rule : RuleTable()) {
        const std::vector<std::string> lines = DocumentedLines(rule);
        ASSERT_EQ(lines.size(), 1u) << rule.name;
        // Documents may add to it, and name references.
        const std::string line = std::regex_replace(lines[0], std::regex(R"( \[\d+\])"), "");
        EXPECT_HAS(line, "| " + WhenItStops(rule)) << line << "\nshould say\n" << WhenItStops(rule);
    }
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
    const std::pair<const char*, std::vector<const char*>> wrong[] = {
        {"fixed", {"", ":", ":0", ":-20", ":20.5", ":99999999999", ":20 "}},
        {"dammertz", {":", ":-1", ":nan", ":inf", ":1e999", ":0.1:size"}},
        {"luxtile", {"", ":6/256"}},
        {"thresholds", {"", ":"}},
        {"", {"", ":", "cycles:0x1", "lnoise:0", "Fixed:20", "oracle:1"}}};
    for (const auto& [name, arguments] : wrong)
        for (const std::string argument : arguments)
            EXPECT_HAS(ErrorOf<Invalid>(name + argument), "stopping rule '") << name << argument;
    EXPECT_HAS(ErrorOf<Invalid>("oracle:1"), "luxtile:T");
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
    EXPECT_HAS(ErrorOf<Failed>(rule), "name one, such as 'kitchen'");
    EXPECT_HAS(ErrorOf<Failed>(rule + ":dragon"), "no row 'dragon'");
    EXPECT_HAS(ErrorOf<Failed>(rule + ":crown", {.blockCount = 16}), "2 blocks");
    EXPECT_NE(ErrorOf<Failed>("thresholds:/no/such/file.csv"), "");
    const ScratchFile empty(".csv", "\n");
    EXPECT_HAS(ErrorOf<Failed>("thresholds:" + empty.path), "no rows");
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
    EXPECT_HAS(ErrorOf<Failed>("learned:" + file.path, {.passSpp = 16}), "16 spp");
    EXPECT_NE(ErrorOf<Failed>("learned:/no/such/model.h5"), "");
    EXPECT_HAS(ErrorOf<Failed>("learned"), "learned:MODEL.h5");
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
    EXPECT_HAS(error, "no model 'none_such'");
    EXPECT_HAS(error, path.stem().string());
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
        EXPECT_HAS(error, "caution") << rule << ": " << error;
    }
    const ScratchFile entropies(".h5"), noise(".h5");
    WriteModel(entropies.path, RandomNetwork(25, {4}, 1), {.k = 3, .n = 20, .m = 25});
    EXPECT_HAS(ErrorOf<std::runtime_error>("learned:" + entropies.path, careful), "caution");
    WriteModel(noise.path, RandomNetwork(100, {4}, 1),
               {.k = 3, .n = 20, .features = {Feature::VisibleDrop}});
    EXPECT_EQ(ParseRule("learned:" + noise.path, careful).checksum, FileChecksum(noise.path));
}

// All rules continue from their states after any pass, and refuse damaged and foreign ones.
TEST(Rule, GoesOnFromSavedState) {
    const RuleContext context{.measures = {{"denoised", [](const BlockView& v, const BlockInfo&) {
                                                return Signals(100.0 / v.spp);
                                            }}}};
    const ScratchFile thresholds(".csv", "kitchen;500;\n");
    const ScratchFile models[] = {ScratchFile(".h5"), ScratchFile(".h5"), ScratchFile(".h5"),
                                  ScratchFile(".h5")};
    std::vector<std::string> texts = {
        "fixed:500", "dammertz:0.02", "cycles:0.02",  "luxtile:0.1",
        "lnoise:2",  "entropy:1",     "denoised:0.5", "thresholds:" + thresholds.path};
    for (int i = 0; i < 3; ++i)
        WriteModel(models[i].path, RandomNetwork(25, {8, 4}, 3),
                   {.k = 4, .m = 25, .votes = 1000, .voteSpacing = 40 * i});
    WriteModel(models[3].path, RandomNetwork(1, {8, 4}, 3),
               {.k = 3,
                .features = {Feature::VisibleDrop},
                .takesMean = true,
                .votes = 1000,
                .voteSpacing = 40,
                .spacing = Spacing::Geometric,
                .ratio = 1.5});
    for (const ScratchFile& model : models) texts.push_back("learned:" + model.path);
    std::vector<Rule> rules;
    std::vector<std::vector<std::byte>> states;
    for (const std::string& text : texts) {
        SCOPED_TRACE(text);
        const Rule rule = rules.emplace_back(ParseRule(text, context));
        const auto criterion = MakeCriterion(rule);
        auto interrupted = MakeCriterion(rule);
        bool isChecked = false;
        for (int spp = 20; spp <= 400; spp += 20) {
            const BlockImage block = NoisyBlock(40, 40, 0.2, spp, unsigned(spp));
            const std::vector<std::byte> saved = interrupted->Save();
            interrupted = MakeCriterion(rule);
            interrupted->Restore(saved);
            EXPECT_EQ(interrupted->Save(), saved);
            const Decision a = criterion->Observe(block.At(spp)),
                           b = interrupted->Observe(block.At(spp));
            EXPECT_EQ(a.stop, b.stop);
            EXPECT_EQ(a.checked, b.checked);
            EXPECT_EQ(a.value, b.value);
            EXPECT_EQ(a.threshold, b.threshold);
            EXPECT_EQ(a.votes, b.votes);
            isChecked |= a.checked;
        }
        EXPECT_TRUE(isChecked);
        std::vector<std::byte> state = states.emplace_back(criterion->Save());
        if (state.empty()) continue;
        const auto restore = [&](std::span<const std::byte> s) { MakeCriterion(rule)->Restore(s); };
        if (text.starts_with("cycles")) {
            // A state cut short has too few pixels for the block.
            const auto cut = MakeCriterion(rule);
            cut->Restore(std::span(state).first(state.size() - 1));
            EXPECT_THROW(cut->Observe(BlockImage(40, 40, 1).At(420)), std::invalid_argument);
        } else {
            ExpectRefusesCut(state, 7, restore);
            state.push_back({});
            EXPECT_THROW(restore(state), std::runtime_error);
            state.pop_back();
        }
        state[27] = std::byte(0xff);  // a negative count of votes
        EXPECT_THROW(restore(state), std::runtime_error);
    }
    const auto kindOf = [](const Rule& rule) {
        return std::pair(rule.tag, rule.inputs ? InputCount(*rule.inputs) : 0);
    };
    for (const Rule& rule : rules)
        for (size_t i = 0; i < rules.size(); ++i)
            if (kindOf(rule) != kindOf(rules[i])) {
                EXPECT_THROW(MakeCriterion(rule)->Restore(states[i]), std::runtime_error)
                    << rule.text << " " << rules[i].text;
            }
}

}  // namespace
}  // namespace lull
