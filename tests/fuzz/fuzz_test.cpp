// Replays the seeds of the fuzzers and everything they have found.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/fuzz/fuzz_targets.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

TEST(Fuzz, FindingsStayFixed) {
    int inputs = 0;
    for (const NamedFuzzTarget& target : FuzzTargets())
        for (const char* kind : {"corpus", "regressions"}) {
            const std::filesystem::path folder =
                std::filesystem::path(LULL_FUZZ_DIR) / kind / target.name;
            if (!std::filesystem::exists(folder)) continue;
            for (const auto& entry : std::filesystem::directory_iterator(folder)) {
                SCOPED_TRACE(entry.path().string());
                EXPECT_NO_THROW(target.run(ReadBytes(entry.path().string())));
                ++inputs;
            }
        }
    EXPECT_GE(inputs, 8);
}

}  // namespace
}  // namespace lull
