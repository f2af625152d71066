// Finds the reference data that lies beside the project, for tests that compare with it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace lull {

// Returns the path of a shared file; empty if neither $LULL_SHARED nor the folder known when the
// tests were built has it.
inline std::string FindShared(const std::string& name) {
    const char* variable = std::getenv("LULL_SHARED");
    const std::string folders[] = {variable ? variable : "", LULL_SHARED_DIR};
    for (const std::string& folder : folders)
        if (!folder.empty() && std::filesystem::exists(folder + "/" + name))
            return folder + "/" + name;
    return "";
}

inline nlohmann::json ReadJson(const std::string& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
}

}  // namespace lull

// Declares `path` as that of a shared file, or skips the test.
#define LULL_SHARED_FILE(path, name)                 \
    const std::string path = lull::FindShared(name); \
    if (path.empty())                                \
    GTEST_SKIP() << "There is no " << (name) << " in $LULL_SHARED or " LULL_SHARED_DIR
