// Reads text line by line, as the editors of all systems write it.
#pragma once

#include <iosfwd>
#include <string>

namespace lull {

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

}  // namespace lull
