#include "stopping/rules/rule_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace lull {
namespace {

const RuleContext kInstalled = {
    .models = LULL_SOURCE_DIR "/stopping/models",
    .measures = {{"denoised", [](const BlockView&, const BlockInfo&) { return Signals{}; }}}};

// Returns the text of a rule with an argument that it takes; empty for one that reads a file.
std::string Example(const RuleEntry& rule) {
    if (rule.name == "thresholds") return "";
    const std::string name(rule.name);
    return rule.standard || rule.argument.starts_with('[') ? name : name + ":1";
}

TEST(RuleTable, IsWhatRulesDo) {
    for (const RuleEntry& rule : RuleTable()) {
        const std::string text = Example(rule);
        if (text.empty()) continue;
        const Rule read = ParseRule(text, kInstalled);
        EXPECT_EQ(read.trend.kind, rule.compares) << text;
        EXPECT_EQ(read.trend.votes, std::max(1, read.votes)) << text;
        RuleContext careful = kInstalled;
        careful.caution = 2;
        bool refused = false;
        try {
            ParseRule(text, careful);
        } catch (const std::invalid_argument&) {
            refused = true;
        }
        EXPECT_EQ(refused, !rule.takesCaution) << text;
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
            EXPECT_NE(
                ("\n" + help)
                    .find("\n  " + std::string(rule.name) + std::string(rule.argument) + "  "),
                std::string::npos)
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
        EXPECT_NE(line.find("| " + WhenItStops(rule)), std::string::npos)
            << line << "\nshould say\n"
            << WhenItStops(rule);
    }
}

}  // namespace
}  // namespace lull
