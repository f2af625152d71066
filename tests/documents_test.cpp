// Checks that links in documents lead to files and headings that exist, and that recipes list the
// files that name their example.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Document {
    std::vector<std::string> links;
    std::set<std::string> anchors;  // of its headings
};

// Returns the anchor that GitHub and most viewers derive from a heading: lower case, without
// punctuation and markup, with hyphens for spaces.
std::string AnchorOf(const std::string& heading) {
    static const std::regex link("\\[([^\\]]*)\\]\\([^)]*\\)");
    std::string anchor;
    for (const char c : std::regex_replace(heading, link, "$1")) {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) || c == '-' || c == '_' || letter >= 0x80)
            anchor += char(std::tolower(letter));
        else if (c == ' ')
            anchor += '-';
    }
    return anchor;
}

// Reads the links and headings outside of code.
Document ReadDocument(const fs::path& path) {
    static const std::regex heading("#+ +(.*?) *"), link("\\]\\(([^()\\s]+)\\)"), code("`[^`]*`");
    Document document;
    bool isCode = false;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("```")) isCode = !isCode;
        if (isCode || line.starts_with("    ")) continue;
        std::smatch match;
        if (std::regex_match(line, match, heading)) {
            const std::string anchor = AnchorOf(match[1]);
            std::string name = anchor;
            for (int i = 1; !document.anchors.insert(name).second; ++i)
                name = anchor + "-" + std::to_string(i);
        }
        line = std::regex_replace(line, code, "");
        for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at)
            document.links.push_back((*at)[1]);
    }
    return document;
}

std::map<fs::path, Document> ReadDocuments() {
    const fs::path root = fs::canonical(LULL_ROOT);
    std::map<fs::path, Document> documents;
    for (fs::recursive_directory_iterator at(root), end; at != end; ++at) {
        const std::string name = at->path().filename();
        if (at->is_directory() && (name == "build" || name.starts_with('.')))
            at.disable_recursion_pending();
        else if (at->path().extension() == ".md")
            documents[at->path()] = ReadDocument(at->path());
    }
    return documents;
}

TEST(Documents, LinkToFilesAndHeadingsThatExist) {
    const std::map<fs::path, Document> documents = ReadDocuments();
    size_t count = 0;
    for (const auto& [path, document] : documents)
        for (const std::string& link : document.links) {
            if (link.starts_with("http://") || link.starts_with("https://")) continue;
            if (link == "../../releases") continue;  // beside the repository, where it is published
            ++count;
            const size_t hash = std::min(link.find('#'), link.size());
            const fs::path file =
                hash == 0 ? path : (path.parent_path() / link.substr(0, hash)).lexically_normal();
            EXPECT_TRUE(fs::exists(file)) << path << " links to " << link;
            if (hash == link.size()) continue;
            const auto target = documents.find(file);
            EXPECT_TRUE(target != documents.end() &&
                        target->second.anchors.contains(link.substr(hash + 1)))
                << path << " links to " << link;
        }
    EXPECT_GT(count, 100u);
}

std::string ReadText(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Returns whether a text has a word in it, not as a part of a longer one.
bool HasWord(const std::string& text, const std::string& word) {
    const auto isLetter = [&](size_t i) {
        return i < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_');
    };
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at)
        if ((at == 0 || !isLetter(at - 1)) && !isLetter(at + word.size())) return true;
    return false;
}

// Returns the C++ files of the program that have the word in them, from the root of the project.
std::set<std::string> FilesNaming(const std::string& word) {
    const fs::path root = fs::canonical(LULL_ROOT);
    std::set<std::string> files;
    for (const char* folder : {"renderer", "stopping"})
        for (fs::recursive_directory_iterator at(root / folder), end; at != end; ++at) {
            const fs::path extension = at->path().extension();
            if ((extension == ".h" || extension == ".cpp") && HasWord(ReadText(at->path()), word))
                files.insert(fs::relative(at->path(), root));
        }
    return files;
}

// Returns the C++ files of the program that a section names: `a/b.h`, or `.cpp` after that.
std::set<std::string> FilesOf(const std::string& section) {
    static const std::regex code("`([^`]*)`");
    std::set<std::string> files;
    fs::path last;
    for (std::sregex_iterator at(section.begin(), section.end(), code), end; at != end; ++at) {
        const std::string text = (*at)[1];
        if (text.starts_with("renderer/") || text.starts_with("stopping/"))
            last = text;
        else if (text == ".cpp" && !last.empty())
            last.replace_extension(text);
        else
            continue;
        if (last.extension() == ".h" || last.extension() == ".cpp") files.insert(last);
    }
    return files;
}

TEST(Recipes, ListAllFilesThatNameTheirExample) {
    const std::string text = ReadText(fs::path(LULL_ROOT) / "CONTRIBUTING.md");
    static const std::regex heading("### Add [^(\n]*\\(`(\\w+)`\\)\n");
    int recipes = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), heading), end; at != end; ++at) {
        const std::string word = (*at)[1];
        const size_t begin = size_t(at->position()) + 4;
        const std::set<std::string> listed =
            FilesOf(text.substr(begin, text.find("\n##", begin) - begin));
        for (const std::string& file : listed)
            EXPECT_TRUE(fs::exists(fs::path(LULL_ROOT) / file)) << word << ": " << file;
        const std::set<std::string> naming = FilesNaming(word);
        EXPECT_FALSE(naming.empty()) << word;
        for (const std::string& file : naming)
            EXPECT_TRUE(listed.contains(file)) << word << " is named in " << file;
        ++recipes;
    }
    EXPECT_EQ(recipes, 4);
}

}  // namespace
