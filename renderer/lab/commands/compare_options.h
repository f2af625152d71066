// The options of `lull compare`.
#pragma once

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/pages/comparison_page.h"
#include "renderer/vision/visible_difference.h"
#include "stopping/rules/rule_table.h"

namespace lull::compare {

struct CompareOptions {
    RenderSettings render;
    std::string rule = kDefaultRule;
    std::string images;                       // DIR[:NAME] of pictures; empty: none
    std::string human, automatic, reference;  // empty: none
    std::string output, report;
    DisplayModel display;
    bool snapshots = false, denoise = false, curves = false;
    std::vector<int> verify;  // numbers of threads
};

void AddCompareOptions(CLI::App& app, CompareOptions* options);

// Compares images that are made of another renderer's pictures. Throws Error and UsageError.
ExitCode CompareFolder(CompareOptions options);

// Writes figures and page next to the images, and prints the table and the names of all files.
// Throws Error where an image is missing.
void WriteComparison(const CompareOptions& options, ComparisonReport report, ResultFiles results);

}  // namespace lull::compare
