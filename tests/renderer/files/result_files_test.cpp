#include "renderer/files/result_files.h"

#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

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
    EXPECT_EQ(ReadBytes(directory.File("b.csv")), "b");
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
    EXPECT_TRUE(Contains(error, "does not exist")) << error;
    EXPECT_TRUE(Contains(error, "; in " + folder.string() + " instead: \"")) << error;
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
    EXPECT_TRUE(Contains(ErrorOf([&] { results.Check(); }), "does not exist"));
}

TEST(ResultFiles, SayWhatIsLost) {
    const TemporaryDirectory directory;
    const TemporaryFolder temporary("/proc");
    ResultFiles results;
    results.WriteText(directory.File("missing/a.csv"), "a");
    EXPECT_TRUE(results.Names().empty());
    EXPECT_TRUE(Contains(ErrorOf([&] { results.Check(); }), "; lost: \""));
}

TEST(ResultFiles, RemovesFilesAndNothingElse) {
    const TemporaryDirectory directory;
    ResultFiles::RemoveOld(directory.Write("a.csv", ""));
    ResultFiles::RemoveOld(directory.File("none.csv"));
    ResultFiles::RemoveOld(directory.path.string());
    EXPECT_EQ(directory.CountFiles(), 0);
    EXPECT_TRUE(fs::exists(directory.path));
}

}  // namespace
}  // namespace lull
