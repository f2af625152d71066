#include "renderer/commands/command.h"

#include <fcntl.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

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

}  // namespace lull
