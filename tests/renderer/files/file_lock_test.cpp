#include "renderer/files/file_lock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "renderer/files/file_io.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

TEST(FileLock, IsHeldByOneAtATime) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("data.h5");
    {
        std::optional<FileLock> first = FileLock::Try(path);
        ASSERT_TRUE(first);
        EXPECT_FALSE(FileLock::Try(path));
        const FileLock moved = std::move(*first);
        first.reset();
        EXPECT_FALSE(FileLock::Try(path));
        EXPECT_TRUE(FileLock::Try(directory.File("other.h5")));
    }
    EXPECT_TRUE(FileLock::Try(path));
    EXPECT_EQ(directory.CountFiles(), 0);  // it leaves nothing behind
}

TEST(FileLock, IsThatOfTheFileBehindALink) {
    const TemporaryDirectory directory;
    const std::string path = directory.Write("data.h5", "");
    std::filesystem::create_symlink(path, directory.File("link.h5"));
    const auto lock = FileLock::Try(path);
    EXPECT_FALSE(FileLock::Try(directory.File("link.h5")));
}

TEST(FileLock, LosesNoUpdate) {
    const TemporaryDirectory directory;
    const std::string path = directory.Write("count", "0");
    constexpr int kThreads = 8, kUpdates = 20;
    std::atomic<int> waits = 0;
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < kUpdates; ++i) {
                const FileLock lock = FileLock::Wait(path, [&] { ++waits; });
                WriteFileAtomically(path, std::to_string(std::stoi(ReadBytes(path)) + 1));
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(ReadBytes(path), std::to_string(kThreads * kUpdates));
    EXPECT_GT(waits, 0);
    EXPECT_EQ(directory.CountFiles(), 1);
}

// Names that are just allowed have locks, too, which differ where the names do at their end.
TEST(FileLock, IsThereForTheLongestNames) {
    const TemporaryDirectory directory;
    const std::string beginning(250, 'a');
    const auto one = FileLock::Try(directory.File(beginning + "1.exr"));
    const auto other = FileLock::Try(directory.File(beginning + "2.exr"));
    EXPECT_TRUE(one && other);
    EXPECT_FALSE(FileLock::Try(directory.File(beginning + "1.exr")));
}

TEST(FileLock, NamesWhatCannotBeLocked) {
    const TemporaryDirectory directory;
    EXPECT_TRUE(
        Contains(ErrorOf([&] { FileLock::Try(directory.File("none/data.h5")); }), "cannot lock"));
}

}  // namespace
}  // namespace lull
