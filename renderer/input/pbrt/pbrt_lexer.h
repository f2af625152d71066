// Cuts pbrt's scene files into tokens, following Include.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"

namespace lull {

enum class TokenKind { End, Word, String, Open, Close };

// A token and its place; the text of a String is unquoted and unescaped.
struct Token {
    TokenKind kind = TokenKind::End;
    std::string text;
    FileLoc loc;
};

// Describes a token for a message: "the end of the file", "']'", "'Shape'", "\"matte\"".
std::string Describe(const Token& token);

// Reads tokens from a stack of files: where an included file ends, the including one continues.
// Every function throws Error for invalid tokens.
class PbrtLexer {
  public:
    explicit PbrtLexer(const std::string& file);

    // Continues with `file` and returns at its end. Throws Error at `loc` if it is open already
    // (recursion), cannot be read, or if repeated inclusion has added up to absurd amounts of text.
    void Include(const std::string& file, const FileLoc& loc);
    // Returns how many files are open: one more within each that is included.
    size_t Depth() const { return sources.size(); }
    // Begins again at the start of the first file.
    void Rewind();
    std::vector<std::string> Files() const;

    Token Take();
    const Token& Peek();

    // Take the next token if it is a number and return whether it was; T is float, double or int.
    // An int may be written as a float; *cut is set where that loses a fraction. Throw Error at a
    // malformed number or one beyond the range of T. They never leave the current file.
    bool TakeNumber(float* value);
    bool TakeNumber(double* value);
    bool TakeNumber(int* value, bool* cut);

    // Returns whether a string comes next, alone or as the first in brackets.
    bool NextIsText();

  private:
    struct Source {
        std::shared_ptr<const std::string> name;
        std::string canonical;  // shows whether two names are the same file
        FileContents contents;
        const char *begin = nullptr, *pos = nullptr, *end = nullptr;
        int line = 1;
    };

    FileLoc Loc() const;
    void Open(const std::string& file, const FileLoc& loc);
    bool SkipSpace();  // returns false at the end of the current file
    std::string_view WordAt(const char* pos) const;
    void ReadString(Token* token);
    bool AtNumber();
    template <typename T>
    T ParseNumber();

    std::vector<Source> sources;            // the last is read
    std::map<std::string, int> inclusions;  // of all files, by their canonical names
    size_t repeatedBytes = 0;
    Token peeked;
    bool hasPeeked = false;
};

}  // namespace lull
