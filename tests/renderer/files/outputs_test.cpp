#include "renderer/files/outputs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "renderer/files/file_io.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

namespace fs = std::filesystem;

std::string Check(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
    return ErrorOf([&] { CheckOutputs(outputs, inputs); });
}

TEST(CheckOutputs, TakesFilesThatAreNotTheSame) {
    const TemporaryDirectory directory;
    const std::string input = directory.Write("in.h5", "");
    EXPECT_NO_THROW(CheckOutputs(
        std::vector<NamedFile>{{"-o", directory.File("out.exr")},
                               {"--report", directory.File("out.json")},
                               {"--csv", ""},
                               {"--ranges", ""}},
        std::vector<NamedFile>{{"the scene", input}, {"a file of it", input}, {"--human", ""}}));
}

TEST(CheckOutputs, NamesBothOfTheSame) {
    const TemporaryDirectory directory;
    const std::string file = directory.File("r.json");
    EXPECT_EQ(Check({{"--report", file}, {"--checkpoint", file}}, {}),
              "--checkpoint \"" + file + "\" would replace --report \"" + file +
                  "\"; give it another name");
    EXPECT_HAS(Check({{"-o", file}}, {{"DATA", file}}), "-o \"" + file + "\" would replace DATA");
}

TEST(CheckOutputs, KnowsFilesByOtherNames) {
    const TemporaryDirectory directory;
    const std::string file = directory.Write("human.csv", "precious");
    fs::create_symlink("human.csv", directory.File("link.csv"));
    fs::create_hard_link(file, directory.File("hard.csv"));
    fs::create_directory(directory.File("folder"));
    for (const char* name : {"link.csv", "hard.csv", "folder/../human.csv", "./human.csv"})
        EXPECT_HAS(Check({{"--csv", directory.File(name)}}, {{"--human", file}}), "--human")
            << name;
}

TEST(CheckOutputs, TakesDevicesTwice) {
    EXPECT_NO_THROW(
        CheckOutputs(std::vector<NamedFile>{{"-o", "/dev/null"}, {"--csv", "/dev/null"}}, {}));
}

TEST(BeginningOfNames, IsTheNameOrInAFolderThatIsMade) {
    const TemporaryDirectory directory;
    EXPECT_EQ(BeginningOfNames("", "room"), "room");
    EXPECT_EQ(BeginningOfNames("a/b", "room"), "a/b");
    const std::string folder = directory.File("new/deep/");
    EXPECT_EQ(BeginningOfNames(folder, "room"), folder + "room");
    EXPECT_TRUE(fs::is_directory(folder));
    EXPECT_EQ(BeginningOfNames(folder, "room"), folder + "room");
    const std::string file = directory.Write("file", "");
    EXPECT_HAS(ErrorOf([&] { BeginningOfNames(file + "/", "room"); }), "-o " + file);
}

namespace fs = std::filesystem;

// Sets where temporary files go while it lives.
struct TemporaryFolder {
    std::string before;

    explicit TemporaryFolder(const std::string& folder) {
        if (const char* old = std::getenv("TMPDIR")) before = old;
        setenv("TMPDIR", folder.c_str(), 1);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        if (before.empty())
            unsetenv("TMPDIR");
        else
            setenv("TMPDIR", before.c_str(), 1);
    }
};

TEST(ResultFiles, AreWhereTheyShouldBe) {
    const TemporaryDirectory directory;
    ResultFiles results;
    results.WriteText(directory.File("a.csv"), "a");
    results.WriteText(directory.File("b.csv"), "b");
    EXPECT_NO_THROW(results.Check());
    EXPECT_EQ(results.Names(),
              (std::vector<std::string>{directory.File("a.csv"), directory.File("b.csv")}));
    EXPECT_EQ(directory.Bytes("b.csv"), "b");
}

TEST(ResultFiles, GoElsewhereOneByOne) {
    const TemporaryDirectory directory;
    const TemporaryFolder temporary(directory.path);
    ResultFiles results;
    results.WriteText(directory.File("missing/a.csv"), "a");
    results.WriteText(directory.File("b.csv"), "b");
    results.WriteText(directory.File("missing/c.csv"), "c");
    ASSERT_EQ(results.Names().size(), 3u);
    const fs::path folder = fs::path(results.Names()[0]).parent_path();
    EXPECT_EQ(folder.parent_path(), directory.path);
    EXPECT_EQ(results.Names()[2], folder / "c.csv");
    EXPECT_EQ(ReadBytes(folder / "a.csv") + ReadBytes(folder / "c.csv"), "ac");
    const std::string error = ErrorOf([&] { results.Check(); });
    EXPECT_HAS(error, "does not exist");
    EXPECT_HAS(error, "; in " + folder.string() + " instead: \"");
}

TEST(ResultFiles, AreWrittenTogether) {
    const TemporaryDirectory directory;
    const TemporaryFolder temporary(directory.path);
    ResultFiles results;
    const auto text = [](const std::string& what) {
        return [what](const std::string& file) { WriteFileAtomically(file, what); };
    };
    results.WriteAll({{directory.File("a.csv"), text("a")},
                      {directory.File("missing/b.csv"), text("b")},
                      {directory.File("c.csv"), text("c")}});
    ASSERT_EQ(results.Names().size(), 3u);
    EXPECT_EQ(results.Names()[0], directory.File("a.csv"));
    EXPECT_EQ(results.Names()[2], directory.File("c.csv"));
    EXPECT_EQ(ReadBytes(results.Names()[1]), "b");
    EXPECT_NE(results.Names()[1], directory.File("missing/b.csv"));
    EXPECT_HAS(ErrorOf([&] { results.Check(); }), "does not exist");
}

TEST(ResultFiles, SayWhatIsLost) {
    const TemporaryDirectory directory;
    const TemporaryFolder temporary("/proc");
    ResultFiles results;
    results.WriteText(directory.File("missing/a.csv"), "a");
    EXPECT_TRUE(results.Names().empty());
    EXPECT_HAS(ErrorOf([&] { results.Check(); }), "; lost: \"");
}

TEST(ResultFiles, RemovesFilesAndNothingElse) {
    const TemporaryDirectory directory;
    ResultFiles::RemoveOld(directory.Write("a.csv", ""));
    ResultFiles::RemoveOld(directory.File("none.csv"));
    ResultFiles::RemoveOld(directory.path.string());
    EXPECT_EQ(directory.CountFiles(), 0);
    EXPECT_TRUE(fs::exists(directory.path));
}

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
    EXPECT_HAS(ErrorOf([&] { FileLock::Try(directory.File("none/data.h5")); }), "cannot lock");
}

}  // namespace
}  // namespace lull
