#include "stopping/rules/thresholds_rule.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "stopping/base/checksum.h"
#include "stopping/base/input_file.h"
#include "stopping/rules/thresholds.h"

namespace lull {

namespace {

// Chooses the row of a thresholds file: the one asked for, else the scene's, else the only one.
const ThresholdsRow& ChooseRow(const std::vector<ThresholdsRow>& rows, const std::string& path,
                               const std::string& name, const std::string& sceneName) {
    auto find = [&](const std::string& wanted) {
        return std::find_if(rows.begin(), rows.end(),
                            [&](const ThresholdsRow& row) { return row.name == wanted; });
    };
    auto row = find(name.empty() ? sceneName : name);
    if (row == rows.end() && name.empty() && rows.size() == 1) row = rows.begin();
    if (row != rows.end()) return *row;
    if (rows.empty()) throw std::runtime_error(path + ": has no rows");
    const std::string example = "such as '" + Printable(rows.front().name) + "'";
    if (!name.empty())
        throw std::runtime_error(path + ": has no row '" + Printable(name) + "', but rows " +
                                 example);
    throw std::runtime_error(path + ": has several rows; name one, " + example);
}

}  // namespace

Rule ReadThresholdsRule(const std::string& argument, const RuleContext& context) {
    if (argument.empty()) throw std::invalid_argument("the name of a thresholds file is missing");
    // Take all of it for the file if there is one of that name: paths may have colons in them.
    std::string path = argument, name;
    const size_t colon = argument.rfind(':');
    if (colon != std::string::npos && !IsThere(path)) {
        path = argument.substr(0, colon);
        name = argument.substr(colon + 1);
    }
    const ThresholdsRow row = ChooseRow(ReadThresholds(path), path, name, context.sceneName);
    if (context.blockCount > 0 && int(row.spp.size()) != context.blockCount)
        throw std::runtime_error(path + ": '" + Printable(row.name) + "' has thresholds for " +
                                 std::to_string(row.spp.size()) + " blocks, the image has " +
                                 std::to_string(context.blockCount));
    Rule rule = CountingRule([row](const BlockInfo& block) {
        if (block.index < 0 || block.index >= int(row.spp.size()))
            throw std::invalid_argument("'" + Printable(row.name) +
                                        "' has no threshold for block " +
                                        std::to_string(block.index));
        return row.spp[size_t(block.index)];
    });
    rule.checksum = FileChecksum(path);
    return rule;
}

}  // namespace lull
