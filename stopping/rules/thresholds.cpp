#include "stopping/rules/thresholds.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>

#include "stopping/base/input_file.h"
#include "stopping/base/text_encoding.h"
#include "stopping/base/text_lines.h"

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

// Parses one line; throws std::invalid_argument with the reason.
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

}  // namespace lull
