#include "renderer/lab/pages/study_texts.h"

#include <fmt/format.h>

#include <regex>
#include <set>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/files/file_contents.h"
#include "renderer/pages/embedded.h"
#include "stopping/base/text_lines.h"

namespace lull {

namespace {

constexpr size_t kLongestText = 100000;

// A text, and the line of its key.
struct Section {
    std::string key, text;
    int line = 0;
};

// Returns the key of a line "[key]"; "" for other lines.
std::string KeyIn(const std::string& line) {
    static const std::regex key(R"(\[([a-z][a-z.]*)\]\s*)");
    std::smatch match;
    return std::regex_match(line, match, key) ? match[1].str() : "";
}

std::string Trimmed(const std::string& text) {
    const size_t begin = text.find_first_not_of(" \t\r\n");
    return begin == std::string::npos
               ? ""
               : text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

// Returns the sections of a text of this name; the first has no key.
std::vector<Section> SectionsOf(const std::string& text, const std::string& name) {
    std::vector<Section> sections(1);
    std::istringstream in(text);
    for (TextLines lines(in, name); lines.Next();)
        if (const std::string key = KeyIn(lines.Line()); !key.empty())
            sections.push_back({key, "", lines.Number()});
        else
            sections.back().text += lines.Line() + "\n";
    for (Section& section : sections) section.text = Trimmed(section.text);
    return sections;
}

StudyTexts TextsOfThePage() {
    StudyTexts texts;
    for (Section& section : SectionsOf(DefaultStudyTexts(), "the texts of the page"))
        if (!section.key.empty()) texts[section.key] = std::move(section.text);
    return texts;
}

// Returns the {names} in a text.
std::set<std::string> NamesIn(const std::string& text) {
    static const std::regex name(R"(\{(\w+)\})");
    std::set<std::string> names;
    for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
        names.insert((*at)[1]);
    return names;
}

// Throws Error.
void CheckSection(const Section& section, const StudyTexts& page, const StudyTexts& before,
                  const std::string& path) {
    const std::string at = fmt::format("{}:{}: [{}] ", path, section.line, section.key);
    const auto known = page.find(section.key);
    if (known == page.end())
        throw Error(at + "is no text of the page; `lull study --list-texts` lists them");
    if (before.contains(section.key)) throw Error(at + "comes twice");
    if (section.text.empty()) throw Error(at + "is empty");
    const std::set<std::string> names = NamesIn(known->second);
    for (const std::string& name : NamesIn(section.text))
        if (!names.contains(name))
            throw Error(fmt::format("{}has {{{}}}, which nothing is put in for there", at, name));
}

}  // namespace

std::string DefaultStudyTexts() { return std::string(EmbeddedFile("study_texts.md")); }

StudyTexts ReadStudyTexts(const std::string& path) {
    const std::string text(ReadFile(path).View());
    if (text.empty()) throw Error(path + ": is not a text, or empty");
    if (text.size() > kLongestText)
        throw Error(fmt::format("{}: has {} bytes; a text that observers read has at most {}", path,
                                text.size(), kLongestText));
    const StudyTexts page = TextsOfThePage();
    StudyTexts texts;
    for (const Section& section : SectionsOf(text, path))
        if (section.key.empty()) {
            if (!section.text.empty()) texts["own"] = section.text;
        } else {
            CheckSection(section, page, texts, path);
            texts[section.key] = section.text;
        }
    return texts;
}

StudyTexts AllStudyTexts(const StudyTexts& own) {
    StudyTexts texts = own;
    texts.merge(TextsOfThePage());
    texts.try_emplace("own", "");
    return texts;
}

}  // namespace lull
