#include "renderer/files/file_io.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>
#include <vector>

#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

namespace fs = std::filesystem;

TEST(WriteFileAtomically, WritesAndReplaces) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("report.json");
    WriteFileAtomically(path, "old, longer text");
    WriteFileAtomically(path, "new");
    EXPECT_EQ(ReadBytes(path), "new");
    WriteFileAtomically(path, "");
    EXPECT_EQ(ReadBytes(path), "");
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(WriteFileAtomically, KeepsModeAndFollowsLinks) {
    const TemporaryDirectory directory;
    const std::string path = directory.Write("real.csv", "old");
    ASSERT_EQ(chmod(path.c_str(), 0640), 0);
    fs::create_symlink("real.csv", directory.File("link.csv"));
    WriteFileAtomically(directory.File("link.csv"), "new");
    EXPECT_TRUE(fs::is_symlink(directory.File("link.csv")));
    EXPECT_EQ(ReadBytes(path), "new");
    EXPECT_EQ(int(fs::status(path).permissions()), 0640);
}

TEST(WriteFileAtomically, WritesNamesAtTheLimitAndRelativeOnes) {
    const TemporaryDirectory directory;
    const std::string longest = directory.File(std::string(250, 'x') + ".exr");
    WriteFileAtomically(longest, "1");
    EXPECT_EQ(ReadBytes(longest), "1");
    const fs::path before = fs::current_path();
    fs::current_path(directory.path);
    EXPECT_NO_THROW(CheckWritable("relative.json"));
    WriteFileAtomically("relative.json", "2");
    fs::current_path(before);
    EXPECT_EQ(directory.Bytes("relative.json"), "2");
}

TEST(WriteFileAtomically, RefusesWithReason) {
    const TemporaryDirectory directory;
    directory.Write("file", "");
    const auto reason = [](const std::string& path) {
        const std::string error = ErrorOf([&] { WriteFileAtomically(path, "x"); });
        EXPECT_EQ(ErrorOf([&] { CheckWritable(path); }), error);
        return error;
    };
    EXPECT_HAS(reason(directory.path.string()), "it is a directory");
    EXPECT_HAS(reason(directory.File("new/")), "directory");
    EXPECT_HAS(reason(directory.File("none/x.exr")), "does not exist");
    EXPECT_HAS(reason(directory.File("none/x.exr")), "x.exr");
    EXPECT_HAS(reason(directory.File("file/x.exr")), "director");
    EXPECT_HAS(reason(""), "empty");
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(WriteFileAtomically, RefusesDirectoryWithoutPermission) {
    // Even the superuser cannot create files here.
    EXPECT_THROW(CheckWritable("/proc/self/x.exr"), Error);
    EXPECT_THROW(WriteFileAtomically("/proc/self/x.exr", "x"), Error);
    if (geteuid() == 0) GTEST_SKIP() << "permission bits do not bind the superuser";
    const TemporaryDirectory directory;
    const std::string path = directory.Write("x.exr", "old");
    fs::permissions(directory.path, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THROW(CheckWritable(path), Error);
    EXPECT_THROW(WriteFileAtomically(path, "new"), Error);
    EXPECT_EQ(ReadBytes(path), "old");
    fs::permissions(directory.path, fs::perms::owner_all);
}

TEST(WriteFileAtomically, KeepsOldFileWhenTheDiskIsFull) {
    const TemporaryDirectory directory;
    const std::string path = directory.Write("x.exr", "old");
    // A limit on the size of files stands for the full disk: write() fails half-way.
    rlimit before;
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    EXPECT_THROW(WriteFileAtomically(path, std::string(10000, 'x')), Error);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(ReadBytes(path), "old");
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(WriteFileAtomically, WritesDevicesDirectly) {
    EXPECT_NO_THROW(CheckWritable("/dev/null"));
    EXPECT_NO_THROW(WriteFileAtomically("/dev/null", "x"));
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    EXPECT_HAS(ErrorOf([] { WriteFileAtomically("/dev/full", "x"); }), "No space left");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(WriteFileAtomically, TakesManyWritersAtOnce) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("shared.json");
    std::vector<std::thread> writers;
    for (int i = 0; i < 8; ++i)
        writers.emplace_back([&, i] {
            for (int round = 0; round < 20; ++round)
                WriteFileAtomically(path, std::string(100000, char('a' + i)));
        });
    for (std::thread& writer : writers) writer.join();
    const std::string text = ReadBytes(path);
    EXPECT_EQ(text, std::string(100000, text.at(0)));
    EXPECT_EQ(directory.CountFiles(), 1);
}

// Five that are killed leave no more than one, and the next that writes leaves nothing.
TEST(AtomicFile, RemovesWhatKilledWritersLeave) {
    const TemporaryDirectory directory;
    const std::string path = directory.Write("x.exr", "old");
    for (int i = 0; i < 5; ++i) {
        const pid_t writer = fork();
        if (writer == 0) {
            AtomicFile file(path);
            file.WriteAt(0, std::as_bytes(std::span(path)));
            _exit(0);
        }
        ASSERT_GT(writer, 0);
        waitpid(writer, nullptr, 0);
        EXPECT_EQ(directory.CountFiles(), 2);
        EXPECT_EQ(ReadBytes(path), "old");
    }
    WriteFileAtomically(path, "new");
    EXPECT_EQ(ReadBytes(path), "new");
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(AtomicFile, DoesNotDisturbAnother) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("x.exr");
    AtomicFile first(path);
    first.WriteAt(0, std::as_bytes(std::span("first", 5)));
    EXPECT_NO_THROW(CheckWritable(path));
    WriteFileAtomically(path, "second");
    EXPECT_EQ(ReadBytes(path), "second");
    first.Commit();
    EXPECT_EQ(ReadBytes(path), "first");
    EXPECT_EQ(directory.CountFiles(), 1);
}

TEST(CheckWritable, LeavesNothingBehind) {
    const TemporaryDirectory directory;
    const std::string old = directory.Write("old.exr", "old");
    CheckWritable(old);
    CheckWritable(directory.File("new.exr"));
    EXPECT_EQ(ReadBytes(old), "old");
    EXPECT_EQ(directory.CountFiles(), 1);
}

}  // namespace
}  // namespace lull
