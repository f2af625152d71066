#include "renderer/files/file_io.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <string>
#include <utility>

#include "renderer/base/error.h"
#include "stopping/base/input_file.h"

namespace lull {

bool IsNamed(int fd, const std::string& name) {
    struct stat opened, named;
    return fstat(fd, &opened) == 0 && lstat(name.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

namespace fs = std::filesystem;

// Members of AtomicFile. It has linkage, and so must these.
namespace file_io {

struct OutputFile {
    int fd = -1;
    int lock = -1;  // another descriptor of the same file, which keeps it locked
    fs::path temporary;

    OutputFile() = default;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile() {
        if (!temporary.empty()) unlink(temporary.c_str());
        for (const int open : {fd, lock})
            if (open >= 0) close(open);
    }
};

struct Target {
    fs::path path;
    fs::file_status status;
};

}  // namespace file_io

namespace {

using file_io::OutputFile, file_io::Target;

[[noreturn]] void Fail(const std::string& path, const std::string& reason) {
    throw Error("cannot write \"{}\": {}", path, reason);
}

[[noreturn]] void FailWithErrno(const std::string& path, int error = errno) {
    Fail(path, std::strerror(error));
}

// Returns the name of a file beside `target`, hidden and with its extension, so that whoever
// watches the directory does not take it for a result. The stem is cut short so that a name that is
// just allowed leads to one that is, too.
fs::path BesideTarget(const fs::path& target, const std::string& tag) {
    return target.parent_path() / fmt::format(".{}.{}{}", target.stem().string().substr(0, 128),
                                              tag, target.extension().string().substr(0, 32));
}

bool Create(const fs::path& name, OutputFile* file) {
    file->fd = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file->fd >= 0) file->temporary = name;
    return file->fd >= 0;
}

// Creates the file and locks it. Where somebody is faster to lock it, it is theirs to remove, and
// may be gone by the time that the lock is free again.
bool CreateLocked(const fs::path& name, OutputFile* file) {
    if (!Create(name, file)) return false;
    file->lock = dup(file->fd);  // a lock is given up with the last descriptor
    const bool isLocked = file->lock >= 0 && flock(file->fd, LOCK_EX | LOCK_NB) == 0;
    if (isLocked && IsNamed(file->fd, name)) return true;
    if (!isLocked && errno != EWOULDBLOCK) unlink(name.c_str());
    for (int* open : {&file->fd, &file->lock})
        if (*open >= 0) close(std::exchange(*open, -1));
    file->temporary.clear();
    errno = EWOULDBLOCK;
    return false;
}

// Removes the file that a killed writer has left; returns false if another may be writing to it.
bool RemoveLeftover(const fs::path& name) {
    OutputFile old;
    old.fd = open(name.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (old.fd < 0) return errno == ENOENT;
    if (flock(old.fd, LOCK_EX | LOCK_NB) != 0) return false;
    // The locked file may have been given its final name in the meantime.
    return !IsNamed(old.fd, name) || unlink(name.c_str()) == 0;
}

// Creates a new file in the folder of `target`. It always has the same name, so that files of
// killed writers do not accumulate, or, without locks or where another has that, a name of its own.
void OpenTemporary(const std::string& path, const fs::path& target, OutputFile* file) {
    const fs::path common = BesideTarget(target, "tmp");
    for (int attempt = 0; attempt < 10; ++attempt) {
        if (CreateLocked(common, file)) return;
        if (errno != EEXIST || !RemoveLeftover(common)) break;
    }
    static std::atomic<unsigned> serial = 0;  // tells apart the writers of one process
    for (int attempt = 0; attempt < 100; ++attempt) {
        if (Create(BesideTarget(target, fmt::format("{}-{}", getpid(), serial++)), file)) return;
        if (errno != EEXIST) break;
    }
    FailWithErrno(path);
}

template <typename Write>
void WriteAll(const std::string& path, std::span<const std::byte> bytes, const Write& write) {
    for (size_t done = 0; done < bytes.size();) {
        const ssize_t written = write(bytes.subspan(done), done);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) FailWithErrno(path);
        done += size_t(written);
    }
}

// Closes with the error checked: network file systems report a full disk only here.
void Close(const std::string& path, OutputFile* file) {
    const int fd = file->fd;
    file->fd = -1;
    if (close(fd) != 0 && errno != EINTR) FailWithErrno(path);
}

// Makes a rename last; some file systems cannot, which harms no one.
void SyncDirectory(const fs::path& directory) {
    const int fd = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    fsync(fd);
    close(fd);
}

Target FindTarget(const std::string& path) {
    if (path.empty()) throw Error("cannot write: the file name is empty");
    std::error_code error;
    Target target;
    target.path = fs::weakly_canonical(fs::absolute(path), error);
    if (error) Fail(path, error.message());
    target.status = fs::status(target.path, error);
    if (fs::is_directory(target.status)) Fail(path, "it is a directory");
    // To open a FIFO would be to wait for its reader.
    if (fs::exists(target.status) && !fs::is_regular_file(target.status) &&
        !fs::is_character_file(target.status))
        Fail(path, "it is not a regular file");
    if (path.back() == '/') Fail(path, "it names a directory");
    const fs::path directory = target.path.parent_path();
    const fs::file_status parent = fs::status(directory, error);
    if (!fs::exists(parent))
        Fail(path, fmt::format("the directory \"{}\" does not exist", directory.string()));
    if (!fs::is_directory(parent))
        Fail(path, fmt::format("\"{}\" is not a directory", directory.string()));
    return target;
}

bool IsSpecial(const Target& target) {
    return fs::exists(target.status) && !fs::is_regular_file(target.status);
}

void WriteDirectly(const std::string& path, const Target& target,
                   std::span<const std::byte> bytes) {
    OutputFile file;
    file.fd = open(target.path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file.fd < 0) FailWithErrno(path);
    WriteAll(path, bytes, [&](std::span<const std::byte> rest, size_t) {
        return write(file.fd, rest.data(), rest.size());
    });
    Close(path, &file);
}

}  // namespace

struct AtomicFile::State {
    std::string path;
    Target target;
    OutputFile file;                // the new one; none where the target is special
    std::vector<std::byte> direct;  // of a special target
};

AtomicFile::AtomicFile(const std::string& path) : state(std::make_unique<State>()) {
    state->path = path;
    state->target = FindTarget(path);
    if (IsSpecial(state->target)) return;
    const fs::file_status& old = state->target.status;
    OpenTemporary(path, state->target.path, &state->file);
    if (fs::exists(old) && fchmod(state->file.fd, mode_t(old.permissions() & fs::perms::mask)) != 0)
        FailWithErrno(path);
}

AtomicFile::~AtomicFile() = default;

void AtomicFile::WriteAt(int64_t offset, std::span<const std::byte> bytes) {
    if (IsSpecial(state->target)) {
        state->direct.resize(std::max(state->direct.size(), size_t(offset) + bytes.size()));
        std::copy(bytes.begin(), bytes.end(), state->direct.begin() + offset);
        return;
    }
    WriteAll(state->path, bytes, [&](std::span<const std::byte> rest, size_t done) {
        return pwrite(state->file.fd, rest.data(), rest.size(), offset + off_t(done));
    });
}

void AtomicFile::Commit() {
    const std::string& path = state->path;
    if (IsSpecial(state->target)) return WriteDirectly(path, state->target, state->direct);
    OutputFile& file = state->file;
    if (fsync(file.fd) != 0 && errno != EINVAL) FailWithErrno(path);
    Close(path, &file);
    if (rename(file.temporary.c_str(), state->target.path.c_str()) != 0) FailWithErrno(path);
    file.temporary.clear();
    if (file.lock >= 0) close(std::exchange(file.lock, -1));
    SyncDirectory(state->target.path.parent_path());
}

void WriteFileAtomically(const std::string& path, std::span<const std::byte> bytes) {
    AtomicFile file(path);
    file.WriteAt(0, bytes);
    file.Commit();
}

void WriteFileAtomically(const std::string& path, std::string_view text) {
    WriteFileAtomically(path, std::as_bytes(std::span(text)));
}

void CheckWritable(const std::string& path) {
    const Target target = FindTarget(path);
    if (IsSpecial(target)) {
        if (access(target.path.c_str(), W_OK) != 0) FailWithErrno(path);
        return;
    }
    // Permission bits do not tell all (read-only mounts, quotas); creating a file does.
    OutputFile probe;
    OpenTemporary(path, target.path, &probe);
}

namespace {

constexpr size_t kLongestPath = 4096;  // that a system knows

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd(fd) {}
    ~Descriptor() {
        if (fd >= 0) close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    const int fd;
};

}  // namespace

FileContents ReadFile(const std::string& path, const FileLoc& loc) {
    const auto fail = [&](const std::string& why) {
        throw Error(loc, "cannot read '" + Printable(path, kLongestPath) + "': " + why);
    };
    // A name with a NUL byte would silently stand for its beginning.
    if (path.find('\0') != std::string::npos) fail("the name holds a NUL character");
    // Not to block, so that a named pipe is refused below and not waited for.
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.fd < 0) fail(std::strerror(errno));
    struct stat status;
    if (fstat(file.fd, &status) != 0) fail(std::strerror(errno));
    if (S_ISDIR(status.st_mode)) fail("it is a directory; name a file in it");
    if (!S_ISREG(status.st_mode)) fail("it is not a regular file");

    FileContents contents;
    contents.size = size_t(status.st_size);
    contents.bytes.reset(new (std::nothrow) char[contents.size]);
    if (!contents.bytes) fail("it is too large for the memory");
    for (size_t done = 0; done < contents.size;) {
        const ssize_t n = read(file.fd, contents.bytes.get() + done, contents.size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(std::strerror(errno));
        if (n == 0) {  // it shrank since it was measured
            contents.size = done;
            break;
        }
        done += size_t(n);
    }
    return contents;
}

std::string ExtensionOf(const std::string& file) {
    return LowerCase(fs::path(file).extension().string());
}

std::string_view WithoutByteOrderMark(std::string_view text, const FileLoc& loc) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (const std::string_view wide = WideEncoding(text); !wide.empty())
        throw Error(loc, "the text is " + std::string(wide) + "; save it as UTF-8");
    return text;
}

std::string_view CleanText(std::string_view text, const FileLoc& loc) {
    return WithoutEndMarks(WithoutByteOrderMark(text, loc));
}

}  // namespace lull
