// Checks conditions that the compiler cannot: that rooms include no private header of another, and
// that the folders of a large room have an order.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// Returns the room of a path relative to the project: renderer/scene of
// renderer/scene/geometry/shapes/mesh.h, stopping/lab/training of stopping/lab/training/training.h.
std::string RoomOf(const std::string& path) {
    static const std::regex room("[^/]+/(lab/)?[^/]+");
    std::smatch match;
    return std::regex_search(path, match, room) ? match.str() : path;
}

// Returns the headers of rooms that a file includes; all paths are relative to the project.
std::vector<std::string> IncludesOf(const std::string& file) {
    static const std::regex include("#include \"((renderer|stopping)/[^\"]+)\"");
    std::vector<std::string> headers;
    std::ifstream in(fs::path(LULL_ROOT) / file);
    std::smatch match;
    for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, include)) headers.push_back(match[1]);
    return headers;
}

// Returns the headers that those of a room's own folder include.
std::set<std::string> HeadersShownBy(const std::string& room) {
    std::set<std::string> shown;
    for (const auto& entry : fs::directory_iterator(fs::path(LULL_ROOT) / room))
        if (entry.path().extension() == ".h")
            for (const std::string& header :
                 IncludesOf(room + "/" + entry.path().filename().string()))
                shown.insert(header);
    return shown;
}

// A header in a folder within a room is private unless one in the room's own folder includes it.
bool IsPrivate(const std::string& header) {
    const std::string room = RoomOf(header);
    if (header.ends_with("_internal.h")) return true;
    return fs::path(header).parent_path() != fs::path(room) &&
           !HeadersShownBy(room).contains(header);
}

// Returns the sources below a folder.
std::vector<std::string> SourcesIn(const std::string& folder) {
    std::vector<std::string> sources;
    const fs::path root = LULL_ROOT;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        const std::string extension = entry.path().extension();
        if (extension == ".h" || extension == ".cpp")
            sources.push_back(fs::relative(entry.path(), root));
    }
    return sources;
}

TEST(Rooms, IncludeNoHeaderThatAnotherKeepsForItself) {
    int count = 0;
    for (const char* house : {"renderer", "stopping"})
        for (const std::string& file : SourcesIn(house))
            for (const std::string& header : IncludesOf(file)) {
                ++count;
                EXPECT_TRUE(RoomOf(file) == RoomOf(header) || !IsPrivate(header))
                    << file << " includes " << header;
            }
    EXPECT_GT(count, 500);
}

// The folders of scene/, in their order: each includes only those before it, and headers beside
// them that include only those.
const std::vector<std::string> kSceneFolders{"textures", "materials", "geometry",
                                             "media",    "cameras",   "lights"};

// Returns the last of these folders that a file of scene/ is in or that, if it lies beside them, it
// includes: its position from 1, or 0.
int LastFolderOf(const std::string& file) {
    const std::string room = "renderer/scene/";
    if (!file.starts_with(room)) return 0;
    const std::string folder = file.substr(room.size(), file.find('/', room.size()) - room.size());
    const auto found = std::find(kSceneFolders.begin(), kSceneFolders.end(), folder);
    if (found != kSceneFolders.end()) return int(found - kSceneFolders.begin()) + 1;
    int last = 0;
    for (const std::string& header : IncludesOf(file)) last = std::max(last, LastFolderOf(header));
    return last;
}

TEST(Rooms, HaveAnOrderWithinScene) {
    int count = 0;
    for (const std::string& folder : kSceneFolders)
        for (const std::string& file : SourcesIn("renderer/scene/" + folder))
            for (const std::string& header : IncludesOf(file)) {
                ++count;
                EXPECT_LE(LastFolderOf(header), LastFolderOf(file))
                    << file << " includes " << header;
            }
    EXPECT_GT(count, 100);
    for (const auto& entry : fs::directory_iterator(fs::path(LULL_ROOT) / "renderer/scene"))
        if (entry.is_directory()) {
            EXPECT_EQ(
                std::count(kSceneFolders.begin(), kSceneFolders.end(), entry.path().filename()), 1)
                << entry.path();
        }
    EXPECT_EQ(LastFolderOf("renderer/scene/interaction.h"), 0);
    EXPECT_EQ(LastFolderOf("renderer/scene/scene.h"), 6);
    EXPECT_EQ(LastFolderOf("renderer/scene/geometry/shapes/mesh.h"), 3);
}

// The laboratories stand beside what they examine: only they, their commands and the program's
// table of commands may know of them.
TEST(Rooms, DoWithoutTheLaboratories) {
    int count = 0;
    for (const char* house : {"renderer", "stopping"})
        for (const std::string& file : SourcesIn(house)) {
            if (file.find("/lab/") != std::string::npos) continue;
            ++count;
            for (const std::string& header : IncludesOf(file))
                EXPECT_EQ(header.find("/lab/"), std::string::npos)
                    << file << " includes " << header;
        }
    EXPECT_GT(count, 300);
}

TEST(Rooms, KnowWhatIsPrivate) {
    EXPECT_TRUE(IsPrivate("renderer/scene/geometry/shapes/mesh.h"));
    EXPECT_TRUE(IsPrivate("renderer/render/executor_internal.h"));
    EXPECT_FALSE(IsPrivate("renderer/scene/scene.h"));
    EXPECT_FALSE(IsPrivate("renderer/scene/lights/light_table.h"));
    EXPECT_TRUE(IsPrivate("renderer/scene/lights/infinite.h"));
    EXPECT_FALSE(IsPrivate("stopping/rules/rule.h"));
    EXPECT_EQ(RoomOf("renderer/main.cpp"), "renderer/main.cpp");
    EXPECT_EQ(RoomOf("stopping/lab/training/training.h"), "stopping/lab/training");
}

}  // namespace
