// Lists the subcommands. Each adds its options and, if it was given, sets the function to run.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/App.hpp>
#include <CLI/CLI.hpp>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/variant.h"
#include "stopping/base/input_file.h"

namespace lull {

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2, kInterrupted = 130 };

// An invalid command line, whatever the files: kWrongUsage.
class UsageError : public Error {
  public:
    using Error::Error;
};

class MpiJob;

// The groups of options without a subject, and of those that --help shows of a command with many.
inline constexpr const char* kOptions = "Options";
inline constexpr const char* kCommonOptions = "Common options";

// Give the program, before it has commands and options, and a command their help, the same with all
// versions of CLI11. Where a command has common options, --help lists these, and those that no
// other command has; --help-all lists all by subject.
void SetProgramHelp(CLI::App* program);
void SetHelp(CLI::App* command);

// Does the work of a subcommand and returns the exit code. Throws on errors.
using Command = std::function<ExitCode()>;

// Each is in a namespace of its own. Those that several ranks can share get the job.
namespace render {
void AddCommand(CLI::App& app, Command* command, MpiJob* job);
}
namespace record {
void AddCommand(CLI::App& app, Command* command, MpiJob* job);
}
namespace compare {
void AddCommand(CLI::App& app, Command* command, MpiJob* job);
}
namespace info {
void AddCommand(CLI::App& app, Command* command);
}
namespace train {
void AddCommand(CLI::App& app, Command* command);
}
namespace evaluate {
void AddCommand(CLI::App& app, Command* command);
}
namespace entropy {
void AddCommand(CLI::App& app, Command* command);
}
namespace selftest {
void AddCommand(CLI::App& app, Command* command);
}
namespace study {
void AddCommand(CLI::App& app, Command* command);
}
namespace denoise {
void AddCommand(CLI::App& app, Command* command);
}

// Terminal and file output of commands, for modules that know neither.

// Readies the three streams of the program: writing to a pipe without a reader, or more to a file
// than is allowed, is an error and not the end, and a stream that is closed is /dev/null, so that
// no file of results takes its place.
void PrepareStreams();

// Flushes stdout. Throws Error where it, or anything before, could not be.
void FinishResults();
bool HasLostResults();

// Prints a message as a line of its own on stderr, after the program's name.
void PrintMessage(const std::string& message);

// Messages on stderr, separate from the results: as text or, for programs, as JSON
// objects, one a line, of which each has an "event".
struct Messages {
    bool isJson = false;

    void Note(const std::string& message) const;
    void Warn(const std::string& message) const;
    // Prints a message of whoever has put the program's name or a place before it.
    void Print(const std::string& event, const std::string& message) const;
};

// Returns a line of JSON: an event with a text under that key.
std::string JsonEvent(const std::string& event, const std::string& text,
                      const std::string& key = "message");

// WriteFileAtomically(), for those who are to be given a function of this kind.
void WriteBytes(const std::string& path, std::span<const std::byte> bytes);

// Commands and options of earlier versions, each refused by name with what to use instead.

struct Removed {
    // Empty: all commands; no option: the command itself.
    std::string_view command, option, instead;
};

inline constexpr std::array kRemoved = {
    Removed{"", "--filtering", "images are filtered bilinearly; take more samples against moire"},
    Removed{"", "--guide", "use --denoise, or --integrator bdpt for light through glass"},
    Removed{"", "--guide-memory", "use --denoise, or --integrator bdpt for light through glass"},
    Removed{"bench", "", "use lull compare --curves"},
    Removed{"evaluate", "--figure", "draw from the CSV file of --curves"},
    Removed{"selftest", "--long", "tests/hard_cases has the nightly run: LULL_LONG=1"},
    Removed{"selftest", "--only", "the command has three checks"},
    Removed{"selftest", "--seed", "the command has three checks, with one seed"},
    Removed{"study", "--answers", "there is one procedure, adjustment"},
    Removed{"study", "--descending", "blocks are asked from below; --repeats asks twice"},
    Removed{"study", "--list-texts", "edit the texts in the page"},
    Removed{"study", "--procedure", "there is one procedure, adjustment"},
    Removed{"study", "--questions", "ask observers yourself"},
    Removed{"study", "--text", "edit the texts in the page"},
    Removed{"train", "--batch", "batches have 64 samples"},
    Removed{"train", "--bnorm", "inputs are normalised as in the paper"},
    Removed{"train", "--m", "entropies are of 100 sub-blocks"},
    Removed{"train", "--no-snorm", "entropies and attributes26 are normalised over the window"},
    Removed{"train", "--noisy-weight", "use lull render --caution"},
    Removed{"train", "--reference", "observers compared with 10000 spp; use --nearness"},
    Removed{"train", "--snorm", "entropies and attributes26 are normalised over the window"},
    Removed{"train", "--vote-spacing", "rules vote every --n spp"},
    Removed{"train", "--votes", "three consecutive votes stop a block"},
};

