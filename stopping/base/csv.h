// Writes tables of comma-separated values.
#pragma once

#include <string>

namespace lull {

// Returns a text as a field: in quotation marks where a comma, a quotation mark or the end of a
// line would break the line.
inline std::string CsvField(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

}  // namespace lull
