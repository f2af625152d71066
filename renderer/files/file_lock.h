// Lets one process at a time read a file and write it again.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace lull {

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

}  // namespace lull
