// The options of `lull compare`.
#pragma once

#include "renderer/commands/render_settings.h"
#include "renderer/vision/display_model.h"
#include "stopping/rules/rule_table.h"

namespace lull {

struct CompareOptions {
    RenderSettings render;
    std::string rule = kDefaultRule;
    std::string human, automatic, reference;  // empty: none
    std::string output, report;
    DisplayModel display;
    bool snapshots = false, denoise = false;
    std::vector<int> verify;  // numbers of threads
};

void AddCompareOptions(CLI::App& app, CompareOptions* options);

}  // namespace lull
