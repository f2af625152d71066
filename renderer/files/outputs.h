// Keeps results from replacing each other, or their inputs.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lull {

// Writes the results of long work so that one file that cannot be written does not cost the others,
// nor itself.

// Treatment of a file that cannot be written: it goes elsewhere, or is left out.
enum class Rescue { Elsewhere, None };

class ResultFiles {
  public:
    using Writer = std::function<void(const std::string& path)>;

    ResultFiles(Rescue rescue = Rescue::Elsewhere) : rescue(rescue) {}

    // Calls write(path). Where that throws Error, calls it for a file of the same name in a new
    // folder where temporary files go ($TMPDIR, else /tmp). Check() tells of it.
    void Write(const std::string& path, const Writer& write);
    // Does so for several files at the same time, on all threads.
    struct File {
        std::string path;
        Writer write;
    };
    void WriteAll(const std::vector<File>&);
    void WriteText(const std::string& path, const std::string& text);

    // Removes the file that earlier work has left there, which could be taken for one of these.
    static void RemoveOld(const std::string& path);

    // Returns the files that were written, wherever they are, in that order.
    const std::vector<std::string>& Names() const { return names; }
    // Throws Error if a file is not where it should be; it says why, and where it is.
    void Check() const;
    // Prints the names, a line each, and checks.
    void PrintAndCheck() const;

  private:
    void Note(const File&, const std::optional<std::string>& failure);
    bool WriteElsewhere(const std::string& path, const Writer& write);

    Rescue rescue;
    std::vector<std::string> names;
    std::string folder;  // empty: there was no need for one
    std::string failures, rescued, lost;
};

// Lets one process at a time read a file and write it again.

// Exclusive access to the file at a path, among all users of this class, until it is destroyed. The
// lock is on a hidden file in its folder, ".NAME.lock", which exists as long.
class FileLock {
  public:
    // Waits until no other process has it; calls onWait() once before, if it has to wait. Throws
    // Error where the file could not be made or locked.
    static FileLock Wait(const std::string& path, const std::function<void()>& onWait);
    // Returns nothing if another process has it. Throws as Wait() does.
    static std::optional<FileLock> Try(const std::string& path);

    FileLock(FileLock&&) noexcept;
    FileLock& operator=(FileLock&&) = delete;
    ~FileLock();

  private:
    FileLock(std::string name, int fd) : name(std::move(name)), fd(fd) {}

    std::string name;
    int fd;
};

// A file as a user knows it: `role` is its purpose, "--report" or "a file of the scene".
struct NamedFile {
    std::string role, path;
};

// For use before the work begins. Throws Error if an output would be the same file as another one
// or as an input, by whatever name or link, or could not be written now (see CheckWritable()).
// Empty paths stand for none, and devices are no files.
void CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

// Keeps other processes from writing files that belong together, of which one is `output`, until it
// is destroyed; nothing for devices. Throws Error if another process is writing them.
std::optional<FileLock> LockOutput(const std::string& output);

// Returns how the names of all results begin: `output`, or `name` if that is empty. "DIR/" stands
// for files in the folder DIR, which is made if it is not there, whose names begin with `name`.
// Throws Error if it cannot be made.
std::string BeginningOfNames(const std::string& output, const std::string& name);

}  // namespace lull
