#include "renderer/files/file_lock.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/files/open_file_internal.h"

namespace lull {

namespace {

// Links are followed, so that all who write to a file meet at the same lock. Of a name that is just
// allowed the end is kept, in which numbered files differ.
std::string NameOfLock(const std::string& path) {
    constexpr size_t kMost = 240;  // bytes; file systems allow 255
    std::error_code error;
    std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
    if (error) target = path;
    const std::string name = target.filename();
    return target.parent_path() /
           fmt::format(".{}.lock", name.substr(name.size() - std::min(name.size(), kMost)));
}

[[noreturn]] void Fail(const std::string& name) {
    throw Error(fmt::format("cannot lock \"{}\": {}", name, std::strerror(errno)));
}

// Returns the locked file; -1 where another process has it and `mode` is not to wait.
int Lock(const std::string& name, int mode) {
    for (;;) {
        const int fd = open(name.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd < 0) Fail(name);
        int result;
        do result = flock(fd, mode);
        while (result != 0 && errno == EINTR);
        if (result == 0 && IsNamed(fd, name)) return fd;
        const int reason = result == 0 ? 0 : errno;
        if (reason == ENOSYS || reason == EOPNOTSUPP) return fd;  // no file there can be locked
        close(fd);
        if (reason == EWOULDBLOCK) return -1;
        errno = reason;
        if (reason != 0) Fail(name);
    }
}

}  // namespace

FileLock FileLock::Wait(const std::string& path, const std::function<void()>& onWait) {
    const std::string name = NameOfLock(path);
    int fd = Lock(name, LOCK_EX | LOCK_NB);
    if (fd < 0) {
        onWait();
        fd = Lock(name, LOCK_EX);
    }
    return {name, fd};
}

std::optional<FileLock> FileLock::Try(const std::string& path) {
    const std::string name = NameOfLock(path);
    const int fd = Lock(name, LOCK_EX | LOCK_NB);
    if (fd < 0) return {};
    return FileLock(name, fd);
}

FileLock::FileLock(FileLock&& other) noexcept
    : name(std::move(other.name)), fd(std::exchange(other.fd, -1)) {}

FileLock::~FileLock() {
    if (fd < 0) return;
    unlink(name.c_str());
    close(fd);
}

}  // namespace lull
