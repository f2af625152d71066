#include "stopping/rules/thresholds.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "stopping/base/input_file.h"

namespace lull {

using namespace std::string_view_literals;

namespace {

std::vector<std::string> Split(const std::string& line) {
    std::vector<std::string> fields;
    for (size_t begin = 0; begin <= line.size();) {
        const size_t end = std::min(line.find(';', begin), line.size());
        fields.push_back(line.substr(begin, end - begin));
        begin = end + 1;
    }
    if (fields.back().empty()) fields.pop_back();
    return fields;
}

ThresholdsRow ParseRow(const std::string& line) {
    const std::vector<std::string> fields = Split(line);
    if (fields.empty() || fields[0].empty())
        throw std::invalid_argument("the name of the viewpoint is missing");
    // As where files were put together; written first in a file, it would be taken for its own.
    for (const std::string_view mark : {kByteOrderMark, "\xff\xfe"sv, "\xfe\xff"sv})
        if (fields[0].starts_with(mark))
            throw std::invalid_argument("the name begins with a byte order mark; remove it");
    ThresholdsRow row{fields[0], {}};
    for (size_t i = 1; i < fields.size(); ++i) {
        const char *begin = fields[i].data(), *end = begin + fields[i].size();
        int spp = 0;
        const auto [rest, error] = std::from_chars(begin, end, spp);
        if (error != std::errc() || rest != end || spp < 0)
            throw std::invalid_argument(
                "'" + Printable(fields[i]) +
                "' is not a threshold; a whole number of samples is needed");
        row.spp.push_back(spp);
    }
    if (row.spp.empty())
        throw std::invalid_argument("'" + Printable(row.name) +
                                    "' has no thresholds; 'name;t0;t1;...;' is needed");
    return row;
}

}  // namespace

std::vector<ThresholdsRow> ReadThresholds(std::istream& in, const std::string& fileName) {
    std::vector<ThresholdsRow> rows;
    std::set<std::string> names;
    for (TextLines lines(in, fileName); lines.Next();) {
        if (lines.Line().empty()) continue;
        try {
            rows.push_back(ParseRow(lines.Line()));
            if (!names.insert(rows.back().name).second)
                throw std::invalid_argument("'" + Printable(rows.back().name) +
                                            "' has a row already");
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(fileName + ":" + std::to_string(lines.Number()) + ": " +
                                     error.what());
        }
    }
    return rows;
}

std::vector<ThresholdsRow> ReadThresholds(const std::string& path) {
    std::ifstream file = OpenInput(path);
    return ReadThresholds(file, path);
}

void WriteThresholds(std::ostream& out, const std::vector<ThresholdsRow>& rows) {
    for (const ThresholdsRow& row : rows) {
        if (row.name.empty() || row.name.find_first_of(";\r\n") != std::string::npos)
            throw std::invalid_argument("'" + row.name + "' cannot be a name in a thresholds file");
        if (row.spp.empty() || *std::min_element(row.spp.begin(), row.spp.end()) < 0)
            throw std::invalid_argument("'" + row.name + "' needs thresholds, none below 0");
        out << row.name << ';';
        for (int spp : row.spp) out << spp << ';';
        out << '\n';
    }
}

void WriteThresholds(const std::string& path, const std::vector<ThresholdsRow>& rows) {
    std::ofstream file(path);
    WriteThresholds(file, rows);
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
}

namespace {

bool IsSmall(const BlockRect& block, int smallestSide) {
    return std::min(block.width, block.height) < smallestSide;
}

int LargestNeighbour(const BlockGrid& grid, int block) {
    const int rows = int(grid.blocks.size()) / grid.columns;
    const int x = block % grid.columns, y = block / grid.columns;
    int best = -1;
    int64_t bestArea = 0;
    for (int v = std::max(0, y - 1); v <= std::min(rows - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(grid.columns - 1, x + 1); ++u) {
            const int i = v * grid.columns + u;
            const BlockRect& other = grid.blocks[size_t(i)];
            const int64_t area = int64_t(other.width) * other.height;
            if (i == block || area <= bestArea) continue;
            best = i;
            bestArea = area;
        }
    return best;
}

int LeaderOf(const BlockGrid& grid, int block, int smallestSide) {
    if (!IsSmall(grid.blocks[size_t(block)], smallestSide)) return block;
    const int leader = LargestNeighbour(grid, block);
    return leader >= 0 && IsSmall(grid.blocks[size_t(leader)], smallestSide) ? -1 : leader;
}

}  // namespace

BlockGrid CutIntoBlocks(int width, int height, int side, int smallestSide) {
    BlockGrid grid{.columns = (width + side - 1) / side};
    for (int y = 0; y < height; y += side)
        for (int x = 0; x < width; x += side)
            grid.blocks.push_back({x, y, std::min(side, width - x), std::min(side, height - y)});
    for (int i = 0; i < int(grid.blocks.size()); ++i)
        grid.leaders.push_back(LeaderOf(grid, i, smallestSide));
    return grid;
}

namespace {

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
