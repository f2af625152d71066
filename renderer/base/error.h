// Errors of a scene with their locations, and counted warnings.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace lull {

// Names a place in an input file. A default-constructed location names none.
struct FileLoc {
    std::shared_ptr<const std::string> file;
    int line = 0;

    // Formats "file:line: ", "file: " or "" for use in front of a message.
    std::string Prefix() const;
};

// Returns the text as one line that a terminal prints as it is: "; " stands between lines, and \xNN
// for control characters and bytes that are not UTF-8. Above `most` bytes the middle is left out.
std::string OneLine(const std::string& text, size_t most = std::string::npos);

// The most bytes of an error or a warning, which may quote a command of any length.
inline constexpr size_t kLongestMessage = 2000;

// Signals that the input or the environment is at fault; the message is the only one a user sees,
// and begins with the location where one is known. main() turns it into exit code 1.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& message) : std::runtime_error(message) {}
    Error(const FileLoc& loc, const std::string& message)
        : std::runtime_error(loc.Prefix() + message), loc(loc) {}
    template <typename First, typename... Others>
    Error(fmt::format_string<First, Others...> format, First&& first, Others&&... others)
        : Error(fmt::format(format, std::forward<First>(first), std::forward<Others>(others)...)) {}
    template <typename... Args>
    Error(const FileLoc& loc, fmt::format_string<Args...> format, Args&&... args)
        : Error(loc, fmt::format(format, std::forward<Args>(args)...)) {}

    const FileLoc& Loc() const { return loc; }
    // Returns the message without its place.
    std::string Problem() const { return what() + loc.Prefix().size(); }

  private:
    FileLoc loc;
};

// Several errors of one scene; the message has one a line.
class Errors : public Error {
  public:
    using Error::Error;
};

// Collects the messages on a scene: warnings, and errors after which the rest of the scene can
// still be checked. Of each kind of warning the first is passed on at once, and all are counted. Of
// kinds that differ only in quoted names kMostAlike at most are passed on. Thread-safe.
class Warnings {
  public:
    using Sink = std::function<void(const std::string&)>;
    static constexpr int kMostAlike = 10;
    static constexpr size_t kMostErrors = 10;

    // Passes on complete messages without a trailing newline; no sink keeps them silent.
    // `substitutes`: see Substitute(); `isVerbose`: see AddMinor().
    explicit Warnings(Sink sink = {}, bool substitutes = false, bool isVerbose = false)
        : sink(std::move(sink)), substitutes(substitutes), isVerbose(isVerbose) {}

    // Counts a warning of `kind` (a phrase that all alike share, such as "zero-area triangle");
    // `detail` describes this one and is shown for the first of its kind only.
    void Add(const FileLoc& loc, const std::string& kind, const std::string& detail = "");

    // Counts a warning without effect on the image; it is passed on only with `isVerbose`.
    void AddMinor(const FileLoc& loc, const std::string& kind);

    // Reports something that a scene asks for and cannot have, such as a missing file. The caller
    // continues with a substitute, which `substitute` names: "a matte material stands in". With
    // `substitutes` this is a warning, otherwise an error as AddError() keeps it.
    void Substitute(const FileLoc& loc, const std::string& problem, const std::string& substitute);
    void Substitute(const Error& error, const std::string& substitute) {
        Substitute(error.Loc(), error.Problem(), substitute);
    }
    bool Substitutes() const { return substitutes; }

    // Keeps an error for ThrowErrors().
    void AddError(const Error&);
    // Calls work(). Keeps the Error that it throws, and returns whether there was none.
    template <typename Work>
    bool Try(const Work& work) {
        try {
            work();
        } catch (const Error& error) {
            AddError(error);
            return false;
        }
        return true;
    }
    // Throws the error that was kept, or Errors: the first kMostErrors, and how many more there
    // are; they are kept no longer. Does nothing where there is none.
    void ThrowErrors();

    std::map<std::string, int> Counts() const;
    int Total() const;

    // Passes on "... (N times in all)" for every kind that was passed on and seen more than once,
    // and how many of those alike were not.
    void Summarize() const;

  private:
    struct Count {
        int count = 0;
        bool isShown = false;
    };

    void Add(const FileLoc& loc, const std::string& kind, const std::string& detail,
             bool isPassedOn);

    Sink sink;
    bool substitutes, isVerbose;
    mutable std::mutex mutex;
    std::map<std::string, Count> counts;
    std::map<std::string, int> alike;  // counts by kind of message
    std::vector<Error> errors;         // the first
    size_t moreErrors = 0;
};

// Prints messages to stderr: progress, warnings, summaries.

// Prints to the stream. Where that cannot be written any more, as its terminal is closed or its
// disk is full, nothing is printed, and the work continues.
template <typename... Args>
void PrintTo(std::FILE* stream, fmt::format_string<Args...> format, Args&&... args) {
    try {
        fmt::print(stream, format, std::forward<Args>(args)...);
    } catch (const std::system_error&) {
    }
}

template <typename... Args>
void PrintToStderr(fmt::format_string<Args...> format, Args&&... args) {
    PrintTo(stderr, format, std::forward<Args>(args)...);
}

// Reads text in UTF-8 (RFC 3629), of which not all bytes need be that.

// Returns whether a byte of UTF-8 is not the first of its character.
constexpr bool IsWithinCharacter(char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0) == 0x80;
}

// Returns the bytes, 1 to 4, of the character that a text begins with; 0 if it begins with none.
size_t CharacterBytes(std::string_view text);

// Returns the text with U+FFFD in place of NUL, and of each byte that belongs to no character.
std::string ToUtf8(std::string_view text);

// Returns the text with the letters of ASCII in lower case.
std::string LowerCase(std::string text);

// Returns the beginning of a text in UTF-8, of up to `most` bytes, without part of a character.
std::string BeginningOf(const std::string& text, size_t most);

}  // namespace lull
