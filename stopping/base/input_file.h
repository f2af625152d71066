// Opens the files that a user names, quotes their contents, and finds damaged ones.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lull {

// Returns why a path cannot be read as a file: it is missing, a directory, or special (a FIFO would
// be waited for, and a device may have no end). Empty: it is a regular file.
std::string ReasonNotToRead(const std::string& path);

// Returns whether there is a file, or anything else, at a path. Throws std::runtime_error, "PATH:
// REASON", where that cannot be told: the name is too long, or a folder cannot be searched.
bool IsThere(const std::string& path);

// Opens a regular file for reading bytes. Throws std::runtime_error, "PATH: REASON".
std::ifstream OpenInput(const std::string& path);

// Returns untrusted text for a message: control and non-ASCII bytes as \xNN, and "..." in place of
// all behind the first `most` bytes.
std::string Printable(std::string_view text, size_t most = 60);

// Reads text line by line, as the editors of all systems write it.

// Lines end with LF, CR LF or CR. A byte-order mark of UTF-8 before the first is left out, and
// Control-Z or NUL behind the last, by which old programs mark the end.
class TextLines {
  public:
    // Reads all of the stream. Throws std::runtime_error for UTF-16 and UTF-32, "NAME: REASON".
    TextLines(std::istream&, const std::string& name);

    // Moves to the next line; returns false after the last. Throws std::runtime_error, "NAME:LINE:
    // REASON", for a mark of the end with text behind it.
    bool Next();
    const std::string& Line() const { return line; }
    int Number() const { return number; }  // of the line, from 1

  private:
    std::string name, text, line;
    size_t next = 0;
    int number = 0;
};

// Recognises what editors and old programs put around a text.

// The byte-order mark of UTF-8, which a text may begin with.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// Returns "UTF-16" or "UTF-32" for such text, "" for all else.
std::string_view WideEncoding(std::string_view bytes);

// Old programs mark the end of a text by these: Control-Z and NUL.
inline constexpr std::string_view kEndMarks("\x1a\0", 2);

// Returns the text without them and all behind, if nothing but blanks is there.
std::string_view WithoutEndMarks(std::string_view text);

// Writes tables of comma-separated values.

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

// Identifies files read by rules, for the headers of images, and finds damaged files.

// Returns "crc32:" and the CRC-32 of a file in eight hexadecimal digits: it tells mixed-up files
// apart and is no protection against forgery. Throws std::runtime_error if it cannot be read.
std::string FileChecksum(const std::string& path);

// Returns the seal of the content of a file, to be appended to it: a mark, and the CRC-32 of all
// bytes before it, which any flipped bit changes. HDF5 ignores bytes after the end of its files.
std::string SealOf(std::span<const std::byte> content);
void Seal(std::vector<std::byte>* content);

// Throws std::runtime_error, which does not name the file, if it cannot be read or has changed.
void CheckSeal(const std::string& path);
// Checks the content of a file; returns it without the seal.
std::span<const std::byte> CheckSeal(std::span<const std::byte> content);

}  // namespace lull
