// Reports what is wrong with a scene and where: locations, errors, counted warnings.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

namespace lull {

// Names a place in an input file. A default-constructed location names none.
struct FileLoc {
    std::shared_ptr<const std::string> file;
    int line = 0;

    // Formats "file:line: ", "file: " or "" for use in front of a message.
    std::string Prefix() const;
};

// Returns the text as one line that a terminal prints as it is: "; " stands between lines, and \xNN
// for other control characters.
std::string OneLine(const std::string& text);

// Signals that the input or the environment is at fault; what() is the one message a user sees,
// beginning with the location where one is known. main() turns it into exit code 1.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& message) : std::runtime_error(message) {}
    Error(const FileLoc& loc, const std::string& message)
        : std::runtime_error(loc.Prefix() + message) {}
};

// Collects warnings: the first of each kind is passed on at once, all are counted. Thread-safe.
class Warnings {
  public:
    using Sink = std::function<void(const std::string&)>;

    // Passes on complete messages without a trailing newline; no sink keeps them silent.
    explicit Warnings(Sink sink = {}) : sink(std::move(sink)) {}

    // Counts a warning of `kind` (a phrase that all alike share, such as "zero-area triangle");
    // `detail` describes this one and is shown for the first of its kind only.
    void Add(const FileLoc& loc, const std::string& kind, const std::string& detail = "");

    // Returns how often each kind occurred.
    std::map<std::string, int> Counts() const;
    int Total() const;

    // Passes on "... (N times in all)" for every kind seen more than once.
    void Summarize() const;

  private:
    Sink sink;
    mutable std::mutex mutex;
    std::map<std::string, int> counts;
};

}  // namespace lull
