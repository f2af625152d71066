// Terminal and file output of commands, for modules that know neither.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lull {

// Readies the three streams of the program: writing to a pipe without a reader, or more to a file
// than is allowed, is an error and not the end, and a stream that is closed is /dev/null, so that
// no file of results takes its place.
void PrepareStreams();

// Flushes stdout. Throws Error where it, or anything before, could not be.
void FinishResults();
// Returns whether something that was printed to stdout is lost.
bool HasLostResults();

// Prints a message as a line of its own on stderr, after the program's name.
void PrintTalk(const std::string& message);

// Messages on stderr, separate from the results: as text or, for programs, as JSON
// objects, one a line, of which each has an "event".
struct Talk {
    bool isJson = false;

    void Note(const std::string& message) const;
    void Warn(const std::string& message) const;
    // Prints a message of whoever has put the program's name or a place before it.
    void Say(const std::string& event, const std::string& message) const;
};

// Returns a line of JSON: an event with a text under that key.
std::string JsonEvent(const std::string& event, const std::string& text,
                      const std::string& key = "message");

// WriteFileAtomically(), for those who are to be given a function of this kind.
void WriteBytes(const std::string& path, std::span<const std::byte> bytes);

}  // namespace lull
