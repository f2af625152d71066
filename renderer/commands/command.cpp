#include "renderer/commands/command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"

namespace lull {

void PrepareStreams() {
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
    // A new file gets the lowest free number. Only the stream of errors is opened for writing:
    // results that go nowhere are an error.
    constexpr std::pair<int, int> kStreams[] = {{0, O_RDONLY}, {1, O_RDONLY}, {2, O_WRONLY}};
    for (const auto& [stream, mode] : kStreams)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", mode) < 0) return;
}

bool HasLostResults() { return std::ferror(stdout) != 0; }

void FinishResults() {
    if (std::fflush(stdout) == 0 && !HasLostResults()) return;
    throw Error(std::string("cannot write the results to stdout: ") + std::strerror(errno));
}

std::string JsonEvent(const std::string& event, const std::string& text, const std::string& key) {
    const nlohmann::ordered_json json = {{"event", event}, {key, text}};
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void Messages::Note(const std::string& message) const { Print("note", message); }

// On a terminal there may be a line of progress.
void Messages::Warn(const std::string& message) const {
    if (isJson)
        Print("warning", message);
    else
        lull::PrintToStderr("\nlull: warning: {}\n", OneLine(message, kLongestMessage));
}

void Messages::Print(const std::string& event, const std::string& message) const {
    if (isJson)
        lull::PrintToStderr("{}", JsonEvent(event, message));
    else
        PrintMessage(message);
}

void PrintMessage(const std::string& message) { PrintToStderr("lull: {}\n", OneLine(message)); }

void WriteBytes(const std::string& path, std::span<const std::byte> bytes) {
    WriteFileAtomically(path, bytes);
}

namespace {

std::vector<const CLI::Option*> OptionsOf(const CLI::App& app, const std::string& group) {
    return app.get_options([&](const CLI::Option* option) {
        return option->nonpositional() && option->get_group() == group;
    });
}

class Help : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        std::string text = app->get_description() + "\n" + Usage(*app, name);
        const auto positionals = app->get_options([](const CLI::Option* option) {
            return option->get_positional() && !option->get_group().empty();
        });
        if (!positionals.empty()) text += Section("Positionals", positionals);
        if (mode == CLI::AppFormatMode::Normal && !OptionsOf(*app, kCommonOptions).empty()) {
            for (const char* group : {kOptions, kCommonOptions})
                if (const auto options = OptionsOf(*app, group); !options.empty())
                    text += Section(group, options);
            text += fmt::format("\nlull {} --help-all lists all options.\n", app->get_name());
        } else {
            bool isFirst = true;
            for (const std::string& group : app->get_groups())
                if (const auto options = OptionsOf(*app, group);
                    !group.empty() && !options.empty()) {
                    text += (isFirst ? "" : "\n") + Section(group, options);
                    isFirst = false;
                }
        }
        if (const auto commands = app->get_subcommands({}); !commands.empty()) {
            text += "\nSubcommands:\n";
            for (const CLI::App* command : commands)
                text += Entry(command->get_name(), command->get_description());
        }
        return text + "\n" + app->get_footer() + "\n";
    }

  private:
    std::string Usage(const CLI::App& app, const std::string& name) const {
        std::string text = "Usage: " + name + " [OPTIONS]";
        for (const CLI::Option* option : app.get_options())
            if (option->get_positional()) text += " " + make_option_usage(option);
        return text + (app.get_subcommands({}).empty() ? "\n" : " SUBCOMMAND\n");
    }

    std::string Entry(const std::string& head, const std::string& text) const {
        const std::string indent(column_width_, ' ');
        std::string entry = "  " + head;
        if (entry.size() < column_width_)
            entry.resize(column_width_, ' ');
        else if (!text.empty())
            entry += "\n" + indent;
        for (const char c : text) {
            entry += c;
            if (c == '\n') entry += indent;
        }
        return entry + "\n";
    }

    std::string Section(const std::string& title,
                        const std::vector<const CLI::Option*>& options) const {
        std::string text = "\n" + title + ":\n";
        for (const CLI::Option* option : options)
            text += Entry(option->get_name(option->get_positional(), option->nonpositional()) +
                              ValueOf(*option),
                          option->get_description());
        return text;
    }

    std::string ValueOf(const CLI::Option& option) const {
        std::string text;
        if (option.get_type_size() != 0) {
            if (!option.get_type_name().empty()) text += " " + option.get_type_name();
            if (!option.get_default_str().empty()) text += "=" + option.get_default_str();
            if (option.get_expected_max() == CLI::detail::expected_max_vector_size)
                text += " ...";
            else if (option.get_expected_min() > 1)
                text += fmt::format(" x {}", option.get_expected_min());
            if (option.get_required()) text += " REQUIRED";
        }
        const auto add = [&](const char* relation, const auto& others) {
            if (!others.empty()) text += fmt::format(" {}:", relation);
            for (const CLI::Option* other : others) text += fmt::format(" {}", other->get_name());
        };
        add("Needs", option.get_needs());
        add("Excludes", option.get_excludes());
        return text;
    }
};

}  // namespace

void SetProgramHelp(CLI::App* program) {
    program->option_defaults()->group(kOptions);
    program->get_help_ptr()->group(kOptions);
    program->formatter(std::make_shared<Help>());
}

void SetHelp(CLI::App* command) {
    const char* group = OptionsOf(*command, kCommonOptions).empty() ? kOptions : "Advanced";
    command->set_help_flag("-h,--help", "Print the common options and exit")->group(group);
    command->set_help_all_flag("--help-all", "Print all options and exit")->group(group);
    command->formatter(std::make_shared<Help>());
}

}  // namespace lull
