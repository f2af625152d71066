// Checks what the compiler cannot: that rooms include no header that another keeps for itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// Returns the room of a path relative to the project: renderer/scene of
// renderer/scene/shapes/mesh.h.
std::string RoomOf(const std::string& path) {
    const size_t folder = path.find('/');
    return path.substr(0, path.find('/', folder + 1));
}

bool IsPrivate(const std::string& header) {
    return header.ends_with("_internal.h") ||
           fs::path(header).parent_path() != fs::path(RoomOf(header));
}

TEST(Rooms, IncludeNoHeaderThatAnotherKeepsForItself) {
    const fs::path root = LULL_ROOT;
    const std::regex include("#include \"((renderer|stopping)/[^\"]+)\"");
    int count = 0;
    for (const char* house : {"renderer", "stopping"})
        for (const auto& entry : fs::recursive_directory_iterator(root / house)) {
            const std::string extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            const std::string file = fs::relative(entry.path(), root);
            std::ifstream in(entry.path());
            std::smatch match;
            for (std::string line; std::getline(in, line);) {
                if (!std::regex_search(line, match, include)) continue;
                const std::string header = match[1];
                ++count;
                EXPECT_TRUE(RoomOf(file) == RoomOf(header) || !IsPrivate(header))
                    << file << " includes " << header;
            }
        }
    EXPECT_GT(count, 500);
}

TEST(Rooms, KnowWhatIsPrivate) {
    EXPECT_TRUE(IsPrivate("renderer/scene/shapes/mesh.h"));
    EXPECT_TRUE(IsPrivate("renderer/scene/accelerator_internal.h"));
    EXPECT_FALSE(IsPrivate("renderer/scene/scene.h"));
    EXPECT_FALSE(IsPrivate("stopping/rules/criterion.h"));
    EXPECT_EQ(RoomOf("renderer/main.cpp"), "renderer/main.cpp");
}

}  // namespace
