// Writes tables of comma-separated values.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace lull {

// Returns whether a spreadsheet would evaluate a text as a formula.
inline bool IsFormula(const std::string& text) {
    if (text.empty() || std::string("=+-@\t\r").find(text[0]) == std::string::npos) return false;
    char* end;
    std::strtod(text.c_str(), &end);
    return *end != 0 || end == text.c_str();
}

// Returns a text as a field: in quotation marks where a comma, a quotation mark or the end of a
// line would break the line, and after an apostrophe where it would be a formula.
inline std::string CsvField(const std::string& text) {
    if (IsFormula(text)) return CsvField('\'' + text);
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

// Returns a number as a field, which is empty where it is not defined.
inline std::string CsvField(const std::optional<double>& number) {
    return number ? fmt::format("{:.6f}", *number) : "";
}

}  // namespace lull
