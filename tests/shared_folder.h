// Finds the scenes and reference data of others, which lie beside the project.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace lull {

// Returns the folder with the shared data, $LULL_SHARED or ../shared; it need not be there.
inline std::filesystem::path SharedFolder() {
    const char* set = std::getenv("LULL_SHARED");
    return set && *set ? set : LULL_SHARED_DIR;
}

}  // namespace lull

// Declares `variable` as the path of a shared file or folder, or skips the test. cmake/test.sh
// counts skipped tests by the words before the colon.
#define LULL_SHARED_FILE(variable, name)                                  \
    const std::filesystem::path variable = lull::SharedFolder() / (name); \
    if (!std::filesystem::exists(variable))                               \
    GTEST_SKIP() << "scenes of others are not in ../shared: " << variable
