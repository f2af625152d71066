#include "renderer/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

namespace lull {

std::string FileLoc::Prefix() const {
    if (!file) return "";
    return line > 0 ? *file + ":" + std::to_string(line) + ": " : *file + ": ";
}

namespace {

std::string WithoutMiddle(const std::string& line, size_t most) {
    if (line.size() <= most) return line;
    size_t begin = line.size() - most / 2;
    while (begin < line.size() && IsWithinCharacter(line[begin])) ++begin;
    return BeginningOf(line, most / 2) + " ... " + line.substr(begin);
}

// Returns the bytes of a text's first character in UTF-8; 0 if it is none, or a control one.
size_t PrintedBytes(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    const size_t bytes = CharacterBytes(text);
    const bool isControl =
        bytes == 1 ? first < 0x20 || first == 0x7f
                   : bytes == 2 && first == 0xc2 && static_cast<unsigned char>(text[1]) < 0xa0;
    return isControl ? 0 : bytes;
}

}  // namespace

std::string OneLine(const std::string& text, size_t most) {
    std::string line;
    bool isBetween = false;
    for (size_t i = 0; i < text.size();) {
        if (text[i] == '\n' || text[i] == '\r') {
            isBetween = true;
            ++i;
            continue;
        }
        if (std::exchange(isBetween, false) && !line.empty()) line += "; ";
        const size_t length = PrintedBytes(std::string_view(text).substr(i));
        if (length == 0)
            fmt::format_to(std::back_inserter(line), "\\x{:02x}",
                           static_cast<unsigned char>(text[i]));
        else
            line.append(text, i, length);
        i += std::max<size_t>(length, 1);
    }
    return WithoutMiddle(line, most);
}

namespace {

std::string WithoutQuotes(const std::string& phrase) {
    std::string text;
    for (size_t i = 0; i < phrase.size(); ++i) {
        const char c = phrase[i];
        text += c;
        const bool opens =
            c == '"' ||
            (c == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(phrase[i - 1]))));
        const size_t end = opens ? phrase.find(c, i + 1) : std::string::npos;
        if (end == std::string::npos) continue;
        text += std::string("...") + c;
        i = end;
    }
    return text;
}

}  // namespace

void Warnings::Add(const FileLoc& loc, const std::string& kind, const std::string& detail) {
    Add(loc, kind, detail, true);
}

void Warnings::AddMinor(const FileLoc& loc, const std::string& kind) {
    Add(loc, kind, "", isVerbose);
}

void Warnings::Add(const FileLoc& loc, const std::string& kind, const std::string& detail,
                   bool isPassedOn) {
    std::lock_guard lock(mutex);
    Count& count = counts[kind];
    if (count.count++ > 0 || !isPassedOn) return;
    count.isShown = ++alike[WithoutQuotes(kind)] <= kMostAlike;
    if (count.isShown && sink)
        sink(loc.Prefix() + "warning: " + kind + (detail.empty() ? "" : ": " + detail));
}

void Warnings::Substitute(const FileLoc& loc, const std::string& problem,
                          const std::string& substitute) {
    if (substitutes)
        Add(loc, problem + "; " + substitute);
    else
        AddError(Error(loc, problem + "; with --substitute " + substitute));
}

void Warnings::AddError(const Error& error) {
    std::lock_guard lock(mutex);
    if (errors.size() < kMostErrors)
        errors.push_back(error);
    else
        ++moreErrors;
}

void Warnings::ThrowErrors() {
    std::lock_guard lock(mutex);
    const std::vector<Error> kept = std::exchange(errors, {});
    const size_t more = std::exchange(moreErrors, 0);
    if (kept.empty()) return;
    if (kept.size() == 1) throw kept[0];
    std::string lines;
    for (const Error& error : kept) {
        if (!lines.empty()) lines += '\n';
        lines += OneLine(error.what(), kLongestMessage);
    }
    if (more > 0) lines += fmt::format("\nand {} more", more);
    throw Errors(lines);
}

std::map<std::string, int> Warnings::Counts() const {
    std::lock_guard lock(mutex);
    std::map<std::string, int> numbers;
    for (const auto& [kind, count] : counts) numbers[kind] = count.count;
    return numbers;
}

int Warnings::Total() const {
    int total = 0;
    for (const auto& [kind, count] : Counts()) total += count;
    return total;
}

void Warnings::Summarize() const {
    std::lock_guard lock(mutex);
    if (!sink) return;
    for (const auto& [kind, count] : counts)
        if (count.isShown && count.count > 1)
            sink(fmt::format("warning: {} ({} times in all)", kind, count.count));
    for (const auto& [kind, count] : alike)
        if (count > kMostAlike)
            sink(fmt::format("warning: and {} more: {}", count - kMostAlike, kind));
}

size_t CharacterBytes(std::string_view text) {
    if (text.empty()) return 0;
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return 1;
    const size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (length == 0 || text.size() < length) return 0;
    uint32_t code = first & (0x7f >> length);
    for (const char c : text.substr(1, length - 1)) {
        if (!IsWithinCharacter(c)) return 0;
        code = code << 6 | (static_cast<unsigned char>(c) & 0x3f);
    }
    constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // smaller ones have fewer bytes
    const bool isSurrogate = code >= 0xd800 && code < 0xe000;
    return code < kLeast[length] || code > 0x10ffff || isSurrogate ? 0 : length;
}

std::string ToUtf8(std::string_view text) {
    std::string utf8;
    while (!text.empty()) {
        const size_t bytes = CharacterBytes(text);
        utf8 += bytes == 0 || text[0] == '\0' ? "\xef\xbf\xbd" : text.substr(0, bytes);
        text.remove_prefix(std::max<size_t>(bytes, 1));
    }
    return utf8;
}

std::string LowerCase(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string BeginningOf(const std::string& text, size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && IsWithinCharacter(text[most])) --most;
    return text.substr(0, most);
}

}  // namespace lull
