// The command line of lull.
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <numeric>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/mpi/job.h"

namespace lull {

namespace {

constexpr std::array kSharedCommands = {"render", "compare", "record"};

ExitCode Run(MpiJob* job, const Command& command) {
    std::string message;
    ExitCode code = kFailed;
    try {
        const ExitCode done = command();
        FinishResults();
        return done;
    } catch (const OtherRankFailed&) {
        return kFailed;
    } catch (const UsageError& e) {
        message = OneLine(e.what(), kLongestMessage);
        code = kWrongUsage;
    } catch (const Errors& e) {
        message = e.what();
    } catch (const std::bad_alloc&) {
        message = "out of memory; end other programs, or give --crop or a smaller --resolution";
    } catch (const std::system_error& e) {  // of printing, without a file name
        message = HasLostResults() ? "cannot write the results to stdout: " + e.code().message()
                                   : OneLine(e.what(), kLongestMessage);
    } catch (const std::exception& e) {
        message = OneLine(e.what(), kLongestMessage);
    }
    job->Fail(message);
    return code;
}

// Returns how many letters to change, add or leave out until one word is the other (Levenshtein).
size_t Distance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i + 1);
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t change = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string NearestName(const std::string& word, const std::vector<std::string>& names) {
    const auto nearest =
        std::ranges::min_element(names, {}, [&](const auto& name) { return Distance(word, name); });
    const bool isNear = nearest != names.end() &&
                        Distance(word, *nearest) <= std::max<size_t>(1, nearest->size() / 3);
    return isNear ? *nearest : "";
}

// Returns what to use instead of a command or an option that was removed; "" where none was.
std::string ProblemOfRemoved(std::span<const char* const> words) {
    for (const std::string_view word : words.subspan(1))
        for (const Removed& removed : kRemoved)
            if ((removed.command.empty() || words[1] == removed.command) &&
                (removed.option.empty() || word.substr(0, word.find('=')) == removed.option))
                return fmt::format("there is no {} any more; {}",
                                   removed.option.empty()
                                       ? fmt::format("command '{}'", removed.command)
                                       : fmt::format("option {}", removed.option),
                                   removed.instead);
    return "";
}

constexpr std::pair<const char*, const char*> kElsewhere[] = {{"--samples", "--spp"},
                                                              {"--res", "--resolution"},
                                                              {"--size", "--resolution"},
                                                              {"--tile", "--block"},
                                                              {"--noise-threshold", "--caution"}};

std::string ProblemOfCommand(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (word.starts_with('-') || std::ranges::find(names, word) != names.end()) return "";
    const std::string start = "there is no command '" + word + "'";
    if (const std::string nearest = NearestName(word, names); !nearest.empty())
        return start + "; did you mean '" + nearest + "'?";
    // Who leaves it out gives a scene.
    if (word.find('.') != std::string::npos)
        return start + "; to render it, type lull render " + word;
    return fmt::format("{}; there are {}", start, fmt::join(names, ", "));
}

// Returns which option has an empty entry in its list, which the parser would drop; "": none.
std::string ProblemOfLists(const CLI::App& command, std::span<const char* const> words) {
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i], name = word.substr(0, word.find('='));
        const CLI::Option* option = command.get_option_no_throw(name);
        if (!option || option->get_delimiter() != ',') continue;
        const std::string list = name != word           ? word.substr(name.size() + 1)
                                 : i + 1 < words.size() ? words[i + 1]
                                                        : "-";
        if (("," + list + ",").find(",,") != std::string::npos)
            return fmt::format("{}: an entry of the list '{}' is empty", name, list);
    }
    return "";
}

// Returns why the words of a command cannot be read, and which option may have been meant.
std::string ProblemOfUsage(const CLI::App& app, const CLI::ParseError& error) {
    const auto given = app.get_subcommands();
    const CLI::App& command = given.empty() ? app : *given.front();
    const std::string help =
        "; lull " + (given.empty() ? "" : command.get_name() + " ") + "--help lists the options";
    const std::vector<std::string> rest = app.remaining(true);
    if (error.get_exit_code() != int(CLI::ExitCodes::ExtrasError) || rest.empty())
        return error.what() + help;
    // They come in no order; the others are arguments of the option.
    const auto option =
        std::ranges::find_if(rest, [](const auto& w) { return w.starts_with("-"); });
    if (option == rest.end()) return "unexpected argument '" + rest.front() + "'" + help;
    const std::string word = option->substr(0, option->find('='));
    std::vector<std::string> names;
    for (const CLI::Option* known : command.get_options())
        for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
    std::string nearest = NearestName(word, names);
    for (const auto& [elsewhere, here] : kElsewhere)
        if (word == elsewhere && std::ranges::count(names, here) > 0) nearest = here;
    return "there is no option " + word +
           (nearest.empty() ? help : "; did you mean " + nearest + "?");
}

ExitCode Main(MpiJob* job, int argc, char** argv) {
    CLI::App app(
        "Path tracer for pbrt-v3, pbrt-v4 and glTF 2.0 that stops each block of the image once no "
        "noise is visible.",
        "lull");
    SetProgramHelp(&app);
    app.set_version_flag("--version", "lull " LULL_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Example: lull render scene.pbrt -o image.exr\n"
        "lull COMMAND --help lists the options of a command.");

    Command command;
    render::AddCommand(app, &command, job);
    denoise::AddCommand(app, &command);
    info::AddCommand(app, &command);
    record::AddCommand(app, &command, job);
    train::AddCommand(app, &command);
    evaluate::AddCommand(app, &command);
    entropy::AddCommand(app, &command);
    selftest::AddCommand(app, &command);
    compare::AddCommand(app, &command, job);
    study::AddCommand(app, &command);
    for (CLI::App* each : app.get_subcommands({})) SetHelp(each);
    std::vector<const char*> words(argv, argv + argc);
    if (argc == 1) words.push_back("--help");
    if (argc > 1 && std::string_view(words[1]) == "help") {
        words.erase(words.begin() + 1);
        words.push_back("--help");
    }
    std::string problem = ProblemOfRemoved(words);
    if (problem.empty()) problem = ProblemOfCommand(app, words[1]);
    for (const CLI::App* each : app.get_subcommands({}))
        if (problem.empty() && each->get_name() == words[1]) problem = ProblemOfLists(*each, words);
    if (!problem.empty()) return Run(job, [problem]() -> ExitCode { throw UsageError(problem); });
    try {
        app.parse(int(words.size()), words.data());
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) {
            app.exit(e);
            return Run(job, [] { return kDone; });
        }
        return Run(job, [&]() -> ExitCode { throw UsageError(ProblemOfUsage(app, e)); });
    }
    const auto isShared = [&](const char* name) { return app.got_subcommand(name); };
    if (job->Count() > 1 && std::ranges::none_of(kSharedCommands, isShared))
        command = []() -> ExitCode {
            throw Error(
                "only render, compare and record run on several ranks; start this one without "
                "mpirun");
        };
    return Run(job, command);
}

ExitCode Main(int argc, char** argv) {
    std::unique_ptr<MpiJob> job;
    try {
        job = std::make_unique<MpiJob>();
    } catch (const Error& e) {
        PrintToStderr("lull: error: {}\n", e.what());
        return kFailed;
    }
    const ExitCode code = Main(job.get(), argc, argv);
    job->Leave(code);
    return code;
}

}  // namespace

}  // namespace lull

int main(int argc, char** argv) {
    lull::PrepareStreams();
    return lull::Main(argc, argv);
}