// Options whose values are names, or numbers in a range. All options check their numbers by these:
// CLI11's own checks pass NaN, whole numbers beyond their type's range, hexadecimal and octal ones.

// Checks that a value is one of the choices, without a word in the help: the type's name has them.
template <typename Choices>
CLI::Validator OneOf(const Choices& choices) {
    return CLI::IsMember(choices).description("");
}

// Adds an option that sets *value, which must outlive the parsing, to the value of an enum that is
// named (EnumNames). The help shows the previous *value as the default, none of a std::optional.
template <typename T>
CLI::Option* AddChoiceOption(CLI::App& app, const std::string& option, T* value,
                             const std::string& help) {
    using Enum = typename std::conditional_t<std::is_enum_v<T>, std::optional<T>, T>::value_type;
    std::vector<std::string> names;
    for (const auto& [named, name] : EnumNames<Enum>::all) names.push_back(name);
    const auto set = [value](const std::string& name) { *value = *ValueNamed<Enum>(name); };
    auto* added = app.add_option_function<std::string>(option, set, help)
                      ->check(OneOf(names))
                      ->type_name(fmt::format("{}", fmt::join(names, "|")));
    if constexpr (std::is_enum_v<T>) added->default_str(NameOf(*value));
    return added;
}

// Adds an option, for a bool a flag; it sets *value, which must outlive the parsing. The help shows
// the previous *value of numbers as the default, unless the text ends with another in brackets.
template <typename T>
CLI::Option* AddOption(CLI::App& app, const char* group, const std::string& name, T* value,
                       const std::string& help, const std::string& type = "",
                       const CLI::Validator& check = {}) {
    if constexpr (std::is_same_v<T, bool>) return app.add_flag(name, *value, help)->group(group);
    auto* option = app.add_option(name, *value, help)->group(group)->type_name(type)->check(check);
    return std::is_arithmetic_v<T> && !help.ends_with(']') ? option->capture_default_str() : option;
}

// The same of an option that parse(text, value) reads, false where the text "is not " `wanted`.
template <typename T>
CLI::Option* AddOption(CLI::App& app, const char* group, const std::string& name,
                       bool (*parse)(const std::string&, T*), T* value, const std::string& wanted,
                       const std::string& help, const std::string& type) {
    const auto read = [=](const std::string& text) {
        if (!parse(text, value)) throw CLI::ValidationError(name, text + " is not " + wanted);
    };
    return app.add_option_function<std::string>(name, read, help)->group(group)->type_name(type);
}

// Reads numbers with `separator` between them; false if `text` is anything else.
template <typename T, size_t N>
bool ParseNumbers(std::string_view text, char separator, std::array<T, N>* numbers) {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (T& number : *numbers) {
        if (&number != numbers->data() && (at == end || *at++ != separator)) return false;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc()) return false;
        at = next;
    }
    return at == end;
}

// Returns why a text is no number from `least` to `most` in decimal notation, "" if it is one.
// Whole numbers with zeros in front are none: CLI11 reads them as octal ones.
template <typename T>
std::string ProblemOfNumber(std::string_view text, T least, T most) {
    constexpr bool isWhole = std::is_integral_v<T>;
    const std::string quoted = Printable(text);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    T value{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
    const bool isOctal = isWhole && digits.size() > 1 && digits[0] == '0';
    if (error == std::errc::invalid_argument || rest != end || isOctal)
        return fmt::format("'{}' is not a {} such as {}", quoted,
                           isWhole ? "whole number" : "number", isWhole ? "20" : "0.5");
    const bool isWithin = error == std::errc() && value >= least && value <= most;
    return isWithin ? ""
                    : fmt::format("'{}' is not in the range from {} to {}", quoted, least, most);
}

template <typename T>
CLI::Validator Between(T least, T most) {
    return CLI::Validator(
        [=](const std::string& text) { return ProblemOfNumber(text, least, most); },
        CLI::Range(least, most).get_description());
}

// Checks that a value is a finite number above 0.
inline CLI::Validator AboveZero() {
    return Between(std::numeric_limits<double>::min(), std::numeric_limits<double>::max())
        .description("POSITIVE");
}

inline CLI::Validator WholeNumber() {
    return Between<uint64_t>(0, std::numeric_limits<uint64_t>::max()).description("NONNEGATIVE");
}

}  // namespace lull
