#include "renderer/base/error.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace lull {

std::string FileLoc::Prefix() const {
    if (!file) return "";
    return line > 0 ? *file + ":" + std::to_string(line) + ": " : *file + ": ";
}

std::string OneLine(const std::string& text) {
    std::string line;
    bool isBetween = false;
    for (const char c : text) {
        if (c == '\n' || c == '\r') {
            isBetween = true;
            continue;
        }
        if (std::exchange(isBetween, false) && !line.empty()) line += "; ";
        if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f)
            fmt::format_to(std::back_inserter(line), "\\x{:02x}", byte);
        else
            line += c;
    }
    return line;
}

void Warnings::Add(const FileLoc& loc, const std::string& kind, const std::string& detail) {
    std::lock_guard lock(mutex);
    if (counts[kind]++ == 0 && sink)
        sink(loc.Prefix() + "warning: " + kind + (detail.empty() ? "" : ": " + detail));
}

std::map<std::string, int> Warnings::Counts() const {
    std::lock_guard lock(mutex);
    return counts;
}

int Warnings::Total() const {
    std::lock_guard lock(mutex);
    int total = 0;
    for (const auto& [kind, count] : counts) total += count;
    return total;
}

void Warnings::Summarize() const {
    std::lock_guard lock(mutex);
    if (!sink) return;
    for (const auto& [kind, count] : counts)
        if (count > 1) sink("warning: " + kind + " (" + std::to_string(count) + " times in all)");
}

}  // namespace lull
