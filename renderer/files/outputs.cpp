#include "renderer/files/outputs.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "stopping/base/parallel.h"

namespace lull {
namespace {

namespace fs = std::filesystem;

// Finds files again, by names with all links followed and, of those that exist, device and inode.
class FoundFiles {
  public:
    // Returns the file that is the same as this one, null for none, and keeps this one. Files that
    // are not regular are never found.
    const NamedFile* FindOrAdd(const NamedFile& file) {
        struct stat status;
        const bool exists = stat(file.path.c_str(), &status) == 0;
        if (exists && !S_ISREG(status.st_mode)) return nullptr;
        std::error_code error;
        const fs::path name = fs::weakly_canonical(fs::absolute(file.path, error), error);
        const auto [named, isNew] = byName.emplace(name.string(), file);
        if (!isNew) return &named->second;
        if (!exists) return nullptr;
        const auto [same, isFirst] = byInode.emplace(std::pair(status.st_dev, status.st_ino), file);
        return isFirst ? nullptr : &same->second;
    }

  private:
    std::map<std::string, NamedFile> byName;
    std::map<std::pair<dev_t, ino_t>, NamedFile> byInode;
};

}  // namespace

void CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
    FoundFiles found;
    for (const NamedFile& input : inputs)
        if (!input.path.empty()) found.FindOrAdd(input);
    for (const NamedFile& output : outputs) {
        if (output.path.empty()) continue;
        if (const NamedFile* other = found.FindOrAdd(output))
            throw Error("{} \"{}\" would replace {} \"{}\"; give it another name", output.role,
                        output.path, other->role, other->path);
        CheckWritable(output.path);
    }
}

std::optional<FileLock> LockOutput(const std::string& output) {
    std::error_code error;
    const fs::file_status status = fs::status(output, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) return {};
    std::optional<FileLock> lock = FileLock::Try(output);
    if (!lock)
        throw Error(output +
                    ": another process is writing this file; wait for its end, or name another");
    return lock;
}

std::string BeginningOfNames(const std::string& output, const std::string& name) {
    if (!output.ends_with('/')) return output.empty() ? name : output;
    std::error_code error;
    fs::create_directories(output, error);
    if (error) throw Error("-o {}: {}", output, error.message());
    return output + name;
}

namespace {

namespace fs = std::filesystem;

std::string MakeNewFolder() {
    std::error_code error;
    const fs::path parent = fs::temp_directory_path(error);
    std::string folder = (error ? fs::path("/tmp") : parent) / "lull-XXXXXX";
    return mkdtemp(folder.data()) ? folder : "";
}

void Append(const std::string& text, const char* separator, std::string* list) {
    *list += (list->empty() ? "" : separator) + text;
}

}  // namespace

void ResultFiles::Write(const std::string& path, const Writer& write) { WriteAll({{path, write}}); }

void ResultFiles::WriteAll(const std::vector<File>& files) {
    std::vector<std::optional<std::string>> failed(files.size());
    ForEachIndex(int(files.size()), [&](int i) {
        try {
            files[size_t(i)].write(files[size_t(i)].path);
        } catch (const Error& e) {
            failed[size_t(i)] = e.what();
        }
    });
    for (size_t i = 0; i < files.size(); ++i) Note(files[i], failed[i]);
}

// Keeps the name of a file that was written, or writes it elsewhere.
void ResultFiles::Note(const File& file, const std::optional<std::string>& failure) {
    if (!failure) return names.push_back(file.path);
    Append(*failure, "; ", &failures);
    if (rescue == Rescue::None) return;
    const bool isRescued = WriteElsewhere(file.path, file.write);
    Append(fmt::format("\"{}\"", file.path), ", ", isRescued ? &rescued : &lost);
}

void ResultFiles::WriteText(const std::string& path, const std::string& text) {
    Write(path, [&](const std::string& file) { WriteFileAtomically(file, text); });
}

bool ResultFiles::WriteElsewhere(const std::string& path, const Writer& write) try {
    if (folder.empty()) folder = MakeNewFolder();
    if (folder.empty()) return false;
    const std::string other = fs::path(folder) / fs::path(path).filename();
    write(other);
    names.push_back(other);
    return true;
} catch (const Error&) {
    std::error_code error;
    if (fs::remove(folder, error)) folder.clear();  // it is empty
    return false;
}

void ResultFiles::RemoveOld(const std::string& path) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) fs::remove(path, error);
}

void ResultFiles::PrintAndCheck() const {
    for (const std::string& name : names) fmt::print("{}\n", name);
    Check();
}

void ResultFiles::Check() const {
    if (failures.empty()) return;
    std::string text = failures;
    if (!rescued.empty()) text += fmt::format("; in {1} instead: {0}", rescued, folder);
    if (!lost.empty()) text += fmt::format("; lost: {}", lost);
    throw Error(text);
}

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
    throw Error("cannot lock \"{}\": {}", name, std::strerror(errno));
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
