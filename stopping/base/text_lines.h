// Reads text line by line, as the editors of all systems write it.
#pragma once

#include <iosfwd>
#include <string>

namespace lull {

// Lines end with LF, CR LF or CR. A byte-order mark of UTF-8 before the first is left out, and all
// from Control-Z or NUL on, by which old programs end a text.
class TextLines {
  public:
    // Reads all of the stream. Throws std::runtime_error for UTF-16, "NAME: REASON".
    TextLines(std::istream&, const std::string& name);

    // Moves to the next line; returns false after the last.
    bool Next();
    const std::string& Line() const { return line; }
    int Number() const { return number; }  // of the line, from 1

  private:
    std::string text, line;
    size_t next = 0;
    int number = 0;
};

}  // namespace lull
