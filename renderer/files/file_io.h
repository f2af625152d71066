// Writes files whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "renderer/base/error.h"
#include "stopping/base/input_file.h"

namespace lull {

// Names of open files.

// Returns whether the name is still of the open file: who had its lock may have moved it.
bool IsNamed(int fd, const std::string& name);

// Replaces the file at `path` by `bytes` atomically: they are written to a new file in its folder,
// synced to disk and renamed, so that an interrupted or failed write leaves the old file unchanged.
// Links are followed; character devices are written directly, and other files that are not regular
// are refused. Throws Error with the reason, with nothing left behind; a program that is killed
// leaves one hidden file, which the next that writes removes.
void WriteFileAtomically(const std::string& path, std::span<const std::byte> bytes);
void WriteFileAtomically(const std::string& path, std::string_view text);

// Does the same piece by piece, for files too large to be held twice. Without Commit() the old file
// stays. A target that is not a regular file receives everything at Commit().
class AtomicFile {
  public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();

    // Throw Error as WriteFileAtomically() does.
    void WriteAt(int64_t offset, std::span<const std::byte> bytes);
    void Commit();

  private:
    struct State;
    std::unique_ptr<State> state;
};

// Throws Error if WriteFileAtomically(path, ...) could not create its file now: the directory is
// missing or takes no new files, or `path` is itself a directory. For use before a long render.
void CheckWritable(const std::string& path);

// Reads files whole.

struct FileContents {
    std::unique_ptr<char[]> bytes;
    size_t size = 0;

    std::string_view View() const { return {bytes.get(), size}; }
};

// Reads the regular file `path` in one go. Throws Error, beginning with `loc` (the place that names
// the file), if it is missing, a directory, or cannot be read.
FileContents ReadFile(const std::string& path, const FileLoc& loc = {});

// Returns the extension of a file's name, such as ".png", in lower case.
std::string ExtensionOf(const std::string& file);

// Cleans texts of what editors and old programs put around them.

// Returns the text without UTF-8's byte-order mark. Throws Error at `loc` for UTF-16 and UTF-32.
std::string_view WithoutByteOrderMark(std::string_view text, const FileLoc& loc);

// Does so, and leaves out Control-Z and NUL at the end, by which old programs mark it.
std::string_view CleanText(std::string_view text, const FileLoc& loc);

}  // namespace lull
