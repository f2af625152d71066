// Checks that links in documents lead to files and headings that exist.
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

}  // namespace
